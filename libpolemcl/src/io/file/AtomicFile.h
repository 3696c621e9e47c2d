#pragma once
/// \file AtomicFile.h
/// \brief Output files that are either complete or absent: written to a temporary file, then
/// renamed.

#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "io/file/Leftovers.h"

namespace polemcl::io {

/// \brief The content of a file. \return Why that failed.
std::error_code syncFile(const std::filesystem::path& file);

/// \brief The names in a folder: what was renamed or removed there. Nothing happens where the file
/// system cannot do that, or the folder may not be read. \throws Error when the disk fails.
void syncFolder(const std::filesystem::path& folder);

/// \brief All that was written to the file system of `folder`: one call for thousands of files,
/// each of which would take milliseconds. \throws Error when the disk fails.
void syncAll(const std::filesystem::path& folder);

/// \brief A file beside its target that nobody else writes, named `TARGET.….tmp`; removed unless it
/// is renamed. It is locked, so that what a killed process has left can be told from it: that is
/// removed when another one for the same target is made.
class TemporaryFile {
 public:
  /// \throws Error when the folder is missing or not writable.
  explicit TemporaryFile(std::filesystem::path target);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  const std::filesystem::path& target() const { return m_target; }
  const std::filesystem::path& path() const { return m_path; }
  /// \brief Gives it the name of its target. \throws Error when that fails.
  void rename();

 private:
  std::filesystem::path m_target, m_path;  ///< no path: renamed, or moved from
  PathLock m_lock;
};

/// \brief A file that appears under its name only once it is complete.
///
/// The temporary file lies in the target's folder, ends in `.tmp`, and is removed unless committed.
/// This is safe against a full disk, a process that ends at any moment, and a power cut: commit()
/// waits for the disk, before and after it renames.
///
/// If the target is a symbolic link to a regular file, the link stays and the file behind it is
/// replaced.
class AtomicFile {
 public:
  /// \brief Creates the temporary file. Permissions follow the umask, as for any new file.
  /// \throws Error when the folder is missing or not writable, or when `path` exists but is not a
  ///         regular file (a folder, a device).
  explicit AtomicFile(const std::filesystem::path& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// \brief The stream to write to; binary.
  std::ofstream& stream() { return m_stream; }
  const std::filesystem::path& target() const { return m_temporary.target(); }
  /// \brief Where it lies until commit().
  const std::filesystem::path& temporaryPath() const { return m_temporary.path(); }
  /// \brief Completes the file and renames it to the target, replacing an existing file; see
  /// AtomicFiles.
  /// \throws Error when a write failed (full disk); the target is then unchanged. Also when called
  ///         twice.
  void commit();

 private:
  TemporaryFile m_temporary;
  std::ofstream m_stream;
  bool m_committed = false;
};

/// \brief Files that appear together: while it exists, files that this thread commits keep their
/// temporary names. commit() gives them their own; otherwise none of them appears. Of two programs
/// that write the same files at once, all are those of one. At no moment do old and new ones stand
/// together: earlier ones but the last go first. A last one that was there is then replaced before
/// the others come, a new one appears after them.
class AtomicFiles {
 public:
  AtomicFiles();
  ~AtomicFiles();
  AtomicFiles(const AtomicFiles&) = delete;
  AtomicFiles& operator=(const AtomicFiles&) = delete;
  /// \brief Call it once. \throws Error when a file cannot be renamed.
  void commit();

 private:
  friend class AtomicFile;
  std::vector<TemporaryFile> m_complete;
};

/// \brief Writes a whole file. \throws Error when it cannot be written.
void writeFile(const std::filesystem::path& file, std::string_view content);

}  // namespace polemcl::io
