#pragma once
/// \file AtomicFile.h
/// \brief Output files that are either complete or absent: written to a temporary file, then
/// renamed.

#include <filesystem>
#include <fstream>
#include <string_view>

namespace polemcl::io {

/// \brief A file that appears under its name only once it is complete.
///
/// The temporary file lies in the target's folder, ends in `.tmp`, and is removed unless committed.
/// This is safe against a full disk and against a process that ends at any moment. The result of a
/// power failure depends on the file system (nothing is synced).
///
/// If the target is a symbolic link to a regular file, the link stays and the file behind it is
/// replaced.
class AtomicFile {
 public:
  /// \brief Creates the temporary file. Permissions follow the umask, as for any new file.
  /// \throws Error when the folder is missing or not writable, or when `path` exists but is not a
  ///         regular file (a folder, a device).
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// \brief The stream to write to; binary.
  std::ofstream& stream() { return m_stream; }
  /// \brief Path for writers that open files themselves. They must close the file before commit().
  const std::filesystem::path& temporaryPath() const { return m_temporary; }
  /// \brief Completes the file and renames it to the target, replacing an existing file.
  /// \throws Error when a write failed (full disk); the target is then unchanged. Also when called
  ///         twice.
  void commit();

 private:
  std::filesystem::path m_target, m_temporary;
  std::ofstream m_stream;
  bool m_open = true;  ///< the temporary file exists and belongs to this object
};

/// \brief Writes a whole file. \throws Error when it cannot be written.
void writeFile(const std::filesystem::path& file, std::string_view content);

}  // namespace polemcl::io
