# Files that describe the program: completion for shells, the man page, the list of libraries, and the documentation.
# The program itself prints the first two. The target spawnfield_documents, a part of `all`, makes them in share/.
set(documents ${PROJECT_BINARY_DIR}/share)
file(MAKE_DIRECTORY ${documents})
set(bash ${documents}/spawnfield.bash)
set(zsh ${documents}/_spawnfield)
set(fish ${documents}/spawnfield.fish)
foreach(shell bash zsh fish)
  add_custom_command(OUTPUT ${${shell}} DEPENDS spawnfield_cli
    COMMAND spawnfield_cli completion ${shell} > ${${shell}})
endforeach()
add_custom_command(OUTPUT ${documents}/spawnfield.1.gz DEPENDS spawnfield_cli
  COMMAND spawnfield_cli man > ${documents}/spawnfield.1
  COMMAND gzip -9 -n -f ${documents}/spawnfield.1)

find_program(SPAWNFIELD_PYTHON3 python3)
mark_as_advanced(SPAWNFIELD_PYTHON3)
set(sbom "")
if(SPAWNFIELD_PYTHON3)
  set(sbom ${documents}/spawnfield.cdx.json)
  set(binaries spawnfield_cli spawnfield ${spawnfield_modules})
  set(files ${binaries})
  list(TRANSFORM files PREPEND "$<TARGET_LINKER_FILE:" REGEX "^spawnfield$")
  list(TRANSFORM files PREPEND "$<TARGET_FILE:" REGEX "^spawnfield_")
  list(TRANSFORM files APPEND ">")
  set(page_lock "")
  if(review_page)
    set(page_lock ${PROJECT_SOURCE_DIR}/web/package-lock.json)
  endif()
  add_custom_command(OUTPUT ${sbom}
    DEPENDS ${binaries} ${PROJECT_SOURCE_DIR}/tools/sbom.py ${PROJECT_BINARY_DIR}/libraries.json ${page_lock}
    COMMAND ${SPAWNFIELD_PYTHON3} -B ${PROJECT_SOURCE_DIR}/tools/sbom.py --version ${PROJECT_VERSION}
      --libraries ${PROJECT_BINARY_DIR}/libraries.json "$<$<BOOL:${page_lock}>:--page=${page_lock}>" -o ${sbom}
      ${files} COMMAND_EXPAND_LISTS VERBATIM)
else()
  message(STATUS "The list of libraries (SBOM) is left out: python3 is not installed")
endif()
add_custom_target(spawnfield_documents ALL DEPENDS ${bash} ${zsh} ${fish} ${documents}/spawnfield.1.gz ${sbom})

set(doc_folder ${CMAKE_INSTALL_DATADIR}/doc/spawnfield)
install(FILES ${bash} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME spawnfield)
# With the prefix /usr, Debian's zsh looks only into vendor-completions. All others look into site-functions.
install(FILES ${zsh} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${zsh} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${fish} DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${documents}/spawnfield.1.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/man/man1)
install(FILES ${sbom} README.md CHANGELOG.md DESTINATION ${doc_folder})
install(FILES LICENSE DESTINATION ${doc_folder} RENAME copyright)
# Messages of the program name pages of the documentation.
install(DIRECTORY docs DESTINATION ${doc_folder} FILES_MATCHING PATTERN "*.md" PATTERN images EXCLUDE
  PATTERN bench EXCLUDE)
