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

# overfly_test(NAME [FOLDER folder] [LIBS targets...] [TIMEOUT seconds])
#
# Creates a GoogleTest program NAME_tests with every *_test.cpp in FOLDER (default: the current
# folder). Each TEST is a separate ctest case, so that skipped tests are visible.
function(overfly_test name)
  cmake_parse_arguments(arg "" "TIMEOUT;FOLDER" "LIBS" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  if(OVERFLY_SANITIZE)
    math(EXPR arg_TIMEOUT "4 * ${arg_TIMEOUT}")  # Sanitized programs are several times slower.
  endif()
  cmake_path(APPEND CMAKE_CURRENT_SOURCE_DIR "${arg_FOLDER}" OUTPUT_VARIABLE folder)
  cmake_path(NORMAL_PATH folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*_test.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name}_tests ${sources})
  target_link_libraries(${name}_tests PRIVATE ${arg_LIBS} overfly_test_support GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${name}_tests
    TEST_PREFIX "${name}."
    DISCOVERY_MODE PRE_TEST
    PROPERTIES TIMEOUT ${arg_TIMEOUT})
endfunction()
