#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>

#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "core/evaluation/MotionCheck.h"
#include "eval/DetectionModelApp.h"
#include "eval/EvalApp.h"
#include "eval/ExtractionEval.h"
#include "eval/LabelledFeatures.h"
#include "eval/MotionEval.h"
#include "eval/MrptTruth.h"
#include "import/DatasetImport.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

std::string shownText(const std::optional<double>& value, int decimals, double factor = 1) {
  return value ? io::fixed(*value * factor, decimals) : "-";
}

std::string scoreText(const DetectionScore& s) {
  std::ostringstream out;
  out << "scans " << s.scans << ", detections " << s.detections << " (" << s.right
      << " right), visible poles " << s.visible << " (" << s.found << " found)\n"
      << "precision " << shownText(s.precision, 4) << "  recall " << shownText(s.recall, 4) << '\n'
      << "centre error: median " << shownText(s.centreMedian, 1, 100) << "  mean "
      << shownText(s.centreMean, 1, 100) << "  90 % " << shownText(s.centre90, 1, 100)
      << " cm; mean along the ray " << shownText(s.biasAlong, 1, 100) << "  across "
      << shownText(s.biasAcross, 1, 100) << " cm\n"
      << "radius error: mean " << shownText(s.radiusMean, 1, 100) << "  median of the absolute "
      << shownText(s.radiusMedian, 1, 100) << " cm\n"
      << "normalised squared error: mean " << shownText(s.neesMean, 2) << "  median "
      << shownText(s.neesMedian, 2) << " (2 and 1.39 are right)\n"
      << "confidence: area under the ROC " << shownText(s.auc, 4) << '\n';
  return out.str();
}

std::string scoreText(const RepeatabilityScore& s) {
  std::ostringstream out;
  out << "scans " << s.scans << ", poles per scan " << io::fixed(s.perScan, 2)
      << "; found again within 0.25 m in at least 3 of the next 5 scans: " << s.repeated << " of "
      << s.judged << " = " << io::fixed(s.share, 4) << '\n';
  return out.str();
}

std::string scoreText(const RotationScore& s, double radius) {
  std::ostringstream out;
  out << "scans " << s.scans << ", turned by 30, 60, ... 330 deg; poles found again within "
      << io::significant(100 * radius, 6) << " cm, one to one: " << s.matched << " of " << s.poles
      << " = " << io::fixed(s.share, 4) << "; of the turned scans' poles "
      << io::fixed(s.backShare, 4) << '\n';
  return out.str();
}

Subcommand detectionsCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "detections", "Compares the poles of single scans with the true poles of a simulated folder");
  const auto options = std::make_shared<EvalDetectionsOptions>();
  addFolder(cli, "--scans", options->scans, "Folder that pole-simulate wrote")->required();
  addFile(cli, "--poles", options->poles, "Rawlog of poles extracted from these scans")->required();
  addNumber(cli, "--radius", options->radius, "Distance within which a pole is right, m",
            CLI::PositiveNumber);
  addOutput(cli, "--json", options->json, "Write the results to this file (JSON)");
  addOutput(cli, "--visible", options->visible,
            "Write the true poles visible in the scans to this table (CSV)");
  addNumber(cli, "--min-scans", options->minScans,
            "Least number of scans that see a pole of that table", CLI::PositiveNumber);
  return {&cli, [options](bool) { return scoreText(evalDetections(*options)); }};
}

Subcommand repeatabilityCommand(CLI::App& program) {
  auto& cli =
      *program.add_subcommand("repeatability", "Share of poles found again in the next scans");
  const auto options = std::make_shared<EvalRepeatabilityOptions>();
  addFile(cli, "--poles", options->poles, "Rawlog of poles")->required();
  addFile(cli, "--truth", options->truth, "True robot poses, TUM")->required();
  addOutput(cli, "--json", options->json, "Write the results to this file (JSON)");
  return {&cli, [options](bool) { return scoreText(evalRepeatability(*options)); }};
}

