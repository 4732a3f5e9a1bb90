# find_orb_slam2(ROOT), find_dso(ROOT), find_svo(ROOT): targets Upstream::ORB_SLAM2, ...::DSO,
# ...::SVO of installed libraries. An error names a missing file and the folders searched.

# upstream_file(VARIABLE WHAT ROOT NAMES names... SUFFIXES folders... [LIBRARY])
function(upstream_file variable what root)
  cmake_parse_arguments(arg "LIBRARY" "" "NAMES;SUFFIXES" ${ARGN})
  if(arg_LIBRARY)
    find_library(${variable} NAMES ${arg_NAMES} HINTS ${root} PATH_SUFFIXES ${arg_SUFFIXES})
  else()
    find_path(${variable} NAMES ${arg_NAMES} HINTS ${root} PATH_SUFFIXES ${arg_SUFFIXES})
  endif()
  if(NOT ${variable})
    list(JOIN arg_NAMES " or " names)
    list(JOIN arg_SUFFIXES ", " suffixes)
    message(FATAL_ERROR "${what}: no ${names} in ${root} (searched ${suffixes}), nor in "
                        "CMAKE_PREFIX_PATH. Build it, or set ${variable}.")
  endif()
endfunction()

# upstream_target(NAME INCLUDES ... LIBS ...)
function(upstream_target name)
  cmake_parse_arguments(arg "" "" "INCLUDES;LIBS;OPTIONS" ${ARGN})
  add_library(Upstream::${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(Upstream::${name} SYSTEM INTERFACE ${arg_INCLUDES})
  target_link_libraries(Upstream::${name} INTERFACE ${arg_LIBS})
  target_compile_options(Upstream::${name} INTERFACE ${arg_OPTIONS})
endfunction()

# Without find_package, because Debian's CMake package of OpenCV requires all of its modules.
macro(upstream_common what)
  find_package(Threads REQUIRED)
  upstream_file(UPSTREAM_EIGEN_INCLUDE_DIR ${what} /usr
    NAMES Eigen/Core SUFFIXES include/eigen3 include)
endmacro()
macro(upstream_opencv what)
  upstream_file(UPSTREAM_OPENCV_INCLUDE_DIR ${what} /usr
    NAMES opencv2/core/core.hpp SUFFIXES include/opencv4 include)
  upstream_file(UPSTREAM_OPENCV_CORE ${what} /usr LIBRARY
    NAMES opencv_core SUFFIXES lib lib/x86_64-linux-gnu)
endmacro()
macro(upstream_boost what)
  upstream_file(UPSTREAM_BOOST_INCLUDE_DIR ${what} /usr NAMES boost/thread.hpp SUFFIXES include)
  upstream_file(UPSTREAM_BOOST_THREAD ${what} /usr LIBRARY NAMES boost_thread SUFFIXES lib)
  upstream_file(UPSTREAM_BOOST_SYSTEM ${what} /usr LIBRARY NAMES boost_system SUFFIXES lib)
endmacro()

macro(find_orb_slam2 root)
  set(what "ORB-SLAM2 (ORB_SLAM2_ROOT)")
  upstream_common("${what}")
  upstream_opencv("${what}")
  upstream_file(ORB_SLAM2_INCLUDE_DIR "${what}" ${root} NAMES System.h SUFFIXES include)
  upstream_file(ORB_SLAM2_DBOW2_DIR "${what}" ${root} NAMES Thirdparty/DBoW2/DBoW2/FORB.h
    SUFFIXES . include)
  # Its headers include those of g2o, which include a file that is not in the sources.
  if(NOT EXISTS ${ORB_SLAM2_DBOW2_DIR}/Thirdparty/g2o/config.h)
    message(FATAL_ERROR "${what}: no config.h in ${ORB_SLAM2_DBOW2_DIR}/Thirdparty/g2o. "
                        "g2o's own CMakeLists.txt there writes it when it is configured.")
  endif()
  # Its headers also include Pangolin's. The adapter opens no viewer and needs only one type name.
  find_path(PANGOLIN_INCLUDE_DIR NAMES pangolin/pangolin.h HINTS ${root} PATH_SUFFIXES include)
  if(NOT PANGOLIN_INCLUDE_DIR)
    set(PANGOLIN_INCLUDE_DIR ${OVERFLY_ADAPTERS_FOLDER}/without_pangolin)
  endif()
  upstream_file(ORB_SLAM2_LIBRARY "${what}" ${root} LIBRARY NAMES ORB_SLAM2 SUFFIXES lib)
  upstream_file(ORB_SLAM2_DBOW2_LIBRARY "${what}" ${root} LIBRARY NAMES DBoW2
    SUFFIXES lib Thirdparty/DBoW2/lib)
  upstream_file(ORB_SLAM2_G2O_LIBRARY "${what}" ${root} LIBRARY NAMES g2o
    SUFFIXES lib Thirdparty/g2o/lib)
  set(ORB_SLAM2_VOCABULARY ${root}/Vocabulary/ORBvoc.txt CACHE FILEPATH
    "Default vocabulary of the adapter")
  upstream_target(ORB_SLAM2
    INCLUDES ${ORB_SLAM2_DBOW2_DIR} ${ORB_SLAM2_INCLUDE_DIR} ${PANGOLIN_INCLUDE_DIR}
             ${UPSTREAM_EIGEN_INCLUDE_DIR} ${UPSTREAM_OPENCV_INCLUDE_DIR}
             ${OVERFLY_ADAPTERS_FOLDER}/opencv2_names
    OPTIONS "SHELL:-include opencv2_names.hpp"
    LIBS ${ORB_SLAM2_LIBRARY} ${ORB_SLAM2_DBOW2_LIBRARY} ${ORB_SLAM2_G2O_LIBRARY}
         ${UPSTREAM_OPENCV_CORE} Threads::Threads)
endmacro()

macro(find_dso root)
  set(what "DSO (DSO_ROOT)")
  upstream_common("${what}")
  upstream_boost("${what}")
  upstream_file(DSO_INCLUDE_DIR "${what}" ${root} NAMES FullSystem/FullSystem.h
    SUFFIXES src include)
  upstream_file(DSO_SOPHUS_INCLUDE_DIR "${what}" ${root} NAMES sophus/sim3.hpp
    SUFFIXES thirdparty/Sophus include)
  upstream_file(DSO_LIBRARY "${what}" ${root} LIBRARY NAMES dso SUFFIXES build/lib lib)
  set(DSO_EXTRA_LIBRARIES "" CACHE STRING "Further libraries to link, e.g. OpenCV if DSO was built with it")
  # Its headers use Boost's placeholders (_1, ...) in the global namespace.
  upstream_target(DSO
    INCLUDES ${DSO_INCLUDE_DIR} ${DSO_SOPHUS_INCLUDE_DIR} ${UPSTREAM_EIGEN_INCLUDE_DIR}
             ${UPSTREAM_BOOST_INCLUDE_DIR}
    OPTIONS -DENABLE_SSE -DBOOST_BIND_GLOBAL_PLACEHOLDERS "SHELL:-include boost/bind.hpp"
    LIBS ${DSO_LIBRARY} ${DSO_EXTRA_LIBRARIES} ${UPSTREAM_BOOST_THREAD} ${UPSTREAM_BOOST_SYSTEM}
         Threads::Threads)
endmacro()

macro(find_svo root)
  set(what "SVO (SVO_ROOT)")
  upstream_common("${what}")
  upstream_opencv("${what}")
  upstream_boost("${what}")
  upstream_file(SVO_INCLUDE_DIR "${what}" ${root} NAMES svo/frame_handler_mono.h
    SUFFIXES include svo/include rpg_svo/svo/include)
  upstream_file(VIKIT_INCLUDE_DIR "${what}" ${root} NAMES vikit/pinhole_camera.h
    SUFFIXES include vikit_common/include rpg_vikit/vikit_common/include)
  upstream_file(SVO_SOPHUS_INCLUDE_DIR "${what}" ${root} NAMES sophus/se3.h
    SUFFIXES include Sophus)
  upstream_file(SVO_LIBRARY "${what}" ${root} LIBRARY NAMES svo
    SUFFIXES lib svo/lib rpg_svo/svo/lib)
  upstream_file(VIKIT_LIBRARY "${what}" ${root} LIBRARY NAMES vikit_common
    SUFFIXES lib vikit_common/lib rpg_vikit/vikit_common/lib)
  upstream_file(SVO_SOPHUS_LIBRARY "${what}" ${root} LIBRARY NAMES Sophus
    SUFFIXES lib Sophus/build)
  upstream_file(FAST_LIBRARY "${what}" ${root} LIBRARY NAMES fast SUFFIXES lib fast/build)
  upstream_target(SVO
    INCLUDES ${SVO_INCLUDE_DIR} ${VIKIT_INCLUDE_DIR} ${SVO_SOPHUS_INCLUDE_DIR}
             ${UPSTREAM_EIGEN_INCLUDE_DIR} ${UPSTREAM_OPENCV_INCLUDE_DIR}
             ${UPSTREAM_BOOST_INCLUDE_DIR} ${OVERFLY_ADAPTERS_FOLDER}/opencv2_names
    OPTIONS -DBOOST_BIND_GLOBAL_PLACEHOLDERS "SHELL:-include opencv2_names.hpp"
            "SHELL:-include boost/bind.hpp"
    LIBS ${SVO_LIBRARY} ${VIKIT_LIBRARY} ${SVO_SOPHUS_LIBRARY} ${FAST_LIBRARY}
         ${UPSTREAM_OPENCV_CORE} ${UPSTREAM_BOOST_THREAD} ${UPSTREAM_BOOST_SYSTEM}
         Threads::Threads)
endmacro()
