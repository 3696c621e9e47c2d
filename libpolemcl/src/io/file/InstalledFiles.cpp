#include "io/file/InstalledFiles.h"

#include <system_error>

namespace polemcl::io {

namespace fs = std::filesystem;

fs::path programFolder() {
  return fs::read_symlink("/proc/self/exe").parent_path();
}

fs::path fileOfDataFolder(const fs::path& file, const std::string& folder) {
  if (file.empty() || file.is_absolute()) return {};
  std::error_code ignored;
  for (const fs::path& data :
       {programFolder().parent_path() / "share" / "polemcl", fs::path(POLEMCL_DATADIR)}) {
    if (fs::is_regular_file(data / folder / file, ignored)) return data / folder / file;
    if (*file.begin() == folder && fs::is_regular_file(data / file, ignored)) return data / file;
  }
  return {};
}

fs::path installedFile(const fs::path& file, const std::string& folder) {
  std::error_code ignored;
  if (file.empty() || fs::exists(file, ignored)) return file;
  const fs::path installed = fileOfDataFolder(file, folder);
  return installed.empty() ? file : installed;
}

fs::path installedModule(const std::string& name) {
  const fs::path program = programFolder();
  std::error_code ignored;
  const fs::path libraries = program.parent_path() / "lib";
  for (const fs::path& folder :
       {program, libraries, libraries / "polemcl", fs::path(POLEMCL_LIBDIR)})
    if (fs::exists(folder / name, ignored)) return folder / name;
  return name;
}

}  // namespace polemcl::io
