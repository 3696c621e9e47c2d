#include "eval/MotionEval.h"

#include <cmath>

#include "cli/JsonFile.h"
#include "core/evaluation/MotionCheck.h"
#include "io/data/Trajectory.h"
#include "localize/TrialDrive.h"

namespace polemcl::apps {
namespace {

nlohmann::ordered_json motionJson(const Pose2D& motion) {
  return {{"m", std::hypot(motion.x, motion.y)}, {"deg", motion.yaw * 180 / M_PI}};
}

nlohmann::ordered_json motionJson(const std::vector<MotionComparison>& stretches) {
  auto rows = nlohmann::ordered_json::array();
  for (const MotionComparison& stretch : stretches)
    rows.push_back(
        {{"scan", stretch.scan},
         {"truth", motionJson(stretch.truth)},
         {"odometry", stretch.odometry ? motionJson(*stretch.odometry) : nlohmann::ordered_json()},
         {"poles", motionJson(stretch.poles.motion)},
         {"pairs", stretch.poles.pairs}});
  return rows;
}

}  // namespace

std::vector<MotionComparison> evalMotion(const EvalMotionOptions& options) {
  if (options.every < 1) throw Error("--every 0 compares no scans: a number from 1 on is allowed");
  const auto truth = io::readPlanarTum(options.truth);
  std::vector<MotionComparison> result;
  std::vector<PoleDetection> before;
  Pose2D poseBefore;
  std::optional<Pose2D> odometry = Pose2D();
  streamStoredPoles(options.poles, [&](const ReadScan& scan) {
    if (odometry && scan.motion) odometry = compose(*odometry, scan.motion->mean);
    if (!scan.motion) odometry.reset();
    if (scan.index % options.every != 0) return;
    const Pose2D pose = truePose(truth, options.truth, scan.time, scan.index, options.poles);
    const auto poles = trulyDeskewed(scan, truth);
    if (scan.index > 0) {
      const Pose2D motion = relative(poseBefore, pose);
      result.push_back(
          {scan.index - options.every, motion, odometry, motionOfPoles(before, poles, motion)});
    }
    before = poles;
    poseBefore = pose;
    odometry = Pose2D();
  });
  if (result.empty())
    throw Error(options.poles.string() + ": fewer than two scans, " +
                std::to_string(options.every) + " apart, to compare; a smaller --every may help");
  if (options.json) writeJson(*options.json, motionJson(result));
  return result;
}

}  // namespace polemcl::apps
