# Finds OpenCV modules (core, imgproc, imgcodecs), each from its own Debian package (libopencv-core-dev, …). OpenCV's
# own OpenCVConfig.cmake is only in libopencv-dev, which installs 250 more packages.
#
# Sets OpenCV_FOUND and defines an imported target for each component: opencv_core, opencv_imgproc, …
find_path(OpenCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
set(opencv_needed OpenCV_INCLUDE_DIR)
foreach(component IN LISTS OpenCV_FIND_COMPONENTS)
  find_library(OpenCV_${component}_LIBRARY opencv_${component})
  list(APPEND opencv_needed OpenCV_${component}_LIBRARY)
  if(OpenCV_${component}_LIBRARY)
    set(OpenCV_${component}_FOUND TRUE)
  endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCV REQUIRED_VARS ${opencv_needed} HANDLE_COMPONENTS
  REASON_FAILURE_MESSAGE "install libopencv-core-dev, libopencv-imgproc-dev and libopencv-imgcodecs-dev")

foreach(component IN LISTS OpenCV_FIND_COMPONENTS)
  if(OpenCV_FOUND AND NOT TARGET opencv_${component})
    add_library(opencv_${component} SHARED IMPORTED)
    set_target_properties(opencv_${component} PROPERTIES
      IMPORTED_LOCATION "${OpenCV_${component}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${OpenCV_INCLUDE_DIR}")
  endif()
endforeach()
mark_as_advanced(OpenCV_INCLUDE_DIR)
