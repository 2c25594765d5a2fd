# Lists the libraries that spawnfield uses, with their versions, for `spawnfield --version` and for the software bill of
# materials (tools/sbom.py). dpkg knows the exact versions of Debian's libraries. All others have the version that
# find_package or pkg-config found.
#
# Writes libraries.json, a list of objects: name, version, package_version (of dpkg; may be empty), licence (SPDX),
# website, and file (a library or a header). Writes about/library_list.h with the same names and versions for C++.
find_program(DPKG_QUERY dpkg-query)
mark_as_advanced(DPKG_QUERY)

# Sets `out` to the file of an imported target.
function(find_target_file target out)
  foreach(property LOCATION_RELEASE LOCATION_NONE LOCATION_RELWITHDEBINFO LOCATION)
    get_target_property(file ${target} IMPORTED_${property})
    if(file)
      set(${out} ${file} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "${target} has no file")
endfunction()

# Sets `out` to the version of the Debian package that contains the file; empty if dpkg does not know the file.
function(find_package_version file out)
  set(${out} "" PARENT_SCOPE)
  if(NOT DPKG_QUERY)
    return()
  endif()
  execute_process(COMMAND ${DPKG_QUERY} --search ${file} OUTPUT_VARIABLE owner RESULT_VARIABLE status ERROR_QUIET)
  if(status EQUAL 0 AND owner MATCHES "^([^ ,]+): ")
    execute_process(COMMAND ${DPKG_QUERY} --show --showformat "\${Version}" ${CMAKE_MATCH_1}
      OUTPUT_VARIABLE version COMMAND_ERROR_IS_FATAL ANY)
    set(${out} ${version} PARENT_SCOPE)
  endif()
endfunction()

# Adds one library to the list. `found_version` counts only if dpkg does not know the file, which may be a target.
set(library_list "")
set(library_rows "")
function(add_library_to_list name found_version file licence website)
  if(TARGET ${file})
    find_target_file(${file} file)
  endif()
  find_package_version(${file} package_version)
  # 1:1.2.13.dfsg-1 is 1.2.13, and 5.2.5~ds0-1+b1 is 5.2.5.
  if(package_version MATCHES "^([0-9]+:)?([0-9]+(\\.[0-9]+)*)")
    set(version ${CMAKE_MATCH_2})
  else()
    set(version ${found_version})
  endif()
  foreach(key name version package_version licence website file)
    list(APPEND fields "\"${key}\": \"${${key}}\"")
  endforeach()
  list(JOIN fields ", " fields)
  set(library_list ${library_list} "{${fields}}" PARENT_SCOPE)
  set(library_rows "${library_rows}    {\"${name}\", \"${version}\", \"${package_version}\"},\n" PARENT_SCOPE)
endfunction()

file(STRINGS ${OpenCV_INCLUDE_DIR}/opencv2/core/version.hpp lines REGEX "define CV_VERSION_(MAJOR|MINOR|REVISION) ")
string(REGEX REPLACE "[^0-9]*([0-9]+)[^;]*" "\\1" opencv_version "${lines}")
string(REPLACE ";" "." opencv_version "${opencv_version}")
file(STRINGS ${HPDF_INCLUDE_DIR}/hpdf_version.h line REGEX "define HPDF_VERSION_TEXT ")
string(REGEX REPLACE "[^\"]*\"([^\"]*)\".*" "\\1" hpdf_version "${line}")
find_path(CLI11_HEADER CLI/CLI.hpp REQUIRED)
find_path(NLOHMANN_HEADER nlohmann/json.hpp REQUIRED)
find_path(EIGEN_HEADER Eigen/Core PATHS ${EIGEN3_INCLUDE_DIR} ${EIGEN3_INCLUDE_DIRS} NO_DEFAULT_PATH REQUIRED)
mark_as_advanced(CLI11_HEADER NLOHMANN_HEADER EIGEN_HEADER)

