#pragma once
/// \file Leftovers.h
/// \brief Tells the temporary files and folders of a running process from what a killed one left:
/// the former are locked.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace polemcl::io {

/// \brief A lock on a file or folder, until the object or the process ends.
class PathLock {
 public:
  PathLock() = default;
  /// \brief Locks the regular file or folder that is there; isHeld() tells whether that worked.
  explicit PathLock(const std::filesystem::path& path);
  /// \brief Takes over an open descriptor.
  explicit PathLock(int descriptor);
  /// \brief Waits while another has it. Holds nothing where a file system has no locks.
  static PathLock waitFor(const std::filesystem::path& path);
  ~PathLock();
  PathLock(PathLock&& other) noexcept;
  PathLock& operator=(PathLock&& other) noexcept;
  /// \brief False also when another process has removed the file or folder before it was locked.
  bool isHeld() const { return m_isHeld; }
  /// \brief Another process, or this one, had locked it before.
  bool isOfAnother() const { return m_isOfAnother; }

 private:
  int m_descriptor = -1;
  bool m_isHeld = false, m_isOfAnother = false;
};

/// \brief Files and folders in `folder` that nobody has locked.
/// \param isTemporary Whether a name is one of ours.
std::vector<std::filesystem::path> leftoversIn(
    const std::filesystem::path& folder,
    const std::function<bool(const std::string& name)>& isTemporary);

/// \brief True for `TARGET.PROCESS-NUMBER.tmp`.
bool isTemporaryOf(const std::string& target, const std::string& name);

/// \brief Removes what killed processes left of `target`, by the names of isTemporaryOf().
/// \param isOurs Whether what has such a name may be removed, with all that is in it: others may
///        have given the name.
void removeLeftovers(const std::filesystem::path& target,
                     const std::function<bool(const std::filesystem::path& path)>& isOurs);

}  // namespace polemcl::io
