#include <iomanip>
#include <memory>
#include <sstream>

#include "cli/Outputs.h"
#include "eval/ClassifierTraining.h"
#include "eval/EvalApp.h"
#include "import/DatasetImport.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

std::string scoreText(const CandidatesSummary& s) {
  std::ostringstream out;
  out << "scans " << s.scans << ", candidates: " << s.poles << " poles, " << s.others << " others, "
      << s.unsure << " unsure (left out)\n";
  return out.str();
}

std::string scoreText(const std::vector<DriveScore>& scores) {
  std::ostringstream out;
  out << std::left << std::setw(28) << "drive" << std::right << std::setw(9) << "poles"
      << std::setw(9) << "others" << std::setw(22) << "log loss, now / new" << std::setw(26)
      << "avg precision, now / new" << '\n';
  for (const DriveScore& s : scores)
    out << std::left << std::setw(28) << s.drive << std::right << std::setw(9) << s.poles
        << std::setw(9) << s.candidates - s.poles << std::setw(13) << io::fixed(s.builtInLoss, 4)
        << std::setw(9) << io::fixed(s.loss, 4) << std::setw(17) << io::fixed(s.builtInPrecision, 4)
        << std::setw(9) << io::fixed(s.precision, 4) << (s.leftOut ? "" : "  test") << '\n';
  return out.str();
}

Subcommand candidatesCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("candidates",
                                      "Labels the candidates of a drive, the input of `train`");
  const auto options = std::make_shared<CandidatesOptions>();
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
          "True poles (CSV: id, x, y, radius, top); without them, candidates are labelled "
          "by what all scans together show at their place");
  addNumber(cli, "--every", options->every, "Take every N-th scan only", CLI::PositiveNumber)
      ->type_name("N");
  addOutput(cli, "--output", options->output, "Table to write (CSV)")->required();
  return {&cli, [options, config, pose, set](bool) {
            options->T_robot_sensor = parseSensorPose(*pose);
            return scoreText(writeCandidates(*options, loadSettings(*config, *set)));
          }};
}

Subcommand trainCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "train", "Fits the confidence of poles and their covariance to labelled candidates");
  const auto options = std::make_shared<TrainOptions>();
  addFile(cli, "--candidates", options->candidates, "Tables of `candidates`, one per drive")
      ->required();
  addFile(cli, "--test", options->test, "Tables that are only scored");
  addNumber(cli, "--products", options->products, "Number of products of two terms",
            CLI::Range(0, 100));
  addNumber(cli, "--ridge", options->ridge, "Penalty of squared weights, a factor without unit",
            positiveNumber());
  addNumber(cli, "--real-weight", options->realWeight,
            "Weight of a candidate of a real drive, as a multiple of one of a simulated drive",
            positiveNumber());
  cli.add_flag("!--no-cross-validation", options->crossValidate,
               "Do not score each drive by weights fitted to the others");
  addOutput(cli, "--classifier", options->classifier, "Weights to write (CSV)")->required();
  addOutput(cli, "--covariance", options->covariance, "Scale of the covariances to write (CSV)");
  addOutput(cli, "--json", options->json, "Write the scores to this file (JSON)");
  return {&cli, [options](bool) { return scoreText(trainClassifier(*options)); }};
}

}  // namespace

std::vector<Subcommand> trainingCommands(CLI::App& program) {
  return {candidatesCommand(program), trainCommand(program)};
}

}  // namespace polemcl::apps
