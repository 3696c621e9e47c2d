#include "io/dataset/RosbagMotions.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/common/Covariance.h"
#include "io/data/PlanarMotion.h"
#include "io/data/TrackSampler.h"
#include "io/data/Trajectory.h"
#include "io/dataset/ScanPoses.h"
#include "io/rosbag/RosMessages.h"

namespace polemcl::io {
namespace {

/// Longest time between two messages of an IMU over which it is integrated, s.
constexpr double kImuGap = 0.2;

/// What a topic says of the motion.
struct MeasuredTrack {
  explicit MeasuredTrack(const std::vector<double>& times, double gap) : poses(times, gap) {}
  TrackSampler poses;  ///< in the odometry frame; of an IMU, the yaw only
  MotionSteps steps;   ///< those with covariances
  /// All; without a covariance; not later than the one before; without a pose.
  std::size_t messages = 0, uncertain = 0, unordered = 0, invalid = 0;
  std::vector<double> gapEnds;  ///< of an IMU: times of the messages that came too late, s
};

void noteTrack(const BagTopic& topic, const MeasuredTrack& track, std::vector<std::string>& notes) {
  const std::string of = topic.name + ": " + std::to_string(track.messages) + " messages, ";
  if (track.unordered > 0)
    notes.push_back(of + std::to_string(track.unordered) +
                    " ignored: not later than the message before");
  if (track.invalid > 0)
    notes.push_back(of + std::to_string(track.invalid) +
                    " ignored: numbers that are not finite, or no rotation");
  if (track.uncertain > 0)
    notes.push_back(of + std::to_string(track.uncertain) +
                    " without a covariance; motions without one get 2 % of each component");
}

/// Covariance of (vx, vy, yaw rate).
Eigen::Matrix3d planarTwist(const RosOdometry& odometry) {
  constexpr int kIndex[] = {0, 1, 5};
  Eigen::Matrix3d planar;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      planar(row, column) = odometry.twistCovariance(kIndex[row], kIndex[column]);
  return planar;
}

bool isStated(const Eigen::Matrix3d& covariance) {
  return isCovariance(covariance) && covariance.trace() > 0;
}

/// \param child Set to the child frame.
MeasuredTrack readOdometry(const Bag& bag, std::size_t topic, const std::vector<double>& times,
                           std::string& child) {
  MeasuredTrack track(times, kTrackGap);
  std::optional<RosOdometry> last;
  for (const BagMessage& message : bag.messages(topic)) {
    const std::string where = bag.place(message);
    RosOdometry odometry = decodeOdometry(bag.read(message), where);
    if (track.messages++ == 0) child = odometry.child;
    if (!odometry.T_odom_child) {
      ++track.invalid;
      continue;
    }
    if (odometry.child != child)
      throw Error(where + "child frame " + odometry.child + ", that of the messages before is " +
                  child + "; one robot a topic is allowed");
    if (!track.poses.add(odometry.header.time, *odometry.T_odom_child)) {
      ++track.unordered;
      continue;
    }
    const Eigen::Matrix3d covariance = planarTwist(odometry);
    if (!isStated(covariance)) {
      ++track.uncertain;
    } else if (last) {
      const double begin = last->header.time, end = odometry.header.time;
      const Pose2D step = planar(last->T_odom_child->inverse() * *odometry.T_odom_child);
      track.steps.add(begin, end, {step, covariance * (end - begin) * (end - begin)});
    }
    last = std::move(odometry);
  }
  return track;
}

/// The axis about which the robot turns, in the frame of the IMU.
Eigen::Vector3d robotAxis(const std::string& imuFrame, const std::string& robot,
                          const FrameTree& frames, std::vector<std::string>& notes) {
  const auto T_robot_imu = frames.find(robot, imuFrame);
  if (!T_robot_imu)
    notes.push_back("no static transform from " + robot + " to " + imuFrame +
                    ": the z axis of the IMU is taken for that of the robot");
  return T_robot_imu ? Eigen::Vector3d(T_robot_imu->linear().row(2)) : Eigen::Vector3d::UnitZ();
}

MeasuredTrack readImu(const Bag& bag, std::size_t topic, const std::vector<double>& times,
                      const std::string& robot, const FrameTree& frames,
                      std::vector<std::string>& notes) {
  MeasuredTrack track(times, kImuGap);
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double yaw = 0, lastTime = 0, lastRate = 0;
  for (const BagMessage& message : bag.messages(topic)) {
    const RosImu imu = decodeImu(bag.read(message), bag.place(message));
    if (track.messages++ == 0) axis = robotAxis(imu.header.frame, robot, frames, notes);
    const double time = imu.header.time, rate = axis.dot(imu.rate), dt = time - lastTime;
    const bool first = track.messages == 1;
    if (!first && dt > 0) yaw += dt * (lastRate + rate) / 2;
    if (!first && dt > kImuGap) track.gapEnds.push_back(time);
    if (!track.poses.add(time, spatial({0, 0, wrapAngle(yaw)}))) {
      ++track.unordered;
      continue;
    }
    if (!isStated(imu.rateCovariance)) {
      ++track.uncertain;
    } else if (!first) {
      PoseWithCovariance step;
      step.covariance(2, 2) = axis.dot(imu.rateCovariance * axis) * dt * dt;
      track.steps.add(lastTime, time, step);
    }
    lastTime = time;
    lastRate = rate;
  }
  return track;
}

/// Motion from scan to scan, by the tracks' samples of these indices.
struct ScanInterval {
  std::size_t from = 0, to = 0;  ///< indices of the samples
  double begin = 0, end = 0;     ///< s
};

Pose2D motionOf(const MeasuredTrack& track, const ScanInterval& interval) {
  const auto& poses = track.poses.poses();
  return planar(poses[interval.from]->inverse() * *poses[interval.to]);
}

bool hasGap(const MeasuredTrack& track, const ScanInterval& interval) {
  const auto end = std::upper_bound(track.gapEnds.begin(), track.gapEnds.end(), interval.begin);
  return end != track.gapEnds.end() && *end <= interval.end;
}

PoseWithCovariance motionBetween(const MeasuredTrack& odometry,
                                 const std::optional<MeasuredTrack>& imu,
                                 const ScanInterval& interval) {
  PoseWithCovariance motion;
  motion.mean = motionOf(odometry, interval);
  const auto stated = odometry.steps.covarianceBetween(interval.begin, interval.end);
  motion.covariance = stated.value_or(assumedCovariance(motion.mean, kDefaultMotionNoise));
  if (imu && !hasGap(*imu, interval)) {
    const double yaw = motionOf(*imu, interval).yaw;
    // On an arc the chord points along the mean of both headings.
    const double turn = wrapAngle(yaw - motion.mean.yaw) / 2;
    motion.mean = compose({0, 0, turn}, {motion.mean.x, motion.mean.y, 0});
    motion.mean.yaw = yaw;
    const auto ofGyro = imu->steps.covarianceBetween(interval.begin, interval.end);
    const Eigen::Matrix3d byYaw =
        ofGyro.value_or(assumedCovariance({0, 0, yaw}, kDefaultMotionNoise));
    motion.covariance.row(2).setZero();
    motion.covariance.col(2).setZero();
    motion.covariance(2, 2) = byYaw(2, 2);
  }
  motion.covariance += floorCovariance();
  return motion;
}

}  // namespace

void FrameTree::add(const std::string& parent, const std::string& child,
                    const Eigen::Isometry3d& T_parent_child) {
  m_links.insert_or_assign(child, Link{parent, T_parent_child});
}

std::map<std::string, Eigen::Isometry3d> FrameTree::above(const std::string& frame) const {
  constexpr std::size_t kMostLinks = 1000;  // robots have some ten
  std::map<std::string, Eigen::Isometry3d> poses;
  std::string at = frame;
  Eigen::Isometry3d T_at_frame = Eigen::Isometry3d::Identity();
  while (poses.size() < kMostLinks && poses.emplace(at, T_at_frame).second) {  // ends in a circle
    const auto link = m_links.find(at);
    if (link == m_links.end()) break;
    T_at_frame = link->second.T_parent_child * T_at_frame;
    at = link->second.parent;
  }
  return poses;
}

std::optional<Eigen::Isometry3d> FrameTree::find(const std::string& base,
                                                 const std::string& frame) const {
  const auto aboveBase = above(base), aboveFrame = above(frame);
  // All common ancestors give the same pose.
  for (const auto& [name, T_common_frame] : aboveFrame)
    if (const auto common = aboveBase.find(name); common != aboveBase.end())
      return common->second.inverse() * T_common_frame;
  return std::nullopt;
}

void addRosbagMotions(const Bag& bag, std::size_t odometryTopic,
                      std::optional<std::size_t> imuTopic, const FrameTree& frames,
                      ScanFolder& folder) {
  const std::vector<double> times = timesOf(folder);
  std::string child;
  const MeasuredTrack odometry = readOdometry(bag, odometryTopic, times, child);
  noteTrack(bag.topics()[odometryTopic], odometry, folder.notes);
  requireOverlap(folder, odometry.poses, bag.path(), "odometry");
  requireVehicleFrame(odometry.poses, bag.path().string() + ": " + bag.topics()[odometryTopic].name,
                      true);
  std::optional<MeasuredTrack> imu;
  if (imuTopic) {
    imu = readImu(bag, *imuTopic, times, child, frames, folder.notes);
    noteTrack(bag.topics()[*imuTopic], *imu, folder.notes);
    requireOverlap(folder, imu->poses, bag.path(), "IMU");
  }
  std::vector<bool> keep(times.size());
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < times.size(); ++i) {
    keep[i] = odometry.poses.poses()[i] && (!imu || imu->poses.poses()[i]);
    if (!keep[i]) continue;
    if (last)
      folder.scans[i].motion = motionBetween(odometry, imu, {*last, i, times[*last], times[i]});
    last = i;
  }
  if (!last)
    throw Error(bag.path().string() + ": no scan has both odometry and IMU at its time: odometry " +
                odometry.poses.span() + ", IMU " + imu->poses.span() + "; leave --imu-topic out");
  keepScans(folder, keep, imu ? "at times without odometry or IMU" : "at times without odometry");
}

}  // namespace polemcl::io
