#pragma once
/// \file Classes.h
/// \brief The classes of the Python module `polemcl`. Each function adds those of one subject.
///
/// Calls release Python's lock while the library works. Calls on one object wait for each other,
/// so that objects can be shared between threads.

#include <pybind11/pybind11.h>

#include <filesystem>
#include <mutex>

#include "cli/Settings.h"

namespace polemcl::apps::python {

/// \brief The two arguments of all classes with settings.
/// \param configFile An INI file, or the name of an installed one; empty: the defaults.
/// \param values `section.key` -> value, in the place of the file's. Text, numbers, true or false,
///        or a list of numbers.
/// \throws Error as loadSettings().
AllSettings settingsFrom(const std::filesystem::path& configFile, const pybind11::dict& values);

void addExtraction(pybind11::module_& module);    ///< PoleExtractor
void addMaps(pybind11::module_& module);          ///< PoleMap, PoleMapBuilder, PoleLikelihood
void addLocalization(pybind11::module_& module);  ///< Localizer and what a step returns

/// \brief Lets other threads of Python run. A thread that comes back while Python ends is ended by
/// it here: the destructor must let this pass (py::gil_scoped_release does not).
class WithoutLock {
 public:
  WithoutLock() : m_state(PyEval_SaveThread()) {}
  ~WithoutLock() noexcept(false) { PyEval_RestoreThread(m_state); }
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* m_state;
};

/// \brief Does work without Python's lock, alone on an object. `work` must not touch Python.
template <class Work>
auto alone(std::mutex& object, const Work& work) {
  const WithoutLock released;
  const std::lock_guard<std::mutex> lock(object);
  return work();
}

}  // namespace polemcl::apps::python
