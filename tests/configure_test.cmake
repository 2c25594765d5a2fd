# Configures the project as if a package of the tests were missing. ON must name the package and say what to do, AUTO
# must build without the tests, and OFF must need no package.
function(configure tests expected_status expected_text)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G ${GENERATOR} --fresh -DSPAWNFIELD_TESTS=${tests}
      -DCMAKE_DISABLE_FIND_PACKAGE_Catch2=ON
    RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  string(REGEX REPLACE "[ \n]+" " " out "${out}")
  string(FIND "${out}" "${expected_text}" position)
  if(NOT status EQUAL expected_status OR position EQUAL -1)
    message(FATAL_ERROR "SPAWNFIELD_TESTS=${tests}: cmake ended with status ${status}, needs ${expected_status} and "
      "the text \"${expected_text}\" in: ${out}")
  endif()
endfunction()

function(expect_no_tests tests)
  if(EXISTS ${WORK}/tests/CTestTestfile.cmake)
    message(FATAL_ERROR "SPAWNFIELD_TESTS=${tests} must not configure the tests, but "
      "${WORK}/tests/CTestTestfile.cmake exists")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
configure(ON 1 "packages that are not installed: catch2. Install them with `tools/install-dependencies.sh --tests`")
configure(AUTO 0 "The tests are left out: these packages are not installed: catch2")
expect_no_tests(AUTO)
configure(OFF 0 "Configuring done")
expect_no_tests(OFF)
