# CPack runs this before it makes a package: Debian compresses man pages.
file(GLOB_RECURSE pages ${CPACK_TEMPORARY_DIRECTORY}/*.1)
list(FILTER pages INCLUDE REGEX /man1/)
foreach(page IN LISTS pages)
  execute_process(COMMAND gzip -9nf ${page} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# Packages of an earlier version must not be installed with those of this one.
file(GLOB old ${CPACK_PACKAGE_DIRECTORY}/*.deb)
if(old)
  file(REMOVE ${old})
endif()
