# `cpack -G DEB` makes a Debian package; tools/package.sh calls it.
set(SPAWNFIELD_MAINTAINER "The spawnfield authors <noreply@spawnfield.invalid>" CACHE STRING
  "Name and address of whoever makes the Debian package")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME spawnfield)
set(CPACK_PACKAGE_VENDOR "The spawnfield authors")
set(CPACK_PACKAGE_CONTACT ${SPAWNFIELD_MAINTAINER})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "where a robot can stand in a 3D world")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"spawnfield reads a scene and a robot, and gives start poses at which the
robot stands on the ground, a verdict with its reason for any pose, the
verdicts of a complete raster, and pictures of these. This package contains
the program, the C++ library with its headers, and worlds to try.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, libeigen3-dev")  # Eigen: for programs that use the library
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# dpkg-shlibdeps reads all binaries, so the package depends on what the modules need, too. The modules link the library
# of this package, which is not in a package that dpkg knows.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
# Not the component `python`, which pip installs.
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};spawnfield;Unspecified;/")
include(CPack)
