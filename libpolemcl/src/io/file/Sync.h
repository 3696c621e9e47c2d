#pragma once
/// \file Sync.h
/// \brief Waits until something is on the disk, so that it survives a power cut.

#include <filesystem>
#include <system_error>

namespace polemcl::io {

/// \brief The content of a file. \return Why that failed.
std::error_code syncFile(const std::filesystem::path& file);

/// \brief The names in a folder: what was renamed or removed there. Nothing happens where the file
/// system cannot do that, or the folder may not be read. \throws Error when the disk fails.
void syncFolder(const std::filesystem::path& folder);

/// \brief All that was written to the file system of `folder`: one call for thousands of files,
/// each of which would take milliseconds. \throws Error when the disk fails.
void syncAll(const std::filesystem::path& folder);

}  // namespace polemcl::io
