#pragma once
/// \file InstalledFiles.h
/// \brief Where the running program lies, and the files that are installed with it.

#include <filesystem>
#include <string>

namespace polemcl::io {

/// \brief The folder of the running program, links resolved.
std::filesystem::path programFolder();

/// \brief A file by its path, or by its name among the files installed with the programs.
///
/// A path to an existing file is returned as it is. Another relative path is looked for in
/// `../share/polemcl/FOLDER` beside the folder of the program, then in `share/polemcl/FOLDER` of
/// the three folders above this library or module, then in the data folder chosen when it was
/// built. \param folder `config` or `models`. \return `file` as it is when it is found nowhere, so
/// that messages name what the user typed.
std::filesystem::path installedFile(const std::filesystem::path& file, const std::string& folder);

/// \brief A module, by its name, that is loaded when it is needed: beside the program, in `../lib`
/// or `../lib/polemcl` beside its folder, or where it was to be installed. \return The bare name
/// when it is in none of these: it is left to the loader.
std::filesystem::path installedModule(const std::string& name);

}  // namespace polemcl::io
