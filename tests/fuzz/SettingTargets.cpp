#include "batch/BatchPlan.h"
#include "batch/BatchSpec.h"
#include "cli/JsonFile.h"
#include "cli/Settings.h"
#include "config/Config.h"
#include "config/TimingComment.h"
#include "fuzz/Fuzz.h"
#include "import/DatasetImport.h"
#include "sim/detections/DetectionModel.h"

namespace polemcl::fuzz {
namespace {

void readSettings(std::string_view bytes) {
  static const Readers readers{
      [](auto rest) { apps::settingsFrom(ConfigFile::fromText(std::string(rest), "a.ini"), {}); },
      [](auto rest) { ConfigFile::read(fileOf("a.ini", rest).string()); },
      [](auto rest) { timingIn(std::string(rest), "a.rawlog"); },
      [](auto rest) { timingInFile(fileOf("a.ini", rest).string()); },
      [](auto rest) { apps::parseSensorPose(std::string(rest)); },
      [](auto rest) { apps::loadSettings("", {std::string(rest)}); }};
  readWithOne(readers, bytes);
}

std::vector<std::string> settingSeeds() {
  const std::string timing = "text\n[scan_timing]\nturn = clockwise\nturn_s = 0.1\nstamp = 0.5\n";
  const std::string ini =
      "// a comment\n@define R 0.5\n[sensor]\nmodel = hdl32e ; a name\nheight_m = 1.7\n"
      "[vehicle]\nlidars = front rear\n[sensor:rear]\nmodel = vlp16\n[start]\nx = ${R}\n";
  return {inputFor(0, ini),
          inputFor(0, made("hdl32e.ini")),
          inputFor(0, made("all.ini")),
          inputFor(1, ini),
          inputFor(2, timing),
          inputFor(3, timing.substr(5)),
          inputFor(4, "1 2 3 90 0 -1.5"),
          inputFor(5, "sensor.height_m=1.5")};
}

void readBatch(std::string_view bytes) {
  static const Readers readers{
      [](auto rest) { apps::readBatchSpec(fileOf("a.ini", rest), "/data"); },
      [](auto rest) { apps::readPlan(fileOf("plan.json", rest)); },
      [](auto rest) { apps::readJson(fileOf("a.json", rest)); },
      [](auto rest) { sim::readDetectionModel(fileOf("model.json", rest)); }};
  readWithOne(readers, bytes);
}

std::vector<std::string> batchSeeds() {
  return {
      inputFor(0, made("kitti.ini")), inputFor(0, made("year.ini")),
      inputFor(1, R"({"format":"polemcl batch plan 2","name":"b","build":"x","files":{"a.ini":"0"},
"tasks":[{"id":"poles.a","kind":"poles","needs":[],"commands":[["pole-import","kitti"]],
"outputs":["poles.rawlog"],"key":"k"}],"cells":[{"setting":"s","session":"a","map":"","own_map":"",
"score":"","runs":[],"seeds":[1]}]})"),
      inputFor(2, R"({"a":[1,-2.5e3,null,true,"\u00e4"],"b":{}})"),
      inputFor(3, made("hdl32e.json"))};
}

}  // namespace

std::vector<Target> settingTargets() {
  return {{"settings", readSettings, settingSeeds}, {"batch", readBatch, batchSeeds}};
}

}  // namespace polemcl::fuzz