add_library_to_list(assimp "${assimp_VERSION}" assimp::assimp BSD-3-Clause https://www.assimp.org)
add_library_to_list(CLI11 "${CLI11_VERSION}" ${CLI11_HEADER}/CLI/CLI.hpp BSD-3-Clause
  https://github.com/CLIUtils/CLI11)
list(GET httplib_LINK_LIBRARIES 0 httplib_library)
add_library_to_list(cpp-httplib "${httplib_VERSION}" ${httplib_library} MIT https://github.com/yhirose/cpp-httplib)
add_library_to_list(Eigen "${Eigen3_VERSION}" ${EIGEN_HEADER}/Eigen/Core MPL-2.0 https://eigen.tuxfamily.org)
add_library_to_list(FCL "${fcl_VERSION}" fcl BSD-3-Clause https://github.com/flexible-collision-library/fcl)
list(GET ccd_LINK_LIBRARIES 0 ccd_library)
add_library_to_list(libccd "${ccd_VERSION}" ${ccd_library} BSD-3-Clause https://github.com/danfis/libccd)
add_library_to_list(libdeflate "${deflate_VERSION}" ${deflate_LINK_LIBRARIES} MIT
  https://github.com/ebiggers/libdeflate)
add_library_to_list(libharu "${hpdf_version}" ${HPDF_LIBRARY} Zlib https://github.com/libharu/libharu)
add_library_to_list(libpng "${PNG_VERSION_STRING}" PNG::PNG libpng-2.0 http://www.libpng.org)
add_library_to_list(libsdformat "${sdformat12_VERSION}" sdformat12::sdformat12 Apache-2.0 http://sdformat.org)
add_library_to_list(libtiff "${TIFF_VERSION_STRING}" TIFF::TIFF libtiff http://www.simplesystems.org/libtiff)
add_library_to_list(meshoptimizer "${meshoptimizer_VERSION}" meshoptimizer::meshoptimizer MIT
  https://github.com/zeux/meshoptimizer)
add_library_to_list(nlohmann-json "${nlohmann_json_VERSION}" ${NLOHMANN_HEADER}/nlohmann/json.hpp MIT
  https://json.nlohmann.me)
add_library_to_list(OctoMap "${octomap_VERSION}" octomap BSD-3-Clause https://octomap.github.io)
add_library_to_list(oneTBB "${TBB_VERSION}" TBB::tbb Apache-2.0 https://github.com/oneapi-src/oneTBB)
add_library_to_list(OpenCV "${opencv_version}" opencv_core Apache-2.0 https://opencv.org)
add_library_to_list(PROJ "${PROJ_VERSION}" PROJ::proj MIT https://proj.org)
add_library_to_list(qhull "${qhull_VERSION}" ${qhull_LINK_LIBRARIES} Qhull http://www.qhull.org)
add_library_to_list(tinyxml2 "${tinyxml2_VERSION}" tinyxml2::tinyxml2 Zlib https://github.com/leethomason/tinyxml2)
set(urdfdom_library ${urdfdom_LINK_LIBRARIES})
list(FILTER urdfdom_library INCLUDE REGEX urdfdom_world)
add_library_to_list(urdfdom "${urdfdom_VERSION}" ${urdfdom_library} BSD-3-Clause https://github.com/ros/urdfdom)
add_library_to_list(xxHash "${xxhash_VERSION}" ${xxhash_LINK_LIBRARIES} BSD-2-Clause https://xxhash.com)
add_library_to_list(yaml-cpp "${yaml-cpp_VERSION}" yaml-cpp MIT https://github.com/jbeder/yaml-cpp)
add_library_to_list(zlib "${ZLIB_VERSION_STRING}" ZLIB::ZLIB Zlib https://zlib.net)

list(JOIN library_list ",\n  " library_json)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/libraries.json CONTENT "[\n  @library_json@\n]\n" @ONLY)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/about/library_list.h @ONLY CONTENT [[
// cmake/libraries.cmake wrote this file.
const LibraryVersion versions_at_build[] = {
@library_rows@};
]])
