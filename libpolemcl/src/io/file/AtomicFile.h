#pragma once
/// \file AtomicFile.h
/// \brief Outputs that are complete or not there: written beside the target, renamed when done.

#include <filesystem>
#include <fstream>

namespace polemcl::io {

/// \brief A file that appears under its name only once it is complete.
///
/// The temporary lies in the target's folder, ends in `.tmp`, and is removed unless committed. Safe
/// against a full disk and against a process that ends at any moment; what a power failure leaves
/// is up to the file system (nothing is synced).
///
/// A symbolic link to a regular file stays a link; the file it names is replaced.
class AtomicFile {
 public:
  /// \brief Creates the temporary. Permissions follow the umask, as for any new file.
  /// \throws Error when the folder is missing or not writable, or when `path` is there and is no
  ///         regular file (a folder, a device).
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// \brief Where to write; binary.
  std::ofstream& stream() { return m_stream; }
  /// \brief For writers that open files themselves; they must have closed it before commit().
  const std::filesystem::path& temporaryPath() const { return m_temporary; }
  /// \brief Completes the file and gives it its name, replacing what was there.
  /// \throws Error when any write failed (full disk); the target is then as it was before. Also
  ///         when called twice.
  void commit();

 private:
  std::filesystem::path m_target, m_temporary;
  std::ofstream m_stream;
  bool m_open = true;  ///< the temporary exists and is ours
};

}  // namespace polemcl::io
