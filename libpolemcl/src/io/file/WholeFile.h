#pragma once
/// \file WholeFile.h
/// \brief Small files as one text.

#include <filesystem>
#include <string>
#include <string_view>

namespace polemcl::io {

/// \brief All bytes. \throws Error when the file cannot be read.
std::string contentOf(const std::filesystem::path& file);

/// \brief Writes the file, see AtomicFile. \throws Error when it cannot be written.
void writeContent(const std::filesystem::path& file, std::string_view content);

/// \brief Length of the UTF-8 character that begins at this byte; 0 when no character begins there.
std::size_t characterLength(std::string_view text, std::size_t at);

}  // namespace polemcl::io
