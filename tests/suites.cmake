# Read by ctest itself, with `program`, `list`, `prefix`, `properties` and `self`, who says so, set: one test per suite of a
# GoogleTest program, found after the build (as gtest_discover_tests' PRE_TEST does per test).
if(NOT EXISTS "${program}")
  add_test("${prefix}_NOT_BUILT" "${prefix}_NOT_BUILT")
  return()
endif()
if(NOT EXISTS "${list}" OR "${program}" IS_NEWER_THAN "${list}" OR
   "${self}" IS_NEWER_THAN "${list}" OR "${CMAKE_CURRENT_LIST_FILE}" IS_NEWER_THAN "${list}")
  execute_process(COMMAND "${program}" --gtest_list_tests OUTPUT_VARIABLE lines
                  RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${program} does not list its tests: ${failed}")
  endif()
  string(REGEX MATCHALL "(^|\n)[A-Za-z][A-Za-z0-9_/]*\\." suites "${lines}")
  set(text "")
  foreach(suite IN LISTS suites)
    string(REGEX REPLACE "[\n.]" "" suite "${suite}")
    string(APPEND text "add_test(\"${prefix}.${suite}\" \"${program}\" \"--gtest_filter=${suite}.*\")\n"
                       "set_tests_properties(\"${prefix}.${suite}\" PROPERTIES ${properties})\n")
  endforeach()
  file(WRITE "${list}" "${text}")
endif()
include("${list}")
