# Writes a source file that says what the programs are built from and how. Each build runs this; the
# file is touched only when that has changed, so that nothing else is compiled again.
#   cmake -D SOURCE=DIR -D OUTPUT=FILE -D COMPILER=TEXT -D TYPE=TEXT -D OPTIONS=TEXT -P BuildIdentity.cmake
# From a git checkout: the commit, and when sources are not committed "+" and a hash of the sources.
# From an archive of the sources: "sources-" and that hash.
cmake_minimum_required(VERSION 3.25)

# What goes into the programs: changes elsewhere (tests, documents) are no changes of the build.
set(parts CMakeLists.txt apps libpolemcl share/cmake)

function(hash_of_sources result)
  set(text "")
  foreach(part IN LISTS parts)
    file(GLOB_RECURSE files LIST_DIRECTORIES false RELATIVE ${SOURCE} ${SOURCE}/${part} ${SOURCE}/${part}/*)
    list(SORT files)
    foreach(name IN LISTS files)
      file(SHA256 ${SOURCE}/${name} sum)
      string(APPEND text "${name} ${sum}\n")
    endforeach()
  endforeach()
  string(SHA256 sum "${text}")
  string(SUBSTRING ${sum} 0 12 sum)
  set(${result} ${sum} PARENT_SCOPE)
endfunction()

# Only for a checkout of this project: an archive unpacked inside another project has no commit of its own.
set(revision "")
find_program(git git)
if(git AND EXISTS ${SOURCE}/.git)
  # No optional locks: a build must not stand in the way of a git command beside it.
  set(command ${git} --no-optional-locks -C ${SOURCE})
  execute_process(COMMAND ${command} rev-parse --short=12 HEAD RESULT_VARIABLE failed
                  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${command} status --porcelain -- ${parts} RESULT_VARIABLE failedToo
                  OUTPUT_VARIABLE changes ERROR_QUIET)
  if(failed OR failedToo)
    set(revision "")
  elseif(NOT changes STREQUAL "")
    hash_of_sources(sources)
    string(APPEND revision "+${sources}")
  endif()
endif()
if(revision STREQUAL "")
  hash_of_sources(sources)
  set(revision "sources-${sources}")
endif()

string(REGEX REPLACE "[ ]+" " " identity "${revision}, ${COMPILER}, ${TYPE}, ${OPTIONS}")
string(STRIP "${identity}" identity)
set(content "// Written by share/cmake/BuildIdentity.cmake.
#include \"cli/Version.h\"

namespace polemcl::apps {
const char* buildIdentity() {
  return R\"identity(${identity})identity\";
}
}  // namespace polemcl::apps
")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL content)
  file(WRITE ${OUTPUT} "${content}")
endif()
