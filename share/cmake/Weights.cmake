# Turns a table of fitted weights into rows of C++: the columns after the first, which names the term.
#   polemcl_weights(CSV HEADER)
# A row "name,1,2" becomes TERM(name, 1, 2).
function(polemcl_weights csv header)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${csv})
  file(STRINGS ${csv} rows REGEX "^[^#]")
  list(POP_FRONT rows)  # names of the columns
  set(text "")
  foreach(row IN LISTS rows)
    if(NOT row MATCHES "^[A-Za-z]+(,[-+.0-9e]+)+$")
      message(FATAL_ERROR "${csv}: cannot read the row \"${row}\"")
    endif()
    string(REPLACE "," ", " cells ${row})
    string(APPEND text "TERM(${cells})\n")
  endforeach()
  file(CONFIGURE OUTPUT ${header} CONTENT "${text}" @ONLY)
endfunction()
