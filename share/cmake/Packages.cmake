# Packages of Debian, one for each component: share/setup/build.sh package package
# The preset `package` builds for the prefix /usr, where Debian looks for libraries and Python modules.
set(POLEMCL_MAINTAINER "The polemcl developers <developers@polemcl.invalid>" CACHE STRING
    "Maintainer of the Debian packages: NAME <ADDRESS>")
set(documents ${PROJECT_BINARY_DIR}/packages)

# The changelog of the packages; users read the project's own.
set(date_of_changelog "${POLEMCL_DATE}T12:00:00Z")
execute_process(COMMAND date --utc --date=${date_of_changelog} "+%a, %d %b %Y %H:%M:%S +0000"
                OUTPUT_VARIABLE date_of_changelog OUTPUT_STRIP_TRAILING_WHITESPACE)
execute_process(COMMAND sh -c ". /etc/os-release; echo \${VERSION_CODENAME:-unstable}"
                OUTPUT_VARIABLE release OUTPUT_STRIP_TRAILING_WHITESPACE)
file(WRITE ${documents}/changelog.Debian "polemcl (${PROJECT_VERSION}-1) ${release}; urgency=medium

  * Built from the project's sources. What changed: CHANGELOG.md in polemcl-doc.

 -- ${POLEMCL_MAINTAINER}  ${date_of_changelog}\n")
execute_process(COMMAND gzip -9nf ${documents}/changelog.Debian)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
string(STRIP "${license}" license)
string(REPLACE "\n" "\n " license "${license}")
string(REPLACE "\n \n" "\n .\n" license "${license}")
file(WRITE ${documents}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: polemcl

Files: *
Copyright: 2026, the polemcl developers
License: BSD-3-Clause
 ${license}\n")

# Debian's way to tell the loader of libraries; CPack's scripts, which call ldconfig, do no harm.
file(WRITE ${documents}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${documents}/triggers)

#   polemcl_package(COMPONENT NAME SECTION DEPENDS SUMMARY TEXT)
function(polemcl_package component name section depends summary text)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  install(FILES ${documents}/copyright ${documents}/changelog.Debian.gz
          DESTINATION share/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
endfunction()

set(method "polemcl finds poles (lamp posts, signs, trunks) in 3D LiDAR scans, builds
maps of them, and localizes a vehicle in such a map with the particle
filter of MRPT.
.
")
set(library libpolemcl${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})  # by the SOVERSION, as Debian wants it
set(same "(= ${PROJECT_VERSION}-1)")
set(CPACK_COMPONENTS_ALL "")
polemcl_package(library ${library} libs "" "Pole-based LiDAR localization: library and plugin of MRPT"
  "${method}This package holds the library, which programs of MRPT load as a
plugin, and the drivers of sensors.")
polemcl_package(programs polemcl science "${library} ${same}, python3, python3-jinja2, python3-matplotlib"
  "Pole-based LiDAR localization: programs"
  "${method}This package holds the programs, their settings, models, man pages
and completion.")
polemcl_package(dev libpolemcl-dev libdevel
  "${library} ${same}, libceres-dev, libeigen3-dev, libhwy-dev, libmrpt-config-dev, libmrpt-maps-dev, libmrpt-obs-dev, libmrpt-opengl-dev, libmrpt-slam-dev"
  "Pole-based LiDAR localization: headers"
  "${method}This package holds the headers, the library without MRPT, and the
CMake package.")
polemcl_package(doc polemcl-doc doc "" "Pole-based LiDAR localization: documents and examples"
  "${method}This package holds the documents, examples in C++ and Python, and
reports of experiments.")
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
if(POLEMCL_PYTHON)
  # The module is for the Python that it was built with.
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(python "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next})")
  polemcl_package(python python3-polemcl python "polemcl ${same}, ${python}, python3-numpy"
    "Pole-based LiDAR localization: Python module"
    "${method}This package holds the Python module, which takes and gives arrays of
NumPy.")
endif()

# Documents keep their folders, so that their links hold.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff
        DESTINATION share/doc/polemcl COMPONENT doc EXCLUDE_FROM_ALL)
install(DIRECTORY share/doc share/examples share/reports share/figures share/ros
        DESTINATION share/doc/polemcl/share COMPONENT doc EXCLUDE_FROM_ALL
        PATTERN live.sh EXCLUDE PATTERN try.sh EXCLUDE)

set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES TRUE)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/share/cmake/BeforePackages.cmake)
set(CPACK_PACKAGE_VENDOR polemcl)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${POLEMCL_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
