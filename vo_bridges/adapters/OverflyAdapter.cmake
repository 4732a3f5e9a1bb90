# overfly_adapter(NAME LIBS targets... [DEFINITIONS ...] [PROGRAM target])
#
# Builds the program overfly-NAME from adapter_main.cpp (C++17) and NAME/*.cpp. The latter are
# compiled with the flags of the upstream library (OVERFLY_UPSTREAM_CXX_FLAGS,
# OVERFLY_UPSTREAM_CXX_STANDARD).
set(OVERFLY_ADAPTERS_FOLDER ${CMAKE_CURRENT_LIST_DIR})
cmake_path(GET OVERFLY_ADAPTERS_FOLDER PARENT_PATH overfly_vo_bridges_folder)
cmake_path(GET overfly_vo_bridges_folder PARENT_PATH OVERFLY_SOURCE_FOLDER)

function(overfly_adapter name)
  cmake_parse_arguments(arg "" "PROGRAM" "LIBS;DEFINITIONS" ${ARGN})
  if(NOT arg_PROGRAM)
    set(arg_PROGRAM overfly-${name})
  endif()
  set(folder ${OVERFLY_ADAPTERS_FOLDER})
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/${name}/*.cpp)
  set(half ${arg_PROGRAM}_upstream_half)
  add_library(${half} OBJECT ${sources} ${folder}/parameter_set.cpp ${folder}/scene_points.cpp)
  target_include_directories(${half} PRIVATE ${OVERFLY_SOURCE_FOLDER})
  target_compile_definitions(${half} PRIVATE ${arg_DEFINITIONS})
  separate_arguments(flags UNIX_COMMAND "${OVERFLY_UPSTREAM_CXX_FLAGS}")
  target_compile_options(${half} PRIVATE ${flags})
  set_target_properties(${half} PROPERTIES CXX_STANDARD ${OVERFLY_UPSTREAM_CXX_STANDARD})
  target_link_libraries(${half} PRIVATE ${arg_LIBS})

  add_executable(${arg_PROGRAM} ${folder}/adapter_main.cpp $<TARGET_OBJECTS:${half}>)
  target_include_directories(${arg_PROGRAM} PRIVATE ${OVERFLY_SOURCE_FOLDER})
  target_compile_definitions(${arg_PROGRAM} PRIVATE
    OVERFLY_ADAPTER_VERSION="adapter ${PROJECT_VERSION}")
  set_target_properties(${arg_PROGRAM} PROPERTIES CXX_STANDARD 17)
  target_link_libraries(${arg_PROGRAM} PRIVATE ${arg_LIBS})
endfunction()
