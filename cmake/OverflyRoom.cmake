# overfly_room(NAME [DEPENDS targets...] [PRIVATE_DEPENDS targets...] [FOLDERS subfolders...]
#              [CALCULATING_FOLDERS subfolders...])
#
# Creates a room: a static library overfly_NAME with every .cpp in the current folder and in FOLDERS.
# Third-party libraries belong in PRIVATE_DEPENDS: their types must not appear in a room's headers.
# Sources in CALCULATING_FOLDERS are compiled with -O2, whatever overfly_optimise says of the others.
function(overfly_room name)
  cmake_parse_arguments(arg "" "" "DEPENDS;PRIVATE_DEPENDS;FOLDERS;CALCULATING_FOLDERS" ${ARGN})
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
  set(patterns)
  foreach(folder ${arg_CALCULATING_FOLDERS})
    list(APPEND patterns ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  endforeach()
  if(patterns)
    file(GLOB sources CONFIGURE_DEPENDS ${patterns})
    add_library(overfly_${name}_calculating OBJECT ${sources})
    target_include_directories(overfly_${name}_calculating PRIVATE ${CMAKE_SOURCE_DIR})
    target_link_libraries(overfly_${name}_calculating PRIVATE ${arg_DEPENDS} ${arg_PRIVATE_DEPENDS})
    overfly_optimise(overfly_${name}_calculating 2)
    target_sources(overfly_${name} PRIVATE $<TARGET_OBJECTS:overfly_${name}_calculating>)
  endif()
endfunction()

# overfly_optimise(TARGET LEVEL)
#
# The level of optimisation in release builds, where less than CMake's -O3 is enough: -O2 takes a
# tenth and -Og four tenths of the compiler's time less.
function(overfly_optimise target level)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}>)
  overfly_precompile(${target} ${level})
endfunction()

# overfly_precompile(TARGET LEVEL)
#
# Lets TARGET use the headers that are compiled once for its level of optimisation, if there are any
# (cmake/precompiled). Sources with other options need the property SKIP_PRECOMPILE_HEADERS.
function(overfly_precompile target level)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Release")
    set(level 1)
  endif()
  if(TARGET ${OVERFLY_HEADERS}_${level})
    target_precompile_headers(${target} REUSE_FROM ${OVERFLY_HEADERS}_${level})
  endif()
endfunction()

# overfly_special_optimisation(LEVEL files...)
#
# Sources that are optimised otherwise than the rest of their target.
function(overfly_special_optimisation level)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS $<$<CONFIG:Release>:-O${level}> SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# overfly_static_libraries(TARGET RESULT)
#
# The static libraries of this project that TARGET links, directly or not.
function(overfly_static_libraries target result)
  set(found ${${result}})
  set(linked)
  foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
    get_target_property(libraries ${target} ${property})
    if(libraries)
      list(APPEND linked ${libraries})
    endif()
  endforeach()
  foreach(library IN LISTS linked)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" library "${library}")
    if(NOT TARGET "${library}" OR library IN_LIST found)
      continue()
    endif()
    get_target_property(imported ${library} IMPORTED)
    get_target_property(type ${library} TYPE)
    if(imported)
      continue()
    endif()
    if(type STREQUAL "STATIC_LIBRARY")
      list(APPEND found ${library})
    endif()
    overfly_static_libraries(${library} found)
  endforeach()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

# overfly_link_first(PROGRAM)
#
# Links the project's libraries before the program's own objects. Of a template that both contain the linker
# keeps the first copy: the one that is optimised and belongs to the product, not the tests' own.
function(overfly_link_first program)
  overfly_static_libraries(${program} libraries)
  list(TRANSFORM libraries REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  list(JOIN libraries "," libraries)
  target_link_options(${program} PRIVATE "LINKER:--whole-archive,${libraries},--no-whole-archive")
endfunction()

# overfly_test(NAME [LIBS targets...] [FOLDERS subfolders...])
#
# One GoogleTest program, NAME_tests, of every *_test.cpp in the current folder and its FOLDERS. Each
# suite is a ctest case: to start the program takes 0.1 s of CPU time, which each of thousands of tests
# would take otherwise. Tests are not optimised, which takes half of the compiler's time.
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
  overfly_optimise(${name}_tests 0)
  overfly_link_first(${name}_tests)
  set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  file(GENERATE OUTPUT ${suites} CONTENT "set(PROGRAM \"$<TARGET_FILE:${name}_tests>\")
set(PREFIX ${name})
set(TIMEOUT ${timeout_s})
set(RESULTS \"${CMAKE_BINARY_DIR}/test-results\")
include(\"${CMAKE_SOURCE_DIR}/cmake/AddTestSuites.cmake\")
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites})
endfunction()
