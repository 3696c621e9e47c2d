#include <algorithm>
#include <cctype>

#include <polemcl/core/common/Types.h>
#include "batch/BatchPlan.h"
#include "cli/JsonFile.h"
#include "io/file/ParsedJson.h"

namespace polemcl::apps {
namespace {

constexpr const char* kFormat = "polemcl batch plan 2";
constexpr const char* kKindNames[] = {"poles", "truth", "map", "score", "run"};  // by TaskKind
/// What tasks may run: a plan that somebody else wrote must not do anything else.
constexpr const char* kPrograms[] = {"copy",     "pole-import",   "pole-simulate", "pole-extract",
                                     "pole-map", "pole-localize", "pole-eval",     "pole-labels"};
constexpr const char* kOutputs[] = {"--output", "--poles", "--json"};
constexpr const char* kOptions[] = {"--calib",          "--config",     "--date",    "--estimate",
                                    "--every",          "--input",      "--map",     "--offset",
                                    "--odometry-noise", "--one-to-one", "--poses",   "--poses-of",
                                    "--quiet",          "--radius",     "--runs",    "--seed",
                                    "--sensor-pose",    "--set",        "--threads", "--truth"};

template <std::size_t n>
bool isOneOf(const char* const (&names)[n], const std::string& name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

/// A negative number is no option.
bool isNumber(const std::string& text) {
  return text.size() > 1 && (std::isdigit(static_cast<unsigned char>(text[1])) || text[1] == '.');
}

Json toJson(const BatchTask& task) {
  return {{"id", task.id},           {"kind", name(task.kind)},
          {"needs", task.needs},     {"commands", task.commands},
          {"outputs", task.outputs}, {"key", task.key}};
}

Json toJson(const Experiment& experiment) {
  return {{"setting", experiment.configuration},
          {"session", experiment.session},
          {"map", experiment.map},
          {"own_map", experiment.ownMap},
          {"score", experiment.score},
          {"runs", experiment.runs},
          {"seeds", experiment.seeds}};
}

/// Ids name folders, which are removed. \see TaskPath::id()
void requireId(const std::string& id, TaskKind kind) {
  const std::string begin = std::string(name(kind)) + ".";
  if (id.size() <= begin.size() || id.compare(0, begin.size(), begin) != 0 ||
      id.find('/') != std::string::npos)
    throw Error("'" + id + "' is no id of a task; it begins with '" + begin + "' and has no '/'");
}

/// A file that a task keeps: in its own folder.
void requireInside(const std::string& file) {
  const std::filesystem::path path(file);
  if (file.empty() || path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
    throw Error("the output '" + file + "' lies outside the folder of its task");
}

/// Only what BatchPlan makes: programs of the project that write into the folder of their task.
void requireHarmless(const std::vector<std::string>& command) {
  if (command.empty()) throw Error("a command is empty");
  if (!isOneOf(kPrograms, command.front()))
    throw Error("'" + command.front() + "' is no program that a batch runs");
  if (command.front() == "copy") {
    if (command.size() != 3) throw Error("'copy' needs two files");
    return requireInside(command[2]);
  }
  bool writes = false;
  for (std::size_t i = 1; i < command.size(); ++i) {
    const std::string& option = command[i];
    if (option.empty() || option[0] != '-' || isNumber(option)) continue;
    if (isOneOf(kOutputs, option)) {
      requireInside(i + 1 < command.size() ? command[i + 1] : "");
      writes = true;
    } else if (!isOneOf(kOptions, option)) {
      throw Error("'" + option + "' is no option that a batch uses");
    }
  }
  if (!writes) throw Error("'" + command.front() + "' has no output");
}

BatchTask taskFrom(const Json& json) {
  BatchTask task;
  json.at("id").get_to(task.id);
  task.kind = taskKind(json.at("kind"));
  requireId(task.id, task.kind);
  json.at("needs").get_to(task.needs);
  json.at("commands").get_to(task.commands);
  for (const auto& command : task.commands) requireHarmless(command);
  json.at("outputs").get_to(task.outputs);
  for (const auto& output : task.outputs) requireInside(output);
  json.at("key").get_to(task.key);
  return task;
}

Experiment experimentFrom(const Json& json) {
  Experiment experiment;
  json.at("setting").get_to(experiment.configuration);
  json.at("session").get_to(experiment.session);
  json.at("map").get_to(experiment.map);
  json.at("own_map").get_to(experiment.ownMap);
  json.at("score").get_to(experiment.score);
  json.at("runs").get_to(experiment.runs);
  json.at("seeds").get_to(experiment.seeds);
  return experiment;
}

}  // namespace

const char* name(TaskKind kind) {
  return kKindNames[static_cast<int>(kind)];
}

TaskKind taskKind(const std::string& text) {
  for (std::size_t i = 0; i < std::size(kKindNames); ++i)
    if (text == kKindNames[i]) return static_cast<TaskKind>(i);
  throw Error("unknown kind of task '" + text + "'; allowed: poles, truth, map, score, run");
}

std::string TaskPath::id() const {
  std::string text = name(kind);
  for (const std::string& part : parts) text += '.' + part;
  return text;
}

void writePlan(const std::filesystem::path& file, const BatchPlan& plan) {
  Json json;
  json["format"] = kFormat;
  json["name"] = plan.name;
  json["build"] = plan.build;
  json["tasks"] = json["cells"] = Json::array();
  json["files"] = plan.sums;
  for (const auto& task : plan.tasks) json["tasks"].push_back(toJson(task));
  for (const auto& experiment : plan.experiments) json["cells"].push_back(toJson(experiment));
  writeJson(file, json);
}

BatchPlan readPlan(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw Error(file.string() + ": cannot be read; is this the folder of a batch?");
  try {
    const Json json = io::parsedJson<Json>(file);
    if (json.at("format") != kFormat)
      throw Error("format is " + json.at("format").dump() + ", this program reads \"" + kFormat +
                  "\"");
    BatchPlan plan;
    json.at("name").get_to(plan.name);
    json.at("build").get_to(plan.build);
    json.at("files").get_to(plan.sums);
    for (const auto& task : json.at("tasks")) plan.tasks.push_back(taskFrom(task));
    for (const auto& experiment : json.at("cells"))
      plan.experiments.push_back(experimentFrom(experiment));
    return plan;
  } catch (const std::exception& error) {
    throw Error(file.string() + ": is no plan of a batch: " + error.what() +
                "; start the batch again with --resume");
  }
}

}  // namespace polemcl::apps
