#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <polemcl/core/common/Types.h>
#include "extract/ExtractApp.h"
#include "extract/InspectApp.h"
#include "import/ImportApp.h"
#include "io/data/Trajectory.h"
#include "localize/LocalizeApp.h"
#include "map/MapApp.h"
#include "sim/drive/Drive.h"
#include "sim/lidar/Scanner.h"
#include "simulate/SimulateApp.h"
#include "support/StreetTest.h"

namespace polemcl::test_inspect_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// A few scans of a simulated street as `folder/in`; `flipped`: in axes turned by 180° about x.
void writeSimulated(const fs::path& folder, const std::string& lidar, double height,
                    bool flipped = false) {
  sim::SimulationOptions options;
  options.world.length = 100;
  options.sensor = lidar;
  options.height = height;
  options.spacing = 30;
  const sim::World street = sim::makeWorld(options.world);
  const sim::Drive drive = sim::makeDrive(street, options);
  const sim::Scanner scanner(street, sim::makeLidar(lidar));
  std::string times, poses;
  for (std::size_t i = 0; i < drive.T_map_sensor.size(); ++i) {
    const auto scan = scanner.scan(drive.T_map_sensor[i], i);
    const float side = flipped ? -1.f : 1.f;
    Points points;
    for (std::size_t k = 0; k < scan.size(); ++k)
      points.push_back({scan.x[k], side * scan.y[k], side * scan.z[k], 0.5f});
    writeBin(folder / "velodyne" / scanName(i), points);
    times += std::to_string(i) + '\n';
    poses += poseRow(30.0 * static_cast<double>(i), 0, 0);
  }
  writeText(folder / "times.txt", times);
  writeText(folder / "poses.txt", poses);
}

Points pointsOf(const fs::path& scan) {
  const std::string bytes = readText(scan);
  Points points(bytes.size() / sizeof points[0]);
  std::memcpy(points.data(), bytes.data(), bytes.size());
  return points;
}

/// The turns of a simulated VLP-16 in `folder/sim`, 8 m/s, clockwise, cut anew every `span` s,
/// which is more than one: `folder/in`, with its points in the order of measuring.
void cutAnew(const fs::path& folder, std::size_t turns, double span) {
  struct Measured {
    double time;
    std::array<float, 4> point;
  };
  std::vector<Measured> all;
  for (std::size_t i = 0; i < turns; ++i) {
    for (const auto& point : pointsOf(folder / "sim" / "velodyne" / scanName(i))) {
      const double turned = (M_PI - std::atan2(point[1], point[0])) / (2 * M_PI);
      all.push_back({0.1 * (static_cast<double>(i) + turned - 0.5), point});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Measured& a, const Measured& b) { return a.time < b.time; });
  std::string stamps;
  std::size_t at = 0, number = 0;
  for (double begin = all.front().time; begin + span < all.back().time; begin += span) {
    Points points;
    for (; all[at].time < begin + span; ++at) points.push_back(all[at].point);
    writeBin(folder / "in" / "velodyne" / scanName(number++), points);
    stamps += std::to_string(begin + span / 2) + '\n';
  }
  writeText(folder / "in" / "times.txt", stamps);
}

