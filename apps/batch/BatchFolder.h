#pragma once
/// \file BatchFolder.h
/// \brief What a batch has on disk: tasks done and failed, and a lock against a second pole-batch.
///
/// - `plan.json`, `batch.ini`, `settings/`, `files/`: what is done, frozen when it was begun;
/// - `tasks/TASK/`: the outputs of a task that is done, with `done.json`: its key, size and CRC-32
///   of each output, the build that did it. It appears in one piece. `tasks/TASK.…part` is one
///   under way, or left behind;
/// - `failed/TASK.json`: why the last attempt failed; `logs/TASK.log`: commands and what they said;
/// - `times/TASK`: seconds that it took: all else is the same whenever the batch is done;
/// - `timings.json`, and what writeBatchFiles() writes.

#include <filesystem>
#include <string>

#include "batch/BatchPlan.h"
#include "io/file/Leftovers.h"

namespace polemcl::apps {

class BatchFolder {
 public:
  /// \throws Error when a batch is there, and links, which would lead to files of others.
  explicit BatchFolder(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return m_path; }
  std::filesystem::path work(const std::string& task) const { return m_path / "tasks" / task; }
  std::filesystem::path log(const std::string& task) const {
    return m_path / "logs" / (task + ".log");
  }

  /// \brief Takes the folder for a batch of that name until the process ends.
  /// \param resume Goes on with the batch that is there; otherwise the folder must be empty.
  /// \throws Error: another batch is there or under way, something else is there, not writable.
  void take(const std::string& name, bool resume);
  /// \brief Writes the plan and the files it has frozen. Remains of tasks that were cut short go.
  void store(const BatchPlan& plan, const std::filesystem::path& batchFile);
  /// \brief Removes what tasks left that were cut short. Nothing must be under way.
  void sweep() const;

  /// \brief State of a task on disk.
  enum class State {
    open,    ///< not done, or done with other settings, inputs or versions
    done,    ///< done, its outputs are what they were
    damaged  ///< done, but an output is missing or has changed since
  };
  /// \param why For damaged ones: the file and what is wrong with it.
  State state(const BatchTask& task, std::string* why = nullptr) const;
  /// \brief The build that did what is there of a task; "" when nothing is there.
  std::string buildOf(const BatchTask& task) const;
  /// \brief Done with these settings; its outputs are not looked at.
  bool isDone(const BatchTask& task) const;

  /// \brief A folder to do a task in. \throws Error when it cannot be made.
  std::filesystem::path stage(const BatchTask& task) const;
  /// \brief Makes a staged task a done one: keeps its outputs alone, notes their checksums, gives
  /// the folder its name. Nothing happens if another process has done the same task meanwhile.
  /// \throws Error naming an output that is missing.
  void commit(const BatchTask& task, const std::filesystem::path& staged) const;
  /// \brief Removes what a task left, done or not.
  void remove(const BatchTask& task) const;
  void noteFailure(const BatchTask& task, const std::string& reason) const;
  /// \brief Notes how long a task took, s. \see seconds()
  void noteTime(const std::string& task, double seconds) const;
  /// \brief How long it took the last time; NaN when that is not known.
  double seconds(const std::string& task) const;
  /// \brief Reason of the last attempt's failure; empty when no failure is noted.
  std::string failure(const std::string& task) const;

 private:
  /// What a task of this process is called while it is not whole.
  std::filesystem::path part(const BatchTask& task) const;

  std::filesystem::path m_path;
  io::PathLock m_lock;
};

}  // namespace polemcl::apps
