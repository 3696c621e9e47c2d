/// \file RepeatabilityEval.cpp
/// \brief `pole-eval repeatability` and `rotation`: poles found again in the next scans, moved by
/// the (planar) true poses, and in the same scan turned about the vertical.

#include "cli/Progress.h"
#include "cli/Settings.h"
#include "core/evaluation/Repeatability.h"
#include "eval/DriveTruth.h"
#include "eval/EvalApp.h"
#include "eval/Figures.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

struct RepeatabilityOptions : EvalOptions {
  std::filesystem::path poles, truth;
};

struct RotationOptions : EvalOptions {
  std::filesystem::path config, input;
  std::vector<std::string> set;
  std::size_t every = 1;
  double radius = 0.01;
};

Figures repeatabilityFigures(const RepeatabilityOptions& options) {
  const DriveTruth truth(options.truth, options.poles);
  std::vector<std::vector<Eigen::Vector2d>> scans_map;
  streamStoredPoles(options.poles, [&](const ReadScan& scan) {
    const Pose2D pose = truth.at(scan.time, scan.index);
    scans_map.emplace_back();
    for (const PoleDetection& pole : truth.deskewed(scan)) {
      const Pose2D moved = compose(pose, {pole.x, pole.y, 0});
      scans_map.back().emplace_back(moved.x, moved.y);
    }
  });
  const RepeatabilityScore s =
      io::located(options.poles.string() + ": ", [&] { return evaluateRepeatability(scans_map); });
  const Json json{{"scans", s.scans},       {"detections", s.detections}, {"judged", s.judged},
                  {"repeated", s.repeated}, {"per_scan", s.perScan},      {"share", s.share}};
  return {json, filled("scans {scans}, poles per scan {per_scan:2}; found again within 0.25 m in "
                       "at least 3 of the next 5 scans: {repeated} of {judged} = {share:4}\n",
                       json)};
}

Figures rotationFigures(const RotationOptions& options) {
  const AllSettings settings = loadSettings(options.config.string(), options.set);
  Progress progress("turn", 0, options.quiet);
  ObservationPoleExtractor source(settings.poleExtraction());
  PoleExtractor extractor(settings.sensor, settings.extraction);
  RotationScore s;
  SequenceOptions sequence = settings.reading();
  sequence.vehicle.lidars.clear();
  streamPoles(options.input.string(), sequence, [&](const ReadScan& scan) {
    if (scan.stored)
      throw Error(options.input.string() + ": holds poles, not scans; only scans can be turned");
    progress.update(scan.index + 1, scan.expected);
    if (scan.index % options.every != 0 || scan.points == 0) return;
    const auto cloud = source.lidarPoints(*scan.sources.front());
    addRotations(extractor, cloud.view(), options.radius, s);
  });
  const Json json{{"scans", s.scans},         {"turns", s.turns},
                  {"poles", s.poles},         {"turned_poles", s.turnedPoles},
                  {"matched", s.matched},     {"share", s.share},
                  {"back_share", s.backShare}};
  return {json,
          filled("scans {scans}, turned by 30, 60, ... 330 deg; poles found again within ", json) +
              io::significant(100 * options.radius, 6) +
              filled(" cm, one to one: {matched} of {poles} = {share:4}; of the turned scans' "
                     "poles {back_share:4}\n",
                     json)};
}

void declareRepeatability(CLI::App& cli, RepeatabilityOptions& options) {
  addFile(cli, "--poles", options.poles, "Rawlog of poles")->required();
  addFile(cli, "--truth", options.truth, "True robot poses, TUM")->required();
}

void declareRotation(CLI::App& cli, RotationOptions& options) {
  addConfigOption(cli, options.config)->required();
  addSetOption(cli, options.set);
  addFile(cli, "--input", options.input, "Rawlog of scans")->required();
  addNumber(cli, "--every", options.every, "Turn every N-th scan only", CLI::PositiveNumber)
      ->type_name("N");
  addNumber(cli, "--radius", options.radius, "Distance within which a pole is found again, m",
            CLI::PositiveNumber);
}

}  // namespace

Subcommand repeatabilityCommand(CLI::App& program) {
  return evalCommand<RepeatabilityOptions>(program, "repeatability",
                                           "Share of poles found again in the next scans",
                                           declareRepeatability, repeatabilityFigures);
}

Subcommand rotationCommand(CLI::App& program) {
  return evalCommand<RotationOptions>(program, "rotation",
                                      "Share of poles found again when scans are turned about z",
                                      declareRotation, rotationFigures);
}

}  // namespace polemcl::apps
