# POLEMCL_DATE: the day of the commit, for man pages and packages; today where there is no git checkout.
find_program(git git)
if(git AND EXISTS ${PROJECT_SOURCE_DIR}/.git)
  execute_process(COMMAND ${git} -C ${PROJECT_SOURCE_DIR} log -1 --format=%cs
                  OUTPUT_VARIABLE POLEMCL_DATE OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT POLEMCL_DATE)
  string(TIMESTAMP POLEMCL_DATE "%Y-%m-%d" UTC)
endif()
