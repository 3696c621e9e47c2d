# Writes the ctest entries of a test program, one for each suite: a process for a suite takes a fraction
# of the time of a process for each test.
#   cmake -D PROGRAM=FILE -D ROOM=NAME -D OUTPUT=FILE -D LABELS=a,b,... -D LABEL_a=LIST ... -P TestSuites.cmake
# Each LIST holds ROOM.Suite or ROOM.Suite.Test, separated by commas: the suites and single tests with
# that label. All others have the label "unit". A suite with several labels has an entry for each.
# An entry whose tests all pass or skip, and one skips, is "Skipped" (tests/support/Main.cpp).
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listing RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests failed: ${failed}")
endif()

# The lists, one variable for each name: label_ROOM.Suite.
string(REPLACE "," ";" labels "${LABELS}")
set(named "")
foreach(label IN LISTS labels)
  string(REPLACE "," ";" names "${LABEL_${label}}")
  foreach(name IN LISTS names)
    set(label_${name} ${label})
    list(APPEND named ${name})
  endforeach()
endforeach()

# Adds the entries of the suite that has just been read: its tests are in tests_LABEL.
function(write_suite)
  set(used "")
  foreach(label IN ITEMS unit ${labels})
    if(tests_${label})
      list(APPEND used ${label})
    endif()
  endforeach()
  list(LENGTH used count)
  foreach(label IN LISTS used)
    set(entry "${ROOM}.${suite}")
    set(filter "${suite}.*")
    set(cost "")
    if(NOT label STREQUAL unit)
      set(cost " COST 100")  # starts first, so that no long suite is left at the end
    endif()
    if(count GREATER 1 AND label STREQUAL unit)
      set(others ${tests_of_suite})
      list(REMOVE_ITEM others ${tests_unit})
      list(JOIN others ":" others)
      string(APPEND filter "-${others}")
    elseif(count GREATER 1)
      list(JOIN tests_${label} ":" filter)
      string(APPEND entry ".${label}")
    endif()
    file(APPEND ${OUTPUT}.new
      "add_test([=[${entry}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${filter}]=] --skip-code=77)\n"
      "set_tests_properties([=[${entry}]=] PROPERTIES LABELS ${label}${cost} TIMEOUT 1800 SKIP_RETURN_CODE 77)\n")
  endforeach()
endfunction()

file(WRITE ${OUTPUT}.new "")
set(suite "")
set(found "")
string(REPLACE ";" "," listing "${listing}")  # in the comments on parameters
string(REPLACE "\n" ";" lines "${listing}")
foreach(line IN LISTS lines)
  if(line MATCHES "^([A-Za-z0-9_/]+)\\.( *#.*)?$")
    write_suite()
    set(suite ${CMAKE_MATCH_1})
    set(tests_of_suite "")
    foreach(label IN ITEMS unit ${labels})
      set(tests_${label} "")
    endforeach()
    string(REGEX REPLACE "^[^/]*/" "" plain ${suite})  # without the name of the parameters
  elseif(line MATCHES "^  ([A-Za-z0-9_/]+)")
    set(test ${CMAKE_MATCH_1})
    string(REGEX REPLACE "/.*" "" plainTest ${test})
    set(label unit)
    foreach(name IN ITEMS ${ROOM}.${plain} ${ROOM}.${plain}.${plainTest})
      if(DEFINED label_${name})
        set(label ${label_${name}})
        list(APPEND found ${name})
      endif()
    endforeach()
    list(APPEND tests_of_suite ${suite}.${test})
    list(APPEND tests_${label} ${suite}.${test})
  endif()
endforeach()
write_suite()

list(REMOVE_ITEM named ${found} "")
if(named)
  list(JOIN named ", " names)
  message(FATAL_ERROR "tests/CMakeLists.txt gives a label to what ${PROGRAM} does not hold: ${names}. "
    "Mend the names there: they are ROOM.Suite or ROOM.Suite.Test, without the names of parameters")
endif()
file(RENAME ${OUTPUT}.new ${OUTPUT})
