#pragma once
/// \file Classes.h
/// \brief The classes of the Python module `polemcl`. Each function adds those of one subject.
///
/// Calls release Python's lock while the library works. Calls on one object wait for each other,
/// so that objects can be shared between threads.

#include <pybind11/pybind11.h>

#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>

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

/// \brief Does work without Python's lock. `work` must not touch Python. A thread that takes the
/// lock again while Python ends is ended there: so not in a destructor, and not while an exception
/// is on its way (py::gil_scoped_release is both).
template <class Work>
auto withoutLock(const Work& work) -> decltype(work()) {
  constexpr bool isVoid = std::is_void_v<decltype(work())>;
  std::conditional_t<isVoid, char, std::optional<decltype(work())>> result{};
  std::exception_ptr failure;
  PyThreadState* const state = PyEval_SaveThread();
  try {
    if constexpr (isVoid)
      work();
    else
      result.emplace(work());
  } catch (...) {
    failure = std::current_exception();
  }
  PyEval_RestoreThread(state);
  if (failure) std::rethrow_exception(failure);
  if constexpr (!isVoid) return std::move(*result);
}

/// \brief The same, alone on an object.
template <class Work>
auto alone(std::mutex& object, const Work& work) {
  return withoutLock([&] {
    const std::lock_guard<std::mutex> lock(object);
    return work();
  });
}

}  // namespace polemcl::apps::python
