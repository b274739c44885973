# fovea_discover_suites(PROGRAM LABEL [EACH_TEST]): one CTest case for each suite of a GoogleTest program, or for each
# test. The cases have the label, except for those whose names begin with `Long`, which are labelled `long` instead.
#
# gtest_discover_tests makes a case, and so a process, of each test. Where tests are short, most of their time would go
# into loading the 270 libraries behind OpenImageIO and into opening a device. The program lists its suites after it is
# linked, by this same file run as a script with PROGRAM, LABEL, EACH_TEST and CASES, the file that CTest includes.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  function(fovea_discover_suites program label)
    cmake_parse_arguments(PARSE_ARGV 2 FOVEA EACH_TEST "" "")
    set(cases ${CMAKE_CURRENT_BINARY_DIR}/${program}_suites.cmake)
    add_custom_command(TARGET ${program} POST_BUILD BYPRODUCTS ${cases} VERBATIM
      COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${program}> -D LABEL=${label}
        -D EACH_TEST=${FOVEA_EACH_TEST} -D CASES=${cases} -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE})
    # A program that is not built fails as a case without a label, as with gtest_discover_tests.
    set(included ${CMAKE_CURRENT_BINARY_DIR}/${program}_include.cmake)
    file(WRITE ${included} "if(EXISTS \"${cases}\")\n  include(\"${cases}\")\nelse()\n"
      "  add_test(${program}_NOT_BUILT ${program}_NOT_BUILT)\nendif()\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${included})
  endfunction()
  return()
endif()

# A suite counts as skipped if no test passed and the report ends with the list of those that were skipped, as that of
# failures would follow it.
set(skipped "PASSED  \\] 0 tests\\..*SKIPPED \\] [^\n]*\n*$")

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " +#[^\n]*" "" list "${list}")  # values of parameters
string(REGEX MATCHALL "[^\n]+" lines "${list}")
set(text "")
foreach(line IN LISTS lines)
  if(line MATCHES "^[^ ]+\\.$")
    set(suite ${line})
    set(label ${LABEL})
    if(suite MATCHES "^Long")
      set(label long)
    endif()
    if(EACH_TEST)
      continue()
    endif()
    string(REGEX REPLACE "\\.$" "" case ${suite})
    set(filter ${suite}*)
  elseif(EACH_TEST AND NOT line MATCHES "DISABLED_" AND line MATCHES "^  ([^ ]+)$")
    set(case ${suite}${CMAKE_MATCH_1})
    set(filter ${case})
  else()
    continue()
  endif()
  string(APPEND text "add_test([==[${case}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${filter}]==])\n"
    "set_tests_properties([==[${case}]==] PROPERTIES LABELS ${label} SKIP_REGULAR_EXPRESSION [==[${skipped}]==])\n")
endforeach()
file(WRITE ${CASES} "${text}")
