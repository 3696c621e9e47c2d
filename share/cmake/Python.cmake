# Python and pybind11 for the module. The first Python 3 in PATH is taken, as CMake's FindPython3 does,
# unless Python3_EXECUTABLE names another.
find_package(Python3 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
if(NOT Python3_FOUND)
  message(FATAL_ERROR "POLEMCL_PYTHON: '${Python3_EXECUTABLE}' is no Python 3.9 or later with headers and NumPy. "
    "Install python3-dev and python3-numpy, or name another one: -DPython3_EXECUTABLE=/usr/bin/python3")
endif()
find_package(pybind11 REQUIRED)
set(POLEMCL_PYTHON_EXECUTABLE ${Python3_EXECUTABLE} CACHE INTERNAL "Python of the module, for tests/install/run.sh")
# At the same place below the build as below the prefix of the installation: there the module finds
# installed settings. With the prefix /usr/local, Debian's Python finds the module by itself.
set(POLEMCL_PYTHON_FOLDER lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/dist-packages)
if(CMAKE_INSTALL_PREFIX STREQUAL /usr)  # where Debian keeps the modules of packages
  set(POLEMCL_PYTHON_FOLDER lib/python3/dist-packages)
endif()
if(SKBUILD)  # pip: the module at the top of its folder of modules, settings in the share/ that the module looks in
  set(POLEMCL_PYTHON_FOLDER .)
  install(DIRECTORY config DESTINATION ${SKBUILD_DATA_DIR}/share/polemcl COMPONENT python)
endif()
