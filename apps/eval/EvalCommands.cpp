#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

#include "cli/JsonFile.h"
#include "cli/Outputs.h"
#include "eval/DriveTruth.h"
#include "eval/EvalApp.h"
#include "eval/LabelledFeatures.h"
#include "import/DatasetImport.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "sim/detections/DetectionModel.h"
#include "sim/detections/DetectionModelFit.h"
#include "sim/detections/DetectionSummary.h"
#include "simulate/SimulatedPoles.h"

namespace polemcl::apps {
namespace {

/// `pole-eval model`.
struct FitModelOptions {
  /// Rawlogs that `pole-simulate --poles` wrote, with their P_config.ini beside them: two for each
  /// street, on two days.
  std::vector<std::filesystem::path> drives;
  std::filesystem::path model;  ///< JSON to write
};

/// `pole-eval sightings`.
struct EvalObservationsOptions {
  std::filesystem::path poles;  ///< rawlog of `pole-simulate --poles`, P_config.ini beside it
  std::optional<std::filesystem::path> json;
};

/// A drive with what it needs to be looked at: the world is built again from its settings.
struct LoadedDrive {
  AllSettings settings;
  std::unique_ptr<sim::SimulatedDrive> drive;
  sim::ObservedDrive observed;

  explicit LoadedDrive(const std::filesystem::path& rawlog)
      : settings(loadSettings(poleDriveFiles(rawlog).config.string())),
        drive(std::make_unique<sim::SimulatedDrive>(settings.simulation, settings.sensor)) {
    observed.drive = drive.get();
    streamStoredPoles(rawlog, [&](const ReadScan& scan) {
      observed.poles.push_back(scan.observation->poles);
      observed.points.push_back(scan.observation->points);
    });
    if (observed.poles.size() != drive->scans())
      throw Error(rawlog.string() + ": holds " + std::to_string(observed.poles.size()) +
                  " scans, and the drive of its settings has " + std::to_string(drive->scans()));
  }
};

std::string describe(const std::vector<LoadedDrive>& drives) {
  std::ostringstream text;
  std::size_t scans = 0;
  double length = 0;
  text << "worlds";
  for (std::size_t i = 0; i < drives.size(); ++i) {
    if (i % 2 == 0) text << (i > 0 ? ", " : " ") << drives[i].settings.simulation.world.seed;
    scans += drives[i].observed.poles.size();
    length += drives[i].drive->length();
  }
  text << "; " << scans << " scans over " << static_cast<int>(length) << " m, two days each";
  return text.str();
}

/// Fits and writes the model.
/// \throws Error naming the file: no P_config.ini, another number of scans than its drive has, an
///         odd number of drives, drives that do not belong together.
sim::DetectionModel fitModel(const FitModelOptions& options) {
  if (options.drives.empty() || options.drives.size() % 2 != 0)
    throw Error("--drives: " + std::to_string(options.drives.size()) +
                " are given; two for each street are needed, of two days");
  std::vector<LoadedDrive> drives;
  for (const auto& rawlog : options.drives) drives.emplace_back(rawlog);
  std::vector<sim::ObservedStreet> streets;
  for (std::size_t i = 0; i < drives.size(); i += 2)
    streets.push_back({drives[i].observed, drives[i + 1].observed});
  const double maxRange = drives.front().settings.extraction.scanLine.maxRange;
  auto model = sim::fitDetectionModel(streets, maxRange, describe(drives));
  sim::writeDetectionModel(options.model, model);
  return model;
}

/// Figures of one simulated drive, cast or drawn. \throws Error as fitModel().
sim::DetectionSummary evalObservations(const EvalObservationsOptions& options) {
  const LoadedDrive drive(options.poles);
  auto s = sim::summarizeDetections(drive.observed, drive.settings.extraction.scanLine.maxRange);
  if (!options.json) return s;
  writeJson(*options.json, {{"scans", s.scans},
                            {"detections", s.detections},
                            {"per_scan", s.perScan},
                            {"false_per_scan", s.falsePerScan},
                            {"lasting_false_per_scan", s.lastingFalsePerScan},
                            {"centre_median_m", s.centreMedian},
                            {"centre_p90_m", s.centre90},
                            {"nees_mean", s.neesMean},
                            {"nees_median", s.neesMedian},
                            {"found_run_m", s.foundRun},
                            {"missed_run_m", s.missedRun},
                            {"confidence", s.confidence},
                            {"range_edges_m", s.rangeEdges},
                            {"recall", s.recall}});
  return s;
}

std::string shownText(const std::optional<double>& value, int decimals, double factor = 1) {
  return value ? io::fixed(*value * factor, decimals) : "-";
}

std::string scoreText(const sim::DetectionModel& m, const FitModelOptions& options) {
  std::ostringstream out;
  out << options.model.string() << ": " << m.sensor << ", " << m.fittedOn
      << "\nlasting false objects per 100 m: " << io::fixed(100 * m.clutterAlways, 2)
      << " on all days, " << io::fixed(100 * m.clutterToday, 2)
      << " on one; passing false detections per scan: " << io::fixed(m.passing, 3) << '\n';
  return out.str();
}

Subcommand modelCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "model", "Fits a model of detections ([simulation] detections) to ray-cast drives");
  const auto options = std::make_shared<FitModelOptions>();
  addFile(cli, "--drives", options->drives,
          "Rawlogs of pole-simulate --poles: for each street two, of two days")
      ->required();
  addOutput(cli, "--model", options->model, "Model to write (JSON)")->required();
  return {&cli, [options](bool) { return scoreText(fitModel(*options), *options); }};
}

