# A room is a folder of sources with one internal static library. Private headers are included by
# their path from the folder of the rooms, always in quotes: "core/common/KdTree2D.h"; public ones
# in angle brackets: <polemcl/core/common/Types.h>.
#   polemcl_room(NAME [sources...])
function(polemcl_room name)
  add_library(${name} STATIC ${ARGN})
  # Larger unity files read the headers less often.
  set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 24)
  polemcl_public_headers(${name})
  polemcl_private_headers(${name} PUBLIC)
endfunction()

function(polemcl_public_headers name)
  target_compile_features(${name} PUBLIC cxx_std_17)
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/libpolemcl/include>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()

# The flag -iquote keeps the room mrpt/ apart from the headers of MRPT, which are in angle brackets.
function(polemcl_private_headers name scope)
  foreach(folder libpolemcl/src apps)
    target_compile_options(${name} ${scope}
      "$<BUILD_INTERFACE:SHELL:-iquote ${PROJECT_SOURCE_DIR}/${folder}>")
  endforeach()
endfunction()

# Sources that must be compiled alone: Highway includes them once for each instruction set.
function(polemcl_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# For rooms that do not compute for long: they compile in little more than half of the time.
function(polemcl_compile_quickly name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()
