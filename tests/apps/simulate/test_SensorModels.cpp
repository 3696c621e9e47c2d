#include <polemcl/core/common/Types.h>
#include "batch/BatchApp.h"
#include "core/sensor/SensorModel.h"
#include "eval/EvalApp.h"
#include "extract/ExtractApp.h"
#include "import/ImportApp.h"
#include "localize/LocalizeApp.h"
#include "map/MapApp.h"
#include "simulate/SimulateApp.h"
#include "support/TempFolder.h"

namespace polemcl::test_sensor_models {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

struct Sensor {
  std::string name, keys;  ///< keys of `[sensor]`
};

const std::string tableKeys =
    "model = table\ncolumns = 1200\nelevations_deg = 16 12 9 7 5 3.5 2 1 0 -1 -2 -3 -4.5 -6\n";

/// Each preset as it is, and each way to list beams.
std::vector<Sensor> sensors() {
  std::vector<Sensor> all;
  for (const std::string& name : SensorModel::modelNames())
    if (name != "table" && name != "uniform") all.push_back({name, "model = " + name + "\n"});
  all.push_back({"table", tableKeys});
  all.push_back({"table_of_two_blocks",
                 tableKeys + "lower_elevations_deg = -8 -10 -12 -15\napex_m = 0.2 0.12\n"});
  all.push_back({"table_upside_down", tableKeys + "upside_down = true\n"});
  all.push_back({"uniform",
                 "model = uniform\ncolumns = 1200\nrings = 24\nfov_up_deg = 15\n"
                 "fov_down_deg = -12\n"});
  return all;
}

/// A short simulated street, seen by one LiDAR, through every program that reads `--config`.
class SensorModels : public testing::TestWithParam<Sensor> {
 protected:
  SensorModels() {
    writeText(folder / "s.ini",
              "[sensor]\n" + GetParam().keys +
                  "height_m = 1.7\n[map]\nmin_count = 1\nevery_scan = false\nmin_share = 0\n"
                  "[likelihood]\nsigma_m = 0.15\nweighted = false\n[filter]\nparticles = "
                  "100\n[start]\nparticles = 100\nradius_m = 0.1\nheading_deg = 0.5\n"
                  "[simulation]\nspacing_m = 3\nscans = 8\n"
                  "[world]\nlength_m = 30\nlamp_spacing_m = 10\n");
  }
  std::string at(const std::string& name) const { return (folder / name).string(); }
  /// Runs a program that has to end well.
  void run(const char* what, int (*program)(int, const char* const*),
           std::vector<std::string> arguments, bool quiet = true) const {
    if (quiet) arguments.push_back("--quiet");
    const Outcome outcome = runProgram(program, arguments);
    EXPECT_EQ(outcome.code, 0) << what << ": " << outcome.err;
  }
  TempFolder folder;
};

std::string nameOf(const testing::TestParamInfo<Sensor>& info) {
  return info.param.name;
}

TEST_P(SensorModels, ServesEveryProgram) {
  const std::string c = at("s.ini"), scans = at("s.rawlog"), poles = at("p.rawlog"),
                    truth = at("s.tum"), map = at("m.polemap");
  run("pole-simulate", simulateMain, {"--config", c, "--output", at("s")});
  run("pole-import", importMain, {"folder", "--input", at("s"), "--output", scans});
  run("pole-extract", extractMain, {"--config", c, "--input", scans, "--output", poles});
  run("pole-map build", mapMain,
      {"build", "--config", c, "--input", scans, "--truth", truth, "--output", map});
  run("pole-map update", mapMain,
      {"update", "--config", c, "--map", map, "--input", poles, "--truth", truth, "--output",
       at("m2.polemap")});
  run("pole-map diff", mapMain, {"diff", "--config", c, map, at("m2.polemap")});
  run("pole-localize", localizeMain,
      {"--config", c, "--input", scans, "--map", map, "--truth", truth, "--output", at("out")});
  run("pole-eval rotation", evalMain,
      {"rotation", "--config", c, "--input", scans, "--every", "9"});
  run("pole-eval global", evalMain,
      {"global", "--config", c, "--map", map, "--input", poles, "--truth", truth, "--trials", "1",
       "--metres", "10"});
  run("pole-eval faults", evalMain,
      {"faults", "--config", c, "--map", map, "--input", poles, "--truth", truth, "--trials", "1",
       "--fault", "none"});
}

TEST_P(SensorModels, ServesABatch) {
  writeText(folder / "b.ini",
            "[batch]\nruns = 1\nsettings = one\n[sessions]\nnames = a b\nsource = simulated\ninput "
            "= s.ini\n"
            "[session b]\nset = world.day=1\n[setting one]\nconfig = s.ini\n"
            "sessions = b\n");
  BatchOptions options;
  options.batch = folder / "b.ini";
  options.output = folder / "batch";
  options.quiet = true;
  EXPECT_NO_THROW(doBatch(options));
}

INSTANTIATE_TEST_SUITE_P(All, SensorModels, testing::ValuesIn(sensors()), nameOf);

// Another table is another LiDAR, though both are called "table".
TEST(SensorModelsOfDetections, AModelServesTheBeamsItWasFittedFor) {
  const TempFolder folder;
  const auto at = [&](const std::string& name) { return (folder / name).string(); };
  std::string model = readText(std::string(POLEMCL_SOURCE_DIR) + "/share/models/hdl32e.json");
  const std::string name = "\"hdl32e\"";
  ASSERT_NE(model.find(name), std::string::npos);
  model.replace(model.find(name), name.size(), "\"table of 4 beams from 12 to -8 deg\"");
  writeText(folder / "m.json", model);
  const auto simulate = [&](const std::string& elevations) {
    writeText(folder / "s.ini",
              "[sensor]\nmodel = table\ncolumns = 600\nheight_m = 1\n"
              "elevations_deg = " +
                  elevations + "\n[simulation]\nscans = 4\ndetections = " + at("m.json") +
                  "\n[world]\nlength_m = 40\n");
    return runProgram(simulateMain, {"--config", at("s.ini"), "--poles", at("p.rawlog")});
  };
  const Outcome same = succeeded(simulate("12 4 -2 -8"));
  expectFailure(simulate("12 4 -2 -9"),
                {"m.json", "table of 4 beams from 12 to -8 deg",
                 "table of 4 beams from 12 to -9 deg", "fit_detections.py"});
}

}  // namespace
}  // namespace polemcl::test_sensor_models
