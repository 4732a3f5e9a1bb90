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

# overfly_test(NAME [LIBS targets...] [FOLDERS subfolders...])
#
# One GoogleTest program, NAME_tests, of every *_test.cpp in the current folder and its FOLDERS. Each
# suite is a ctest case: to start the program takes 0.1 s of CPU time, which each of thousands of tests
# would take otherwise. OVERFLY_TEST_OPTIMISATION is the level of optimisation in release builds.
function(overfly_test name)
  cmake_parse_arguments(arg "" "" "LIBS;FOLDERS" ${ARGN})
  set(timeout_s 900)  # of a suite, which takes at most 120 s on two idle processors
  if(OVERFLY_SANITIZE)
    math(EXPR timeout_s "4 * ${timeout_s}")  # Sanitized programs are several times slower.
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
  set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  file(GENERATE OUTPUT ${suites} CONTENT "set(PROGRAM $<TARGET_FILE:${name}_tests>)
set(PREFIX ${name})
set(TIMEOUT ${timeout_s})
set(RESULTS ${CMAKE_BINARY_DIR}/test-results)
include(${CMAKE_SOURCE_DIR}/cmake/AddTestSuites.cmake)
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites})
endfunction()