class InspectApp : public StreetTest {
 protected:
  Outcome run(const std::vector<std::string>& arguments) {
    return runProgram(extractMain, arguments);
  }
  Outcome inspectInput(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"--inspect", at("in.rawlog")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Raw scans of a street of this length, m, as cutAnew() makes them, without odometry:
  /// `in.rawlog`, with their motion in `sim.tum`.
  void importCutAnew(const std::string& length, double span = 0.103) {
    const Outcome simulated = succeeded(runProgram(
        simulateMain,
        {"--quiet", "--config", "vlp16.ini", "--length", length, "--output", at("sim"), "--set",
         "simulation.motion_distortion=true", "--set", "simulation.spacing_m=0.8", "--set",
         "simulation.speed_m_s=8", "--set", "sensor.turn=clockwise", "--set",
         "sensor.range_offset_m=0.1", "--set", "sensor.range_scale=0.995"}));
    import("sim", false);  // for its true poses
    cutAnew(folder.path(), io::readTum(folder / "sim.tum").size(), span);
    import("in", false);
  }
};

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

std::string printed(const Inspection& inspection) {
  std::ostringstream text;
  printInspection(text, inspection);
  return text.str();
}

TEST_F(InspectApp, WritesAConfigurationThatExtracts) {
  writeSimulated(folder / "in", "hdl32e", 1.0);
  import("in");
  const Outcome outcome = succeeded(inspectInput({"--write-config", at("found.ini")}));
  EXPECT_HAS(outcome.out, "beams             32");
  EXPECT_HAS(outcome.out, "fits              model = hdl32e");
  EXPECT_HAS(outcome.out, "tilt");
  EXPECT_HAS(outcome.out, "config/hdl32e.ini has settings chosen");
  EXPECT_HAS(outcome.out, "no odometry between all scans; --truth S.tum");
  EXPECT_HAS(outcome.out, "`pole-map build --trajectory`, which cannot show");
  EXPECT_HAS(outcome.out, "set turn = clockwise, cut_deg = -180");
  const AllSettings settings = loadSettings(at("found.ini"));
  EXPECT_EQ(settings.sensor.model, "hdl32e");
  EXPECT_NEAR(settings.sensor.height, 1.0, 0.1);
  const std::string text = readText(folder / "found.ini");
  EXPECT_TRUE(has(text, "[sensor]") && has(text, "clock_offset_s")) << text;
  EXPECT_TRUE(has(text, "# As config/hdl32e.ini\n[likelihood]")) << text;
  EXPECT_EQ(settings.likelihood.sigma, loadSettings("hdl32e.ini").likelihood.sigma);
  EXPECT_FALSE(has(text, "[scan_line]")) << "only what was looked for or chosen";
  const Outcome extracted = succeeded(run(
      {"--config", at("found.ini"), "--input", at("in.rawlog"), "--output", at("poles.rawlog")}));
}

TEST_F(InspectApp, WritesATableOfTwoBlocks) {
  writeSimulated(folder / "in", "hdl64e", 1.73);
  import("in");
  const Outcome outcome = succeeded(inspectInput({"--write-config", at("found.ini")}));
  EXPECT_HAS(outcome.out, "block of 32 starting");
  EXPECT_HAS(outcome.out, "no preset");
  const AllSettings settings = loadSettings(at("found.ini"));
  EXPECT_EQ(settings.sensor.elevations.size(), 32u);
  EXPECT_EQ(settings.sensor.lowerElevations.size(), 32u);
  EXPECT_NEAR(settings.sensor.upperApex, 0.2, 0.01);
}

// NCLT's way: z points down in the clouds, the sensor pose says so, and the optical centre is a
// metre over their origin.
TEST_F(InspectApp, UnderstandsASensorPoseThatTurnsCloudsOver) {
  writeSimulated(folder / "in", "hdl32e", 1.0, true);
  import("in", true, "0 0 0 0 0 180");
  const Outcome outcome = succeeded(inspectInput({"--write-config", at("found.ini")}));
  EXPECT_FALSE(has(outcome.out, "upside down       ")) << outcome.out;
  const AllSettings settings = loadSettings(at("found.ini"));
  EXPECT_EQ(settings.sensor.model, "hdl32e");
  EXPECT_NEAR(settings.sensor.height, 1.0, 0.1);
}

TEST_F(InspectApp, SaysWhenCloudsStandOnTheirHead) {
  writeSimulated(folder / "in", "hdl32e", 1.0, true);
  import("in");
  const Outcome outcome = succeeded(inspectInput());
  EXPECT_HAS(outcome.out, "--sensor-pose whose roll is 180 deg");
  EXPECT_HAS(outcome.out, "not looked for in clouds that are upside down");
}

TEST_F(InspectApp, RefusesPolesAndEmptyRawlogs) {
  importStreet("in", 2);
  ASSERT_EQ(
      run({"--config", config(), "--input", at("in.rawlog"), "--output", at("poles.rawlog")}).code,
      0);
  const auto poles = run({"--inspect", at("poles.rawlog"), "--write-config", at("none.ini")});
  EXPECT_EQ(poles.code, 1);
  EXPECT_HAS(poles.err, "holds poles");
  EXPECT_FALSE(fs::exists(folder / "none.ini"));
  EXPECT_EQ(run({"--inspect", at("missing.rawlog")}).code, 1);
}

TEST_F(InspectApp, UsageNamesWhatIsMissing) {
  EXPECT_EQ(run({}).code, 2);
  EXPECT_HAS(run({"--config", "a", "--input", "b"}).err, "--output");
  EXPECT_EQ(run({"--write-config", "a.ini"}).code, 2);
  EXPECT_EQ(run({"--inspect", "a", "--input", "b"}).code, 2);
}

// All three programs that extract say it, whatever the threads do, and nothing is written.
TEST_F(InspectApp, AWrongModelIsRefused) {
  writeSimulated(folder / "in", "vlp16", 1.0);
  import("in");
  const auto outcome =
      run({"--config", config(), "--input", at("in.rawlog"), "--output", at("poles.rawlog")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_HAS(outcome.err, "scan 0: the cloud contradicts [sensor] model = hdl32e");
  EXPECT_HAS(outcome.err, "as model = vlp16 has");
  EXPECT_FALSE(fs::exists(folder / "poles.rawlog"));
  writeText(folder / "forced.ini", "[sensor]\nmodel = hdl32e\ncheck_beams = false\n");
  EXPECT_EQ(run({"--config", at("forced.ini"), "--input", at("in.rawlog"), "--output",
                 at("poles.rawlog")})
                .code,
            0);
}

TEST_F(InspectApp, KnowsTheLidarOfKitti) {
  POLEMCL_NEEDS_DATA();
  ImportOptions options;
  options.input = dataFolder() / "kitti_raw_0005";
  options.output = folder / "in.rawlog";
  options.every = 20;
  importDataset(options);
  InspectOptions files;
  files.input = folder / "in.rawlog";
  const RawlogInspection inspection = inspect(files).sensor;
  EXPECT_EQ(inspection.sensor.beams.beams(), 64);
  EXPECT_EQ(inspection.options.model, "hdl64e");
  EXPECT_NEAR(inspection.options.height, 1.73, 0.1);
  EXPECT_EQ(inspection.options.originZ, 0);
}

TEST_F(InspectApp, FindsACutThatMovesAndRangesThatAreOff) {
  importCutAnew("100");
  InspectOptions files;
  files.input = folder / "in.rawlog";
  files.writeConfig = folder / "found.ini";
  files.truth = folder / "sim.tum";
  files.turnSeconds = 0.103;
  const Inspection found = inspect(files);
  ASSERT_TRUE(found.timing);
  EXPECT_EQ(found.timing->timing.turn, Turn::clockwise);
  EXPECT_TRUE(found.timing->timing.movingCut);
  EXPECT_LT(found.timing->after, 0.5 * found.timing->before);
  EXPECT_HAS(readText(folder / "found.ini"), "moving_cut = true");
  EXPECT_HAS(printed(found), "each scan cut at its first point (these lie ");
  ASSERT_TRUE(found.ranges);
  EXPECT_NEAR(found.ranges->offset, 0.1, 0.02);
  EXPECT_NEAR(found.ranges->scale, 0.995, 0.0015);
  EXPECT_GT(found.ranges->significance, 4);
  EXPECT_HAS(printed(found), "\nranges of poles   range_offset_m = 0.");
  const SensorOptions written = loadSettings((folder / "found.ini").string()).sensor;
  EXPECT_NEAR(written.rangeOffset, found.ranges->offset, 0.0005);
  EXPECT_NEAR(written.rangeScale, found.ranges->scale, 0.00005);
}

TEST_F(InspectApp, ALidarOnItsHeadTurnsTheOtherWayInItsOwnFrame) {
  importCutAnew("60");
  for (const auto& scan : fs::directory_iterator(folder / "in" / "velodyne")) {
    Points points = pointsOf(scan.path());
    for (auto& point : points) {
      point[1] = -point[1];
      point[2] = -point[2];
    }
    writeBin(scan.path(), points);
  }
  import("in", false, "0 0 0 0 0 180");
  succeeded(inspectInput(
      {"--truth", at("sim.tum"), "--turn-s", "0.1", "--write-config", at("found.ini")}));
  const ScanTiming found = loadSettings(at("found.ini")).sensor.timing;
  EXPECT_TRUE(found.movingCut && found.turn == Turn::counterclockwise);
}

TEST_F(InspectApp, AScanWhosePointsAreMixedIsLeftOut) {
  importCutAnew("40");
  const auto mix = [&](std::size_t number) {
    const fs::path scan = folder / "in" / "velodyne" / scanName(number);
    Points points = pointsOf(scan);
    std::sort(points.begin(), points.end());
    writeBin(scan, points);
  };
  const auto extract = [&] {
    return run({"--quiet", "--config", "vlp16.ini", "--input", at("in.rawlog"), "--output",
                at("p.rawlog"), "--set", "sensor.turn=clockwise", "--set",
                "sensor.moving_cut=true"});
  };
  mix(7);
  EXPECT_HAS(succeeded(extract()).err, "scans are not used: their points are not in the order");
  mix(1);
  expectFailure(extract(), {"scan 1: ", "not in the order of measuring"});
}

// A warning of each program that takes poles from scans, with --quiet too.
TEST_F(InspectApp, RawScansAreToldByMapsAndPosesToo) {
  importCutAnew("40");
  succeeded(runProgram(importMain, {"folder", "--quiet", "--input", at("in"), "--output",
                                    at("drive.rawlog"), "--odometry", at("sim.tum")}));
  const std::vector<std::string> drive{"--quiet",          "--config", "vlp16.ini",  "--input",
                                       at("drive.rawlog"), "--truth",  at("sim.tum")};
  const std::string told = "drive.rawlog: scans of lidar look raw";
  const Outcome built = runProgram(mapMain, {"build", "--output", at("street.polemap")}, drive);
  EXPECT_HAS(built.err, told);
  const Outcome updated = runProgram(
      mapMain, {"update", "--map", at("street.polemap"), "--output", at("new.polemap")}, drive);
  EXPECT_HAS(updated.err, told);
  const Outcome localized =
      runProgram(localizeMain, {"--map", at("street.polemap"), "--output", at("poses")}, drive);
  EXPECT_HAS(localized.err, told);
  const Outcome mapped = runProgram(mapMain, {"build", "--config", "vlp16.ini", "--input",
                                              at("drive.rawlog"), "--output", at("found.polemap")});
  EXPECT_HAS(mapped.out, " against the first, apart from what the warnings tell\n");
}

TEST_F(InspectApp, ACutThatDoesNotFitIsTold) {
  importCutAnew("40");
  const auto told = [&](const std::string& movingCut) {
    return succeeded(run({"--quiet", "--config", "vlp16.ini", "--input", at("in.rawlog"),
                          "--output", at("poles.rawlog"), "--set", "sensor.turn=clockwise", "--set",
                          "sensor.moving_cut=" + movingCut}))
        .err;
  };
  EXPECT_HAS(told("false"), "in.rawlog: scans of lidar are not cut at one azimuth: ");
  EXPECT_EQ(told("true"), "");
}

TEST_F(InspectApp, PolesOfAnotherTurnAreTold) {
  importCutAnew("40");
  const auto told = [&](const std::vector<std::string>& extracted, const std::string& turn) {
    succeeded(runProgram(extractMain,
                         {"--quiet", "--config", "vlp16.ini", "--input", at("in.rawlog"),
                          "--output", at("poles.rawlog")},
                         extracted));
    return runProgram(mapMain, {"build", "--quiet", "--config", "vlp16.ini", "--input",
                                at("poles.rawlog"), "--truth", at("sim.tum"), "--set",
                                "sensor.turn=" + turn, "--output", at("street.polemap")})
        .err;
  };
  const std::vector<std::string> plain{"--set", "sensor.turn=compensated"},
      turned{"--set", "sensor.turn=clockwise", "--set", "sensor.moving_cut=true"};
  EXPECT_HAS(
      told(plain, "clockwise"),
      "poles.rawlog: its poles were extracted without a turn of the LiDAR, so [sensor] turn = "
      "clockwise does nothing here: extract them from the scans again");
  EXPECT_HAS(told(turned, "compensated"), "extracted with a turn of the LiDAR, so");
  EXPECT_EQ(told(plain, "compensated").find("extracted"), std::string::npos);
  EXPECT_EQ(told(turned, "clockwise").find("extracted"), std::string::npos);
  EXPECT_EQ(told(turned, "auto").find("extracted"), std::string::npos);
}

TEST_F(InspectApp, ScansOfMoreThanATurnAreTold) {
  importCutAnew("30", 0.112);
  InspectOptions files;
  files.input = folder / "in.rawlog";
  const Inspection found = inspect(files);
  const std::string text = printed(found);
  const auto number = [&](const std::string& word) {
    const std::size_t at = text.find(word);
    return at == std::string::npos ? 0 : std::stod(text.substr(at + word.size()));
  };
  EXPECT_NEAR(number("sweep"), 360 * 1.12, 2);
  EXPECT_NEAR(number("A turn takes"), 1 / 1.12, 0.005);
  double measured = 0;  // points
  for (const std::size_t scan : found.sensor.used)
    measured += static_cast<double>(readText(folder / "in" / "velodyne" / scanName(scan)).size()) /
                sizeof(std::array<float, 4>);
  // A scan has 1.12 turns, of which one is used. Its points are not spread evenly.
  EXPECT_NEAR(static_cast<double>(found.sensor.sensor.points) / measured, 1 / 1.12, 0.05);
}

// Also where nobody knows the motion, or where the poses were found from the same scans.
TEST_F(InspectApp, TheOrderOfThePointsTellsRawScans) {
  const std::string advice = "set turn = clockwise, moving_cut = true";
  importCutAnew("40");
  InspectOptions files;
  files.input = folder / "in.rawlog";
  files.writeConfig = folder / "found.ini";
  Inspection found = inspect(files);
  EXPECT_TRUE(
      has(readText(folder / "found.ini"),
          "# Unless the scans were corrected for motion: turn = clockwise, moving_cut = true"));
  EXPECT_FALSE(loadSettings(at("found.ini")).sensor.timing.known());
  const Outcome extracted = run({"--quiet", "--config", at("found.ini"), "--input", at("in.rawlog"),
                                 "--output", at("poles.rawlog")});
  EXPECT_HAS(extracted.err, "in.rawlog: scans of ");
  EXPECT_HAS(extracted.err, " look raw");
  files.writeConfig.reset();
  EXPECT_FALSE(found.timing);
  EXPECT_HAS(printed(found), "in the order of measuring, clockwise");
  EXPECT_HAS(printed(found), advice);
  found.timing.emplace();
  EXPECT_TRUE(has(printed(found), advice)) << "no pole was seen twice";
  found.timing->timing.turn = Turn::compensated;
  found.timing->pairs = 100;
  EXPECT_HAS(printed(found), "poses found from raw scans hide it");
  EXPECT_HAS(printed(found), advice);
  Inspection slid = found;
  slid.sensor.sensor.beams.origin.slide = 1;
  EXPECT_FALSE(has(printed(slid), advice)) << "corrected for motion";
  Inspection onItsHead = found;
  onItsHead.sensor.sensor.onItsHead = true;
  EXPECT_FALSE(has(printed(onItsHead), "in the order of measuring"));
  Inspection mixed = found;
  mixed.sensor.orders.back().turn = Turn::counterclockwise;
  EXPECT_FALSE(has(printed(mixed), "in the order of measuring"));
  Inspection alike = found;
  for (PointOrder& order : alike.sensor.orders) order.begin = M_PI;
  EXPECT_FALSE(has(printed(alike), "in the order of measuring")) << "the poles do not show it";
  alike.timing.reset();
  EXPECT_TRUE(has(printed(alike), "180 deg.\n")) << printed(alike);
  EXPECT_TRUE(has(printed(alike), "set turn = clockwise, cut_deg = 180")) << printed(alike);
  found.timing->timing.turn = Turn::clockwise;
  EXPECT_FALSE(has(printed(found), advice)) << "the poles show it";

  ImportOptions options;
  options.input = folder / "in";
  options.output = folder / "stated.rawlog";
  options.timing = ScanTiming{Turn::clockwise, 0.103};
  options.timing->movingCut = true;
  importDataset(options);
  files.input = options.output;
  EXPECT_FALSE(has(printed(inspect(files)), advice)) << "the rawlog says so itself";
}

TEST_F(InspectApp, PrintsATurnThatIsNotSure) {
  writeSimulated(folder / "in", "vlp16", 1.0);
  import("in");
  InspectOptions files;
  files.input = folder / "in.rawlog";
  Inspection found = inspect(files);
  found.timing.emplace();
  found.timing->timing.turn = Turn::compensated;
  found.timing->pairs = 100;
  found.timing->turnSignificance = 2.4;
  EXPECT_FALSE(has(printed(found), "Not sure")) << printed(found);
  found.timing->candidate = {Turn::clockwise, 0.1, M_PI};
  found.timing->withCandidate = 0.0533;
  const std::string advice = "set turn = clockwise, cut_deg = 180\n";
  EXPECT_HAS(printed(found),
             "with turn = clockwise, cut_deg = 180, a pole moves by 0.0533 m,\n"
             "                  2.4 standard errors better");
  EXPECT_HAS(printed(found), advice);
  found.timing->turnSignificance = 1.9;
  EXPECT_HAS(printed(found), "1.9 standard errors better (");
  EXPECT_FALSE(has(printed(found), advice)) << printed(found);
  found.timing->turnSignificance = 3.9;
  found.timing->withCandidate = 0.12;  // poses or clock are off
  EXPECT_FALSE(has(printed(found), advice)) << printed(found);
}

// The settings add to the clock that the rawlog states.
TEST_F(InspectApp, OfAStatedTimingOnlyTheRestOfTheClockIsWritten) {
  Inspection found;
  found.sensor.stated = {Turn::clockwise, 0.1, M_PI, 1, 0.04};
  found.timing.emplace();
  found.timing->timing = found.sensor.stated;
  found.timing->timing.clock = 0.06;
  EXPECT_EQ(settingsFor(found).sensor.timing.clock, 0.06);
  EXPECT_EQ(settingsFor(found).sensor.timing.turn, Turn::clockwise);
  found.timing->isStated = true;
  EXPECT_NEAR(settingsFor(found).sensor.timing.clock, 0.02, 1e-12);
  EXPECT_EQ(settingsFor(found).sensor.timing.turn, Turn::automatic);
}

TEST(RawlogInspection, PacketsStateTheirTiming) {
  const fs::path sample = "/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog";
  if (!fs::exists(sample)) GTEST_SKIP() << sample << " is not there";
  const ScanTiming stated = inspectRawlog(sample.string()).stated;
  EXPECT_EQ(stated.turn, Turn::clockwise);
  EXPECT_NEAR(stated.seconds, 0.1, 0.002);
  EXPECT_EQ(stated.stamp, 0);
}

TEST_F(InspectApp, FindsFromThePolesHowTheLidarOfKittiTurns) {
  POLEMCL_NEEDS_DATA();
  ImportOptions options;
  options.input = dataFolder() / "kitti_raw_0005";
  options.output = folder / "in.rawlog";
  importDataset(options);
  InspectOptions files;
  files.input = folder / "in.rawlog";
  files.writeConfig = folder / "found.ini";
  files.truth = folder / "in.tum";
  const Inspection found = inspect(files);
  const auto& timing = found.timing;
  ASSERT_TRUE(timing);
  EXPECT_EQ(timing->timing.turn, Turn::clockwise);
  EXPECT_NEAR(std::abs(timing->timing.cut), M_PI, 0.3);
  ASSERT_TRUE(found.ranges);
  EXPECT_NEAR(found.ranges->offset, 0.055, 0.025);  // as in config/kitti.ini
  EXPECT_EQ(timing->timing.clock, 0);
  EXPECT_HAS(readText(folder / "found.ini"), "turn = clockwise");

  options.timing = {Turn::clockwise, 0.1, M_PI, 0.5};  // now the rawlog states it
  importDataset(options);
  const Inspection stated = inspect(files);
  ASSERT_TRUE(stated.timing);
  EXPECT_TRUE(stated.timing->isStated);
  EXPECT_HAS(printed(stated), "as the rawlog states it: clockwise, cut at 180 deg");
  const SensorOptions written = loadSettings((folder / "found.ini").string()).sensor;
  EXPECT_EQ(written.timing.turn, Turn::automatic);
  EXPECT_EQ(written.timing.clock, 0);
}

}  // namespace
}  // namespace polemcl::test_inspect_app
