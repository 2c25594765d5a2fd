# Debian packages that only the tests need; `tools/install-dependencies.sh --tests` installs them. If one is missing,
# SPAWNFIELD_TESTS=ON ends with an error, and AUTO builds without tests.
find_package(Catch2 QUIET)
find_package(OpenCV QUIET COMPONENTS core imgproc imgcodecs)
set(missing "")
if(NOT Catch2_FOUND)
  list(APPEND missing catch2)
endif()
if(NOT OpenCV_imgcodecs_FOUND)
  list(APPEND missing libopencv-imgcodecs-dev)
endif()

if(missing)
  list(JOIN missing " " missing)
  if(NOT SPAWNFIELD_TESTS STREQUAL "AUTO")
    message(FATAL_ERROR "The tests need packages that are not installed: ${missing}.\n"
      "Install them with `tools/install-dependencies.sh --tests`, or build without tests: -DSPAWNFIELD_TESTS=OFF")
  endif()
  message(STATUS "The tests are left out: these packages are not installed: ${missing}")
  set(SPAWNFIELD_TESTS OFF)
endif()
