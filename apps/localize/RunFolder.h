#pragma once
/// \file RunFolder.h
/// \brief A folder of results that changes only when all of the new ones are there.

#include <filesystem>
#include <string>
#include <vector>

#include "io/file/Leftovers.h"

namespace polemcl::apps {

/// \brief Collects files in a hidden folder beside the old results; commit() swaps them in. Without
/// commit() the old results stay as they were, and a folder that was not there is gone again.
class RunFolder {
 public:
  /// \brief Creates the folder, with those above it, where it is missing.
  /// \throws Error when it cannot be created or written, or is a file.
  explicit RunFolder(const std::filesystem::path& folder);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// \brief Where to write a file, or make a folder of files, that commit() moves into the folder.
  std::filesystem::path staged(const std::string& name) const { return m_staging / name; }

  /// \brief What runs left here that were killed: their results up to then.
  std::vector<std::filesystem::path> leftovers() const;

  /// \brief \throws Error if commit() would take this file away or replace it.
  void protect(const std::filesystem::path& input) const;

  /// \brief Takes the summary and what runs wrote (`run_NN.tum`, `run_NN.json`,
  /// `run_NN_errors.csv`, `run_NN_cov.csv`, `run_NN_health.csv`, folders `run_NN_scenes`) of old
  /// results away and moves the new files in, `summary.json` last: while it is there, the folder is
  /// complete. \throws Error when that fails; before anything is taken away where a folder stands
  /// in the place of a result, or a file or link in that of a folder of results.
  void commit();

 private:
  void requireFreeNames() const;

  std::filesystem::path m_folder, m_staging;
  io::PathLock m_lock;     ///< on `m_staging`
  bool m_created = false;  ///< the folder itself
};

}  // namespace polemcl::apps
