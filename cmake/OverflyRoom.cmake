# overfly_room(NAME [DEPENDS targets...] [PRIVATE_DEPENDS targets...] [FOLDERS subfolders...])
#
# Creates a room: a static library overfly_NAME with every .cpp in the current folder and in FOLDERS.
# Third-party libraries belong in PRIVATE_DEPENDS: their types must not appear in a room's headers.
function(overfly_room name)
  cmake_parse_arguments(arg "" "" "DEPENDS;PRIVATE_DEPENDS;FOLDERS" ${ARGN})
  set(patterns ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  foreach(folder ${arg_FOLDERS})
    list(APPEND patterns ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  if(NOT sources)
    add_library(overfly_${name} INTERFACE)
    return()
  endif()
  add_library(overfly_${name} STATIC ${sources})
  target_include_directories(overfly_${name} PUBLIC ${CMAKE_SOURCE_DIR})
  target_link_libraries(overfly_${name} PUBLIC ${arg_DEPENDS} PRIVATE ${arg_PRIVATE_DEPENDS})
endfunction()

# overfly_optimise(TARGET LEVEL)
#
# The level of optimisation in release builds, where less than CMake's -O3 is enough: it takes a
# quarter (-O2) or a third (-O1) of the compiler's time less.
function(overfly_optimise target level)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}>)
  overfly_precompile(${target} ${level})
endfunction()

# overfly_precompile(TARGET LEVEL)
#
# Lets TARGET use the headers that are compiled once for its level of optimisation
# (cmake/precompiled). Sources with other options need the property SKIP_PRECOMPILE_HEADERS.
function(overfly_precompile target level)
  if(TARGET overfly_common_headers_${level})
    target_precompile_headers(${target} REUSE_FROM overfly_common_headers_${level})
  endif()
endfunction()

# overfly_special_optimisation(LEVEL files...)
#
# Sources that are optimised otherwise than the rest of their target.
function(overfly_special_optimisation level)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS $<$<CONFIG:Release>:-O${level}> SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# overfly_test(NAME [LIBS targets...] [TIMEOUT seconds] [FOLDERS subfolders...])
#
# One GoogleTest program, NAME_tests, of every *_test.cpp in the current folder and its FOLDERS;
# each TEST is a separate ctest case, so that skipped tests are reported. OVERFLY_TEST_OPTIMISATION is
# the level of optimisation in release builds.
function(overfly_test name)
  cmake_parse_arguments(arg "" "TIMEOUT" "LIBS;FOLDERS" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  if(OVERFLY_SANITIZE)
    math(EXPR arg_TIMEOUT "4 * ${arg_TIMEOUT}")  # Sanitized programs are several times slower.
  endif()
  set(patterns ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  foreach(folder ${arg_FOLDERS})
    list(APPEND patterns ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*_test.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  if(NOT sources)
    return()
  endif()
  add_executable(${name}_tests ${sources})
  target_link_libraries(${name}_tests PRIVATE ${arg_LIBS} overfly_test_support GTest::gmock GTest::gtest_main)
  overfly_optimise(${name}_tests ${OVERFLY_TEST_OPTIMISATION})
  gtest_discover_tests(${name}_tests
    TEST_PREFIX "${name}."
    DISCOVERY_MODE PRE_TEST
    PROPERTIES TIMEOUT ${arg_TIMEOUT})
endfunction()