std::string scoreText(const sim::DetectionSummary& s) {
  std::ostringstream out;
  out << "scans " << s.scans << ", detections per scan " << io::fixed(s.perScan, 2) << ", false "
      << io::fixed(s.falsePerScan, 3) << " (" << io::fixed(s.lastingFalsePerScan, 3)
      << " of lasting objects)\nfound of the poles within";
  for (std::size_t i = 0; i < s.recall.size(); ++i)
    out << ' ' << io::significant(s.rangeEdges[i + 1], 3) << " m: " << shownText(s.recall[i], 3)
        << (i + 1 < s.recall.size() ? "," : "\n");
  out << "centre error: median " << shownText(s.centreMedian, 1, 100) << "  90 % "
      << shownText(s.centre90, 1, 100) << " cm; normalised squared error: mean "
      << shownText(s.neesMean, 2) << "  median " << shownText(s.neesMedian, 2)
      << "; confidence: mean " << shownText(s.confidence, 3) << "\nmean path found without a break "
      << shownText(s.foundRun, 2) << " m, missed " << shownText(s.missedRun, 2) << " m\n";
  return out.str();
}

Subcommand sightingsCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "sightings", "Compares the poles of a simulated drive with the true poles; needs no scans");
  const auto options = std::make_shared<EvalObservationsOptions>();
  addFile(cli, "--poles", options->poles, "Rawlog that pole-simulate --poles wrote")->required();
  addOutput(cli, "--json", options->json, "Write the results to this file (JSON)");
  return {&cli, [options](bool) { return scoreText(evalObservations(*options)); }};
}

std::string scoreText(const FeaturesSummary& s) {
  std::ostringstream out;
  out << "scans " << s.scans << ", candidates: " << s.poles << " poles, " << s.others << " others, "
      << s.unsure << " unsure (left out)\n";
  return out.str();
}

Subcommand featuresCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "features", "Writes the features of the candidates of a drive, with labels");
  const auto options = std::make_shared<FeaturesOptions>();
  const auto config = std::make_shared<std::string>();
  const auto pose = std::make_shared<std::string>("0 0 0 0 0 0");
  const auto set = std::make_shared<std::vector<std::string>>();
  addConfigOption(cli, *config)->required();
  addSetOption(cli, *set);
  addFolder(cli, "--scans", options->scans,
            "Folder with velodyne/*.bin or *.pcd, and poses.txt; in the LiDAR's own frame")
      ->required();
  cli.add_option("--sensor-pose", *pose, "Frame of the clouds on the robot, m and deg")
      ->type_name("'X Y Z YAW_DEG PITCH_DEG ROLL_DEG'")
      ->default_str("0")
      ->check(
          [](const std::string& text) { return io::problemOf([&] { parseSensorPose(text); }); });
  addFile(cli, "--poles", options->poles,
          "True poles (CSV: id, x, y, radius, top); without them, all scans together label the "
          "candidates");
  addOutput(cli, "--output", options->output, "Table to write (CSV)")->required();
  return {&cli, [options, config, pose, set](bool) {
            options->T_robot_sensor = parseSensorPose(*pose);
            return scoreText(writeFeatures(*options, loadSettings(*config, *set)));
          }};
}

}  // namespace

std::vector<Subcommand> modelCommands(CLI::App& program) {
  return {modelCommand(program), sightingsCommand(program), featuresCommand(program)};
}

}  // namespace polemcl::apps
