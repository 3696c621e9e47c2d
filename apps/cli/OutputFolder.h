#pragma once
/// \file OutputFolder.h
/// \brief Folders of results that are complete or not there.

#include <filesystem>
#include <string>
#include <vector>

#include "io/file/Leftovers.h"

namespace polemcl::apps {

/// \brief A folder that appears under its name only once it is complete and on the disk: filled
/// beside its place under a temporary name ending in `.tmp`, then renamed. An earlier output stays
/// until that moment; on a file system that cannot exchange two folders, a process killed in it
/// leaves the earlier one as `….tmp.old`. Removed again unless committed; what a killed process
/// left is removed by the next one for the same target, unless it holds anything else.
class OutputFolder {
 public:
  /// \param target Where the folder shall appear. It replaces an empty folder, and an earlier
  ///        output: one that holds nothing but `known` names, `marker` among them. A name is a
  ///        path in the folder; it may have wildcards (fnmatch).
  /// \param what What the folder holds, for messages, such as "a simulated drive".
  /// \throws Error when something else is there (named), or the place is not writable.
  OutputFolder(const std::filesystem::path& target, const std::string& what,
               const std::vector<std::string>& known, const std::string& marker);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// \brief The folder to fill.
  const std::filesystem::path& temporary() const { return m_temporary; }
  /// \brief Gives the folder its name; an earlier output is removed.
  /// \throws Error when it cannot be renamed, or others wrote there; what was there stays.
  void commit();

 private:
  std::string foreignIn(const std::filesystem::path& folder, bool isUnderWay) const;
  void refuseForeign() const;

  std::filesystem::path m_target, m_temporary;
  std::string m_what, m_marker;
  std::vector<std::string> m_known;
  io::PathLock m_lock;  ///< on `m_temporary`
};

}  // namespace polemcl::apps
