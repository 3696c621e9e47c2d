#pragma once
// What this process asks of the disk: DiskCalls.cpp takes the place of the C
// library's functions.

#include <cerrno>
#include <string>
#include <vector>

namespace testing_disk {

/// Notes, while it exists, in their order: `sync NAME` (fsync), `sync all`, `rename NAME` (the new
/// name; `, locked` where the folder is locked meanwhile), `exchange NAME`, `open NAME` (to read).
class DiskCalls {
 public:
  DiskCalls();
  ~DiskCalls();
  DiskCalls(const DiskCalls&) = delete;
  DiskCalls& operator=(const DiskCalls&) = delete;

  const std::vector<std::string>& all() const { return m_calls; }
  /// The calls that begin so.
  std::vector<std::string> of(const std::string& kind) const;

  int failSync = 0;           ///< errno of every fsync and syncfs; 0: they work
  bool failExchange = false;  ///< as on a file system that cannot exchange two names
  int othersLocks = 0;        ///< number of the next locks that another holds

 private:
  friend struct DiskCallNotes;
  std::vector<std::string> m_calls;
};

}  // namespace testing_disk
