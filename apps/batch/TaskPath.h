#pragma once
/// \file TaskPath.h
/// \brief Where the work of a task lies: its kind and what it is for.

#include <string>
#include <vector>

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

}  // namespace polemcl::apps