Subcommand rotationCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("rotation",
                                      "Share of poles found again when scans are turned about z");
  const auto options = std::make_shared<EvalRotationOptions>();
  const auto config = std::make_shared<std::string>();
  addConfigOption(cli, *config)->required();
  const auto set = std::make_shared<std::vector<std::string>>();
  addSetOption(cli, *set);
  addFile(cli, "--input", options->input, "Rawlog of scans")->required();
  addNumber(cli, "--every", options->every, "Turn every N-th scan only", CLI::PositiveNumber)
      ->type_name("N");
  addNumber(cli, "--radius", options->radius, "Distance within which a pole is found again, m",
            CLI::PositiveNumber);
  addOutput(cli, "--json", options->json, "Write the results to this file (JSON)");
  return {&cli, [options, config, set](bool quiet) {
            Progress progress("turn", 0, quiet);
            options->progress = progress.updates();
            return scoreText(evalRotation(*options, loadSettings(*config, *set)), options->radius);
          }};
}

std::string scoreText(const sim::DetectionModel& m, const FitModelOptions& options) {
  std::ostringstream out;
  out << options.model.string() << ": " << m.sensor << ", " << m.fittedOn
      << "\nlasting false objects per 100 m: " << io::fixed(100 * m.clutterAlways, 2)
      << " on all days, " << io::fixed(100 * m.clutterToday, 2)
      << " on one; passing false detections per scan: " << io::fixed(m.passing, 3) << '\n';
  return out.str();
}

Subcommand mrptTruthCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "mrpt-truth", "Writes true poses as MRPT's pf-localization reads them: time x y yaw");
  const auto truth = std::make_shared<std::filesystem::path>();
  const auto output = std::make_shared<std::filesystem::path>();
  addFile(cli, "--truth", *truth, "True robot poses, TUM")->required();
  addOutput(cli, "--output", *output, "File to write")->required();
  return {&cli, [truth, output](bool) {
            writeMrptTruth(*truth, *output);
            return output->string() + ": true poses for pf-localization\n";
          }};
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

std::string cells(const Pose2D& motion) {
  std::ostringstream out;
  out << std::setw(9) << io::fixed(std::hypot(motion.x, motion.y), 3) << std::setw(8)
      << io::fixed(motion.yaw * 180 / M_PI, 2);
  return out.str();
}

std::string scoreText(const std::vector<MotionComparison>& stretches) {
  std::ostringstream out;
  const std::string none = std::string(16, ' ') + '-';
  out << " scan  truth m     deg  odom. m     deg  poles m     deg  pairs\n";
  double metres = 0, radians = 0, way = 0;
  MotionCheck check;
  for (const MotionComparison& stretch : stretches) {
    const Pose2D &truth = stretch.truth, &poles = stretch.poles.motion;
    const bool tell = stretch.poles.pairs >= 3;
    out << std::setw(5) << stretch.scan << cells(truth)
        << (stretch.odometry ? cells(*stretch.odometry) : none) << (tell ? cells(poles) : none)
        << std::setw(7) << stretch.poles.pairs << '\n';
    check.add(stretch.poles, truth);
    if (!tell) continue;
    way += std::hypot(truth.x, truth.y);
    metres += std::hypot(poles.x, poles.y) - std::hypot(truth.x, truth.y);
    radians += wrapAngle(poles.yaw - truth.yaw);
  }
  out << "the poles say " << io::fixed(metres, 3) << " m and " << io::fixed(radians * 180 / M_PI, 2)
      << " deg more than the truth, over " << io::fixed(way, 1) << " m\n"
      << check.verdict() << '\n';
  return out.str();
}

Subcommand motionCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "motion", "Compares the true poses with the motion of the poles from scan to scan");
  const auto options = std::make_shared<EvalMotionOptions>();
  addFile(cli, "--poles", options->poles, "Rawlog of poles")->required();
  addFile(cli, "--truth", options->truth, "True robot poses, TUM")->required();
  addNumber(cli, "--every", options->every, "Compare each scan with the N-th after it",
            CLI::PositiveNumber)
      ->type_name("N");
  addOutput(cli, "--json", options->json, "Write the results to this file (JSON)");
  return {&cli, [options](bool) { return scoreText(evalMotion(*options)); }};
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

std::vector<Subcommand> extractionCommands(CLI::App& program) {
  return {detectionsCommand(program), repeatabilityCommand(program), rotationCommand(program),
          modelCommand(program),      mrptTruthCommand(program),     sightingsCommand(program),
          motionCommand(program),     featuresCommand(program)};
}

}  // namespace polemcl::apps
