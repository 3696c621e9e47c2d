#pragma once
/// \file InstalledFiles.h
/// \brief Where the running program lies, and the files that are installed with it.

#include <filesystem>
#include <string>

namespace polemcl::io {

/// \brief The folder of the running program, links resolved.
std::filesystem::path programFolder();

/// \brief A file by its name among those installed with the programs, whatever the working folder
/// holds.
///
/// It is looked for in `../share/polemcl/FOLDER` beside the folder of the program, then in
/// `share/polemcl/FOLDER` of the three folders above this library or module, then in the data
/// folder chosen when it was built. The name may begin with FOLDER, as in a source tree:
/// `config/nclt.ini`. \param folder `config`, `models`, `published` or `report`. \return Empty when
/// it is in neither, or when `file` is empty or absolute.
std::filesystem::path fileOfDataFolder(const std::filesystem::path& file,
                                       const std::string& folder);

/// \brief A file by its path, or by its name among the installed ones.
///
/// A path to an existing file is returned as it is; another one is given to fileOfDataFolder().
/// \return `file` as it is when it is found nowhere, so that messages name what the user typed.
std::filesystem::path installedFile(const std::filesystem::path& file, const std::string& folder);

/// \brief A module, by its name, that is loaded when it is needed: beside the program, in `../lib`
/// or `../lib/polemcl` beside its folder, or where it was to be installed. \return The bare name
/// when it is in none of these: it is left to the loader.
std::filesystem::path installedModule(const std::string& name);

}  // namespace polemcl::io
