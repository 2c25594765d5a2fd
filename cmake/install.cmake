include(CMakePackageConfigHelpers)

install(TARGETS spawnfield EXPORT spawnfield-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS ${spawnfield_modules} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY src/sdf/models/ DESTINATION ${CMAKE_INSTALL_LIBDIR}/spawnfield-models)
install(TARGETS spawnfield_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/spawnfield DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT spawnfield-targets NAMESPACE spawnfield:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/spawnfield)
configure_package_config_file(cmake/spawnfield-config.cmake.in ${PROJECT_BINARY_DIR}/spawnfield-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/spawnfield)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/spawnfield-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/spawnfield-config.cmake ${PROJECT_BINARY_DIR}/spawnfield-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/spawnfield)
install(DIRECTORY maps/ DESTINATION ${CMAKE_INSTALL_DATADIR}/spawnfield/maps)
