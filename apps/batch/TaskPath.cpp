#include "batch/TaskPath.h"

#include <polemcl/core/common/Types.h>

namespace polemcl::apps {

const char* name(TaskKind kind) {
  switch (kind) {
    case TaskKind::poles:
      return "poles";
    case TaskKind::truth:
      return "truth";
    case TaskKind::map:
      return "map";
    case TaskKind::score:
      return "score";
    case TaskKind::run:
      break;
  }
  return "run";
}

TaskKind taskKind(const std::string& text) {
  for (const TaskKind kind :
       {TaskKind::poles, TaskKind::truth, TaskKind::map, TaskKind::score, TaskKind::run})
    if (text == name(kind)) return kind;
  throw Error("unknown kind of task '" + text + "'; allowed: poles, truth, map, score, run");
}

std::string TaskPath::id() const {
  std::string text = name(kind);
  for (const std::string& part : parts) text += '.' + part;
  return text;
}

}  // namespace polemcl::apps
