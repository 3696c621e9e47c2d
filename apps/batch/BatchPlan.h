#pragma once
/// \file BatchPlan.h
/// \brief What has to be done for a batch: tasks, each a few commands, and what they need.
///
/// A plan is plain data and can be stored, so that another process can do a task, on another
/// machine. Commands name files relative to the folder they run in, see TaskPath.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "batch/BatchSpec.h"
#include "cli/Version.h"

namespace polemcl::apps {

enum class TaskKind {
  poles,  ///< import or simulate a session, extract its poles
  truth,  ///< true poles from the labels of a session
  map,    ///< the map after a session
  score,  ///< scores of that map
  run     ///< localization of a session, once
};
const char* name(TaskKind kind);
/// \throws Error naming the text and what is allowed.
TaskKind taskKind(const std::string& name);

/// \brief Where the work of a task lies: its kind and what it is for.
struct TaskPath {
  TaskKind kind = TaskKind::poles;
  /// SESSION for poles and truth; CONFIGURATION, SESSION for map and score; run adds its number.
  /// Names hold no dots.
  std::vector<std::string> parts;

  /// \brief Name of the task and of its folder: `KIND.PART.PART`.
  std::string id() const;
  /// \brief A file that the task leaves, as commands of another task name it: tasks run in folders
  /// that lie beside each other.
  std::string file(const std::string& name) const { return "../" + id() + "/" + name; }
};

/// \brief A piece of work that is done, or not: never half.
struct BatchTask {
  BatchTask() = default;
  explicit BatchTask(const TaskPath& path) : id(path.id()), kind(path.kind) {}

  std::string id;  ///< see TaskPath::id()
  TaskKind kind = TaskKind::poles;
  std::vector<std::string> needs;  ///< ids of tasks that must be done before
  /// One after the other: program and arguments. The program `copy` takes files here (FROM TO …).
  std::vector<std::vector<std::string>> commands;
  std::vector<std::string> outputs;  ///< files kept, relative to the task's folder; others go
  std::vector<std::string> frozen;   ///< names in BatchPlan::files that its outputs depend on
  /// Stands for all that its outputs depend on: commands, settings, the build of the programs, the
  /// keys of its needs.
  std::string key;
};

/// \brief Where the results of one session under one configuration come from.
struct Experiment {
  std::string configuration, session;
  std::string map;                ///< id of the map it is localized in; empty: not localized
  std::string ownMap;             ///< id of the map that it went into; empty: none
  std::string score;              ///< id of the score of the map it completes; empty: none
  std::vector<std::string> runs;  ///< ids, by index
  std::vector<std::uint32_t> seeds;
};

struct BatchPlan {
  std::string name;
  std::string build;             ///< of the programs that planned it, see buildIdentity()
  std::vector<BatchTask> tasks;  ///< none needs a later one
  std::vector<Experiment> experiments;
  /// Frozen copies of what INI files say, relative to the batch's folder: settings, models.
  std::map<std::string, std::string> files;
  /// MD5 of each of them: what a stored plan has instead of their content.
  std::map<std::string, std::string> sums;

  const BatchTask& task(const std::string& id) const;  ///< \throws Error
};

/// \brief Plans a batch. Sessions are imported once and extracted once for all configurations that
/// use them and have the same `[sensor] [extraction] [range_image] [scan_line] [vehicle] [motion]`;
/// maps are built once for all sessions and runs. Maps that a configuration's last map session
/// completes (with `maps = each`: all) are scored where that session has a truthMap.
/// \param build Build of the programs that do the tasks. Tasks done by another build are open.
/// \throws Error as settingsFor() and requirePublished(), and when the input or the true poles of a
///         session are not there (their number and the first three are named).
BatchPlan planBatch(const BatchSpec& spec, const std::string& build = buildIdentity());

/// \brief Tasks that can be done at the same time, the first need nothing: ids by level.
std::vector<std::vector<std::string>> levels(const BatchPlan& plan);

void writePlan(const std::filesystem::path& file, const BatchPlan& plan);
/// \throws Error when it cannot be read or is no plan of this version; when a task would run what
/// is no program of a batch, or has an id or an output that leads out of its folder.
BatchPlan readPlan(const std::filesystem::path& file);

}  // namespace polemcl::apps
