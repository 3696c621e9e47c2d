#pragma once
/// \file Classes.h
/// \brief The classes of the Python module `polemcl`. Each function adds those of one subject.
///
/// Calls release Python's lock while the library works (Lock.h). Calls on one object wait for each
/// other, so that objects can be shared between threads.

#include <pybind11/pybind11.h>

#include <filesystem>

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

}  // namespace polemcl::apps::python
