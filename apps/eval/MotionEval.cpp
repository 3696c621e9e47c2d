/// \file MotionEval.cpp
/// \brief `pole-eval motion`: do the true poses agree with what the poles of single scans say? No
/// map, no filter: only which way the robot went between two scans that saw the same poles.

#include <cmath>

#include "core/common/Angles.h"
#include "core/evaluation/MotionCheck.h"
#include "eval/DriveTruth.h"
#include "eval/EvalApp.h"
#include "eval/Figures.h"

namespace polemcl::apps {
namespace {

struct MotionEvalOptions : EvalOptions {
  std::filesystem::path poles, truth;
  std::size_t every = 4;
};

/// One stretch between two scans, as three sources have it: robot motions in the frame of the first
/// scan, m and rad.
struct Stretch {
  std::size_t scan = 0;  ///< 0-based index of the first scan
  Pose2D truth;
  std::optional<Pose2D> odometry;  ///< none where the rawlog has none
  ScanRegistration poles;  ///< from the true motion on; fewer than 3 pairs: the poles do not tell
};

/// \param scans Gets all scans, at their true poses.
std::vector<Stretch> readStretches(const MotionEvalOptions& options,
                                   std::vector<SessionScan>& scans) {
  const DriveTruth truth(options.truth, options.poles);
  std::vector<Stretch> stretches;
  std::vector<PoleDetection> before;
  Pose2D poseBefore;
  std::optional<Pose2D> odometry = Pose2D();
  streamStoredPoles(options.poles, [&](const ReadScan& scan) {
    if (odometry && scan.motion) odometry = compose(*odometry, scan.motion->mean);
    if (!scan.motion) odometry.reset();
    const Pose2D pose = truth.at(scan.time, scan.index);
    const auto poles = truth.deskewed(scan);
    scans.emplace_back();
    scans.back().time = scan.time;
    scans.back().pose_map_robot = pose;
    scans.back().poles_robot = poles;
    if (scan.index % options.every != 0) return;
    if (scan.index > 0) {
      const Pose2D motion = relative(poseBefore, pose);
      stretches.push_back(
          {scan.index - options.every, motion, odometry, motionOfPoles(before, poles, motion)});
    }
    before = poles;
    poseBefore = pose;
    odometry = Pose2D();
  });
  if (stretches.empty())
    throw Error(options.poles.string() + ": fewer than two scans, " +
                std::to_string(options.every) + " apart, to compare; a smaller --every may help");
  return stretches;
}

Json motionJson(const Pose2D& motion) {
  return {{"m", std::hypot(motion.x, motion.y)}, {"deg", motion.yaw * 180 / M_PI}};
}

std::string cells(const Json& motion) {
  return motion.is_null() ? std::string(16, ' ') + '-' : filled("{m:9.3}{deg:8.2}", motion);
}

Figures motionFigures(const MotionEvalOptions& options) {
  Json rows = Json::array();
  std::string text = " scan  truth m     deg  odom. m     deg  poles m     deg  pairs\n";
  double metres = 0, radians = 0, way = 0;
  std::vector<SessionScan> scans;
  for (const Stretch& stretch : readStretches(options, scans)) {
    const Pose2D &truth = stretch.truth, &poles = stretch.poles.motion;
    const Json row{{"scan", stretch.scan},
                   {"truth", motionJson(truth)},
                   {"odometry", stretch.odometry ? motionJson(*stretch.odometry) : Json()},
                   {"poles", motionJson(poles)},
                   {"pairs", stretch.poles.pairs}};
    const bool tell = stretch.poles.pairs >= 3;
    rows.push_back(row);
    text += filled("{scan:5.0}", row) + cells(row["truth"]) + cells(row["odometry"]) +
            cells(tell ? row["poles"] : Json()) + filled("{pairs:7.0}\n", row);
    if (!tell) continue;
    way += std::hypot(truth.x, truth.y);
    metres += std::hypot(poles.x, poles.y) - std::hypot(truth.x, truth.y);
    radians += wrapAngle(poles.yaw - truth.yaw);
  }
  const MotionCheck check = checkMotion(scans);
  const std::string mounting = check.mountingDoubt();
  return {rows, text +
                    filled("the poles say {metres:3} m and {deg:2} deg more than the truth, over "
                           "{way:1} m\n",
                           {{"metres", metres}, {"deg", radians * 180 / M_PI}, {"way", way}}) +
                    check.verdict() + '\n' + (mounting.empty() ? "" : mounting + '\n')};
}

void declareMotion(CLI::App& cli, MotionEvalOptions& options) {
  addFile(cli, "--poles", options.poles, "Rawlog of poles")->required();
  addFile(cli, "--truth", options.truth, "True robot poses, TUM")->required();
  addNumber(cli, "--every", options.every, "In the table, compare each scan with the N-th after it",
            CLI::PositiveNumber)
      ->type_name("N");
}

}  // namespace

Subcommand motionCommand(CLI::App& program) {
  return evalCommand<MotionEvalOptions>(
      program, "motion", "Compares the true poses with the motion of the poles from scan to scan",
      declareMotion, motionFigures);
}

}  // namespace polemcl::apps
