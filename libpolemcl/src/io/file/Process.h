#pragma once
/// \file Process.h
/// \brief Runs other programs, and the scripts of share/report.

#include <filesystem>
#include <string>
#include <vector>

namespace polemcl::io {

/// \brief A script of share/report as the first words of a command: Debian's Python, which has the
/// packages. \throws Error when Python or the script is missing.
std::vector<std::string> pythonScript(const std::string& name);

/// \brief Runs a program in a folder; what it says is added to the log. \param command Its path,
/// and its arguments. \throws Error with the last line of the log when it fails.
void runLogged(const std::vector<std::string>& command, const std::filesystem::path& folder,
               const std::filesystem::path& log);

/// \brief Runs a program that reads `input` and writes its result to the standard output. No file
/// is made. \return The result. \throws Error with the last line of its errors when it fails.
std::string runFilter(const std::vector<std::string>& command, const std::string& input);

}  // namespace polemcl::io
