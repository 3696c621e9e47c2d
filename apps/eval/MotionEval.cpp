#include "eval/MotionEval.h"

#include <cmath>

#include <polemcl/mrpt/rawlog/PoleSequence.h>
#include "cli/JsonFile.h"
#include "core/common/PoseInterpolation.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double s_longestGap = 2;  // of the truth, s

nlohmann::ordered_json motionJson(const Pose2D& motion) {
  return {{"m", std::hypot(motion.x, motion.y)}, {"deg", motion.yaw * 180 / M_PI}};
}

nlohmann::ordered_json motionJson(const std::vector<MotionComparison>& stretches) {
  auto rows = nlohmann::ordered_json::array();
  for (const MotionComparison& stretch : stretches) {
    nlohmann::ordered_json row{{"scan", stretch.scan}, {"truth", motionJson(stretch.truth)}};
    row["odometry"] = stretch.odometry ? motionJson(*stretch.odometry) : nlohmann::ordered_json();
    row["poles"] = motionJson(stretch.poles.motion);
    row["pairs"] = stretch.poles.pairs;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::vector<MotionComparison> evalMotion(const EvalMotionOptions& options) {
  if (options.every < 1) throw Error("--every 0 compares no scans: a number from 1 on is allowed");
  const auto truth = io::planar(io::readTum(options.truth));
  std::vector<MotionComparison> result;
  std::vector<PoleDetection> before;
  Pose2D poseBefore;
  std::optional<Pose2D> odometry = Pose2D();
  streamPoles(options.poles.string(), {}, [&](const PoleScan& scan) {
    if (!scan.stored)
      throw Error(options.poles.string() +
                  ": holds scans, not poles; extract them with pole-extract first");
    if (odometry && scan.motion) odometry = compose(*odometry, scan.motion->mean);
    if (!scan.motion) odometry.reset();
    if (scan.index % options.every != 0) return;
    const auto pose = poseAt(truth, scan.time, s_longestGap);
    if (!pose)
      throw Error(options.truth.string() + ": no pose at " + io::fixed(scan.time, 6) +
                  " s, the time of scan " + std::to_string(scan.index) + " of " +
                  options.poles.string());
    const auto poles = scan.observation->polesInRobotFrame();
    if (scan.index > 0) {
      const Pose2D motion = relative(poseBefore, *pose);
      result.push_back({scan.index - options.every, motion, odometry,
                        refineMotion(before, poles, motion, RegistrationOptions())});
    }
    before = poles;
    poseBefore = *pose;
    odometry = Pose2D();
  });
  if (result.empty())
    throw Error(options.poles.string() + ": fewer than two scans, " +
                std::to_string(options.every) + " apart, to compare; a smaller --every may help");
  if (options.json) writeJson(*options.json, motionJson(result));
  return result;
}

}  // namespace polemcl::apps
