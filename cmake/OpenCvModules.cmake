# overfly_opencv(MODULE...) creates a target OpenCV::MODULE for each module. Debian's CMake package of
# OpenCV requires all modules (and a gigabyte of dependencies); Overfly needs five.
function(overfly_opencv)
  find_path(OVERFLY_OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
  foreach(module ${ARGN})
    if(NOT TARGET OpenCV::${module})
      find_library(OVERFLY_OPENCV_${module} opencv_${module} REQUIRED)
      add_library(OpenCV::${module} UNKNOWN IMPORTED GLOBAL)
      set_target_properties(OpenCV::${module} PROPERTIES
        IMPORTED_LOCATION ${OVERFLY_OPENCV_${module}}
        INTERFACE_INCLUDE_DIRECTORIES ${OVERFLY_OPENCV_INCLUDE_DIR}
        INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${OVERFLY_OPENCV_INCLUDE_DIR})
    endif()
  endforeach()
endfunction()
