#include "io/file/InstalledFiles.h"

#include <dlfcn.h>

#include <system_error>
#include <vector>

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

/// Where files may be installed: beside the program's folder; above this library or module, which
/// is up to three folders below the one that holds share/; the folder chosen when it was built.
std::vector<fs::path> dataFolders() {
  const fs::path data = fs::path("share") / "polemcl";
  std::vector<fs::path> folders{programFolder().parent_path() / data};
  Dl_info library = {};
  std::error_code ignored;
  if (dladdr(reinterpret_cast<void*>(&dataFolders), &library) != 0) {
    fs::path above = fs::canonical(library.dli_fname, ignored).parent_path();  // empty: not known
    for (int i = 0; i < 3 && !above.empty(); ++i)
      folders.push_back((above = above.parent_path()) / data);
  }
  folders.emplace_back(POLEMCL_DATADIR);
  return folders;
}

}  // namespace

fs::path programFolder() {
  return fs::read_symlink("/proc/self/exe").parent_path();
}

fs::path fileOfDataFolder(const fs::path& file, const std::string& folder) {
  if (file.empty() || file.is_absolute()) return {};
  std::error_code ignored;
  for (const fs::path& data : dataFolders()) {
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
