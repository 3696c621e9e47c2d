#include <fstream>

#include "batch/BatchPlan.h"
#include "cli/JsonFile.h"
#include "core/common/Types.h"

namespace polemcl::apps {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* s_format = "polemcl batch plan 2";

Json toJson(const BatchTask& task) {
  return {{"id", task.id},           {"kind", task.kind},
          {"needs", task.needs},     {"commands", task.commands},
          {"outputs", task.outputs}, {"key", task.key}};
}

Json toJson(const Experiment& cell) {
  return {{"setting", cell.setting}, {"session", cell.session}, {"poles", cell.poles},
          {"map", cell.map},         {"own_map", cell.ownMap},  {"score", cell.score},
          {"runs", cell.runs},       {"seeds", cell.seeds}};
}

BatchTask taskFrom(const Json& json) {
  BatchTask task;
  json.at("id").get_to(task.id);
  json.at("kind").get_to(task.kind);
  json.at("needs").get_to(task.needs);
  json.at("commands").get_to(task.commands);
  json.at("outputs").get_to(task.outputs);
  json.at("key").get_to(task.key);
  return task;
}

Experiment cellFrom(const Json& json) {
  Experiment cell;
  json.at("setting").get_to(cell.setting);
  json.at("session").get_to(cell.session);
  json.at("poles").get_to(cell.poles);
  json.at("map").get_to(cell.map);
  json.at("own_map").get_to(cell.ownMap);
  json.at("score").get_to(cell.score);
  json.at("runs").get_to(cell.runs);
  json.at("seeds").get_to(cell.seeds);
  return cell;
}

}  // namespace

void writePlan(const std::filesystem::path& file, const BatchPlan& plan) {
  Json json;
  json["format"] = s_format;
  json["name"] = plan.name;
  json["build"] = plan.build;
  json["tasks"] = json["cells"] = Json::array();
  json["files"] = plan.sums;
  for (const auto& task : plan.tasks) json["tasks"].push_back(toJson(task));
  for (const auto& cell : plan.cells) json["cells"].push_back(toJson(cell));
  writeJson(file, json);
}

BatchPlan readPlan(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw Error(file.string() + ": cannot be read; is this the folder of a batch?");
  try {
    const Json json = Json::parse(stream);
    if (json.at("format") != s_format)
      throw Error("format is " + json.at("format").dump() + ", this program reads \"" + s_format +
                  "\"");
    BatchPlan plan;
    json.at("name").get_to(plan.name);
    json.at("build").get_to(plan.build);
    json.at("files").get_to(plan.sums);
    for (const auto& task : json.at("tasks")) plan.tasks.push_back(taskFrom(task));
    for (const auto& cell : json.at("cells")) plan.cells.push_back(cellFrom(cell));
    return plan;
  } catch (const std::exception& error) {
    throw Error(file.string() + ": is no plan of a batch: " + error.what() +
                "; start the batch again with --resume");
  }
}

}  // namespace polemcl::apps
