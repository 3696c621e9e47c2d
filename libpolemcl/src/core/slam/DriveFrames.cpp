#include "core/slam/DriveFrames.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// Loops agree on a motion within what an odometry errs by between them.
constexpr double kAgree = 10, kAgreeYaw = 0.2;  ///< m, rad
constexpr std::ptrdiff_t kFewestAgreeing = 2;

/// A loop between two frames: one pose in both.
struct Bridge {
  std::size_t low = 0, high = 0;  ///< frames
  Pose2D pose_low, pose_high;
  Pose2D motion() const { return compose(pose_low, relative(pose_high, Pose2D())); }
};

Bridge bridgeOf(const Loop& loop, const std::vector<std::size_t>& frames,
                const std::vector<Pose2D>& poses) {
  const std::size_t first = frames[loop.tie.first], second = frames[loop.tie.second];
  const Pose2D& pose = poses[loop.tie.second];
  const Pose2D place = compose(poses[loop.tie.first], loop.tie.motion.mean);
  if (first <= second) return {first, second, place, pose};
  return {second, first, pose, place};
}

bool near(const Pose2D& a, const Pose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kAgree &&
         std::abs(wrapAngle(a.yaw - b.yaw)) < kAgreeYaw;
}

bool agree(const Bridge& a, const Bridge& b) {
  return a.low == b.low && a.high == b.high && near(compose(a.motion(), b.pose_high), b.pose_low);
}

/// The bridge that most others agree with; none if too few do.
std::optional<Bridge> bestBridge(const std::vector<Loop>& loops,
                                 const std::vector<std::size_t>& frames,
                                 const std::vector<Pose2D>& poses) {
  std::vector<Bridge> bridges;
  for (const Loop& loop : loops) {
    const Bridge bridge = bridgeOf(loop, frames, poses);
    if (bridge.low != bridge.high) bridges.push_back(bridge);
  }
  std::optional<Bridge> best;
  std::ptrdiff_t most = kFewestAgreeing - 1;
  for (const Bridge& bridge : bridges) {
    const auto count = std::count_if(bridges.begin(), bridges.end(),
                                     [&](const Bridge& other) { return agree(bridge, other); });
    if (count <= most) continue;
    most = count;
    best = bridge;
  }
  return best;
}

}  // namespace

void moveFrame(std::size_t from, std::size_t to, const Pose2D& motion, const PoleTracks& tracks,
               std::vector<std::size_t>& frames, AdjustedState& state) {
  for (std::size_t i = 0; i < tracks.tracks.size(); ++i)
    if (frames[tracks.tracks[i].last] == from)
      state.poles[i] = centreOf(compose(motion, {state.poles[i].x(), state.poles[i].y(), 0}));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i] != from) continue;
    state.poses[i] = compose(motion, state.poses[i]);
    frames[i] = to;
  }
}

bool connectFrames(std::vector<Loop>& loops, const PoleTracks& tracks,
                   std::vector<std::size_t>& frames, AdjustedState& state) {
  const auto within = [&](const Loop& loop) {
    return frames[loop.tie.first] == frames[loop.tie.second];
  };
  const auto between = std::stable_partition(loops.begin(), loops.end(), within);
  std::vector<Loop> bridges(between, loops.end());
  loops.erase(between, loops.end());
  bool connected = false;
  while (const auto best = bestBridge(bridges, frames, state.poses)) {
    moveFrame(best->high, best->low, best->motion(), tracks, frames, state);
    connected = true;
  }
  for (Loop& loop : bridges) {
    const Bridge bridge = bridgeOf(loop, frames, state.poses);
    if (within(loop) && near(bridge.pose_low, bridge.pose_high)) loops.push_back(std::move(loop));
  }
  return connected;
}

}  // namespace polemcl
