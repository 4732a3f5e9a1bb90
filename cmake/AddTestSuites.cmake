# Read by ctest for each GoogleTest program of overfly_test (cmake/OverflyRoom.cmake), with
#   PROGRAM  the program        PREFIX   of the names of its ctest cases
#   TIMEOUT  seconds per suite  RESULTS  folder of the suites' results as XML
# Adds a ctest case PREFIX.SUITE for each suite. The suites are listed again when the program is newer
# than the list.

set(list "${PROGRAM}_suites.txt")
if(NOT EXISTS "${PROGRAM}")
  add_test(${PREFIX}.NOT_BUILT "${PROGRAM}")
  return()
endif()
if(NOT EXISTS "${list}" OR "${PROGRAM}" IS_NEWER_THAN "${list}")
  execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE output RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${PROGRAM} --gtest_list_tests failed: ${failed}\n${output}")
  endif()
  file(WRITE "${list}" "${output}")
endif()
# A suite's line is not indented and ends with a dot, or with a comment on its parameter's type.
file(STRINGS "${list}" lines REGEX "^[^ #]+\\.( +#.*)?$")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "\\.( +#.*)?$" "" suite "${line}")
  string(REPLACE "/" "." name "${PREFIX}.${suite}")
  add_test(${name} "${PROGRAM}" "--gtest_filter=${suite}.*" "--gtest_output=xml:${RESULTS}/${name}.xml")
  set_tests_properties(${name} PROPERTIES TIMEOUT ${TIMEOUT})
endforeach()
