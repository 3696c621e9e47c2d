# The warnings that all sources pass. Headers of other projects are system headers, without warnings.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  add_compile_options(-Wno-sign-conversion)  # not in the -Wconversion of GCC
elseif(POLEMCL_UNITY)
  add_compile_options(-Wno-subobject-linkage)  # a unity build includes every source
endif()
if(POLEMCL_WERROR)
  add_compile_options(-Werror)
endif()
