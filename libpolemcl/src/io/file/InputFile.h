#pragma once
/// \file InputFile.h
/// \brief Tells files that can be read to their end from those that nobody should open.

#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>

#include <filesystem>

namespace polemcl::io {

/// \brief Why this is no input; null for a regular file and for a pipe that a shell made, as
/// `<(zcat …)` and `/dev/stdin` are. A device may have no end, and a named pipe may have no
/// writer: to open it would wait. Null also where nothing is there: opening tells why.
inline const char* whyNoInput(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || S_ISREG(status.st_mode)) return nullptr;
  if (S_ISDIR(status.st_mode)) return "it is a folder, not a file";
  struct statfs system {};
  const bool isOfAShell = S_ISFIFO(status.st_mode) && ::statfs(file.c_str(), &system) == 0 &&
                          system.f_type == PIPEFS_MAGIC;
  return isOfAShell ? nullptr : "it is a device or a named pipe; name a regular file";
}

}  // namespace polemcl::io
