#include <filesystem>

#include "config/Config.h"
#include "python/Classes.h"

namespace py = pybind11;

namespace polemcl::apps::python {
namespace {

namespace fs = std::filesystem;

/// A value as an INI file has it.
std::string textOf(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) return py::str(value);
  std::string text;
  for (const py::handle& item : value) text += (text.empty() ? "" : " ") + textOf(item);
  return text;
}

}  // namespace

AllSettings settingsFrom(const fs::path& configFile, const py::dict& values) {
  std::vector<std::string> assignments;
  for (const auto& [key, value] : values)
    assignments.push_back(std::string(py::str(key)) + "=" + textOf(value));
  if (!configFile.empty()) return loadSettings(configFile.string(), assignments);
  return apps::settingsFrom(ConfigFile::fromText("", "settings"), assignments);
}

}  // namespace polemcl::apps::python
