#include <dlfcn.h>

#include <filesystem>

#include <polemcl/config/Config.h>
#include "python/Classes.h"

namespace py = pybind11;

namespace polemcl::apps::python {
namespace {

namespace fs = std::filesystem;

/// The program that runs is Python, so settings installed with this module are looked for from the
/// place of the module: three folders below that which also holds share/.
fs::path configPath(const fs::path& name) {
  Dl_info module = {};
  std::error_code ignored;
  if (!fs::exists(name, ignored) && dladdr(reinterpret_cast<void*>(&configPath), &module) != 0) {
    const fs::path folder = fs::canonical(module.dli_fname, ignored).parent_path();
    fs::path file = folder / ".." / ".." / ".." / "share" / "polemcl" / "config" / name;
    if (fs::is_regular_file(file, ignored)) return file;
  }
  return name;
}

/// A value as an INI file has it.
std::string textOf(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) return py::str(value);
  std::string text;
  for (const py::handle& item : value) text += (text.empty() ? "" : " ") + textOf(item);
  return text;
}

}  // namespace

Settings settingsFrom(const fs::path& configFile, const py::dict& values) {
  std::vector<std::string> assignments;
  for (const auto& [key, value] : values)
    assignments.push_back(std::string(py::str(key)) + "=" + textOf(value));
  if (!configFile.empty()) return loadSettings(configPath(configFile).string(), assignments);
  return apps::settingsFrom(ConfigFile::fromText("", "settings"), assignments);
}

}  // namespace polemcl::apps::python
