#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/common/Transform.h"
#include "core/slam/DriveMapping.h"
#include "support/PoleStreet.h"
#include "support/Refusal.h"

namespace polemcl::test_drive_mapping {
namespace {
using tests::Dice;

constexpr double kStep = 0.5;        // m
constexpr double kRange = 25;        // m
constexpr double kDetection = 0.03;  // m

/// A drive with an odometry that reads 1 % too much, turns 0.01 deg/m too far and has noise of 2 %.
struct Drive {
  /// \param turn Curvature by the way, rad/m.
  Drive(double length, const std::function<double(double)>& turn,
        const std::vector<Eigen::Vector2d>& poles, std::uint64_t seed, Pose2D pose = {}) {
    Dice dice(seed);
    for (std::size_t i = 0; kStep * static_cast<double>(i) < length; ++i) {
      const Pose2D motion{kStep, 0, turn(kStep * static_cast<double>(i)) * kStep};
      if (i > 0) pose = compose(pose, motion);
      truth.push_back(pose);
      scans.push_back({{}, seen(pose, poles, dice), {}});
      if (i > 0) scans.back().motion = read(motion, dice);
    }
  }
  static std::vector<PoleDetection> seen(const Pose2D& pose,
                                         const std::vector<Eigen::Vector2d>& poles, Dice& dice) {
    std::vector<PoleDetection> detections;
    for (const Eigen::Vector2d& pole : poles) {
      const Pose2D at = relative(pose, {pole.x(), pole.y(), 0});
      if (std::hypot(at.x, at.y) > kRange || dice.uniform() < 0.2) continue;
      PoleDetection detection;
      detection.x = at.x + kDetection * dice.normal();
      detection.y = at.y + kDetection * dice.normal();
      detection.radius = 0.1;
      detection.confidence = 0.9;
      detection.covariance = Eigen::Matrix2d::Identity() * kDetection * kDetection;
      detections.push_back(detection);
    }
    return detections;
  }
  static PoseWithCovariance read(const Pose2D& motion, Dice& dice) {
    const Eigen::Vector3d sigma(0.02 * kStep, 0.001, 0.0005);
    return {{1.01 * motion.x + sigma.x() * dice.normal(), sigma.y() * dice.normal(),
             motion.yaw + 0.01 * M_PI / 180 * kStep + sigma.z() * dice.normal()},
            sigma.cwiseAbs2().asDiagonal()};
  }
  /// Greatest error of a position after the best rigid motion.
  double worst(const std::vector<Pose2D>& poses) const {
    Eigen::Matrix2Xd found(2, poses.size()), right(2, poses.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      found.col(static_cast<Eigen::Index>(i)) = centreOf(poses[i]);
      right.col(static_cast<Eigen::Index>(i)) = centreOf(truth[i]);
    }
    const Eigen::Matrix3d motion = Eigen::umeyama(found, right, false);
    return ((motion * found.colwise().homogeneous()).topRows<2>() - right)
        .colwise()
        .norm()
        .maxCoeff();
  }
  double worst(const MappedDrives& mapped) const {
    std::vector<Pose2D> poses;
    for (const PoseWithCovariance& pose : mapped.poses) poses.push_back(pose.mean);
    return worst(poses);
  }
  double worstOfOdometry() const {
    std::vector<Pose2D> poses;
    for (const DrivenScan& scan : scans)
      poses.push_back(scan.motion ? compose(poses.back(), scan.motion->mean) : Pose2D());
    return worst(poses);
  }
  std::vector<Pose2D> truth;
  std::vector<DrivenScan> scans;
};

/// Once a scan: 1.5 m of noise, 3 m that last, and every tenth one is 40 m off.
std::vector<DriveFix> fixesOf(const Drive& drive, const Eigen::Vector2d& antenna,
                              std::size_t firstScan, Dice& dice) {
  std::vector<DriveFix> fixes;
  Eigen::Vector2d lasting(3 * dice.normal(), 3 * dice.normal());
  for (std::size_t i = 0; i + 1 < drive.truth.size(); ++i) {
    const Pose2D &a = drive.truth[i], &b = drive.truth[i + 1];
    DriveFix fix;
    fix.time = static_cast<double>(firstScan + i);
    fix.scan = firstScan + i;
    fix.share = 0.5;
    fix.sigma = 1.5;
    fix.antenna_robot = antenna;
    const double kept = std::exp(-1.0 / 200), fresh = 3 * std::sqrt(1 - kept * kept);
    lasting = kept * lasting + fresh * Eigen::Vector2d(dice.normal(), dice.normal());
    fix.position = 0.5 * (centreOf(a) + centreOf(b)) + rotationOf(a.yaw) * antenna + lasting +
                   1.5 * Eigen::Vector2d(dice.normal(), dice.normal());
    if (i % 10 == 5) fix.position.x() += 40;
    fixes.push_back(fix);
  }
  return fixes;
}

MappedDrives map(const std::vector<Drive>& drives, std::size_t knownScans = 0,
                 std::vector<DriveFix> fixes = {},
                 std::vector<Eigen::Matrix3d> knownCovariances = {}) {
  DrivesToMap job;
  job.knownCovariances = std::move(knownCovariances);
  job.fixes = std::move(fixes);
  for (const Drive& drive : drives) {
    job.scans.insert(job.scans.end(), drive.scans.begin(), drive.scans.end());
    job.names.push_back("drive " + std::to_string(job.names.size()));
  }
  job.known = knownScans;
  return mapDrives(std::move(job), {});
}

/// All poses of the drives, one behind the other.
Drive joined(std::vector<Drive> drives) {
  for (std::size_t i = 1; i < drives.size(); ++i)
    drives[0].truth.insert(drives[0].truth.end(), drives[i].truth.begin(), drives[i].truth.end());
  return drives[0];
}

std::function<double(double)> ring(double radius) {
  return [radius](double) { return 1 / radius; };
}
double straight(double) {
  return 0;
}

/// A ring road of this radius; poles on both sides about every 15 m.
std::vector<Eigen::Vector2d> ringPoles(double radius, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Eigen::Vector2d> poles;
  for (double way = 0; way < 2 * M_PI * radius; way += dice.uniform(5, 10)) {
    const double out = radius + (dice.uniform() < 0.5 ? -1 : 1) * dice.uniform(4, 10);
    const double angle = way / radius;
    poles.emplace_back(out * std::sin(angle), radius - out * std::cos(angle));
  }
  return poles;
}

Drive ringDrive(std::uint64_t seed) {
  return {560, ring(70), ringPoles(70, seed + 50), seed};  // 1.27 times round
}

/// Lamps opposite each other, every 25 m: each place looks like the next.
std::vector<Eigen::Vector2d> evenPoles(double length) {
  std::vector<Eigen::Vector2d> poles;
  for (double way = 0; way < length + kRange; way += 25)
    for (const double side : {-6.0, 6.0}) poles.emplace_back(way, side);
  return poles;
}

TEST(DriveMapping, ClosesTheLoopOfARingRoad) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    const Drive drive = ringDrive(seed);
    const MappedDrives mapped = map({drive});
    ASSERT_EQ(mapped.poses.size(), drive.scans.size());
    EXPECT_GT(drive.worstOfOdometry(), 2);
    EXPECT_LT(drive.worst(mapped), 0.15);
    EXPECT_GE(mapped.loops.size(), 4u);
    for (const ClosedLoop& loop : mapped.loops) {
      const Pose2D &a = drive.truth[loop.first], &b = drive.truth[loop.second];
      EXPECT_LT(std::hypot(a.x - b.x, a.y - b.y), 60) << "a place passed twice";
    }
    // Noise of the odometry adds up as well.
    EXPECT_NEAR(mapped.odometry.at(0).x(), 1 / 1.01 - 1, 0.002);
    EXPECT_NEAR(mapped.odometry.at(0).y(), -0.01 * M_PI / 180, 1e-4);
  }
}

TEST(DriveMapping, SigmasFitTheErrors) {
  double sum = 0;
  int count = 0;
  for (const std::uint64_t seed : {11u, 12u, 13u, 14u, 15u, 16u}) {
    const Drive drive = ringDrive(seed);
    const MappedDrives mapped = map({drive});
    for (std::size_t i = 100; i < drive.truth.size(); i += 100, ++count) {
      const Pose2D &right = drive.truth[i], &found = mapped.poses[i].mean;
      const Eigen::Vector3d error(found.x - right.x, found.y - right.y,
                                  wrapAngle(found.yaw - right.yaw));
      sum += error.dot(mapped.poses[i].covariance.inverse() * error);
    }
  }
  EXPECT_GT(sum / count, 1);
  EXPECT_LT(sum / count, 5) << "3 is expected";
}

TEST(DriveMapping, PlacesThatLookAlikeAreNoLoop) {
  const Drive drive(600, straight, evenPoles(600), 5);
  const MappedDrives mapped = map({drive});
  EXPECT_EQ(mapped.loops.size(), 0u);
  EXPECT_GT(drive.worstOfOdometry(), 5);
  EXPECT_LT(drive.worst(mapped), 1);
}

/// There and back: only what the drive knows of itself tells one lamp from the next.
TEST(DriveMapping, ItsOwnCovarianceDecidesBetweenPlacesThatLookAlike) {
  const auto turn = [](double way) { return way > 200 && way < 220 ? M_PI / 20 : 0; };
  const Drive drive(400, turn, evenPoles(200), 6);
  const MappedDrives mapped = map({drive});
  EXPECT_GE(mapped.loops.size(), 2u);
  EXPECT_LT(drive.worst(mapped), 0.5);
}

/// Four blocks, each the one before turned by a quarter: the first three corners lead to nothing
/// new, and the drive ends before it comes round.
TEST(DriveMapping, EqualBlocksAreNoLoop) {
  Dice dice(8);
  const double radius = 60, block = M_PI / 2 * radius;
  std::vector<Eigen::Vector2d> poles;
  for (double way = 0; way < block - 5; way += dice.uniform(5, 10)) {
    const double out = radius + (dice.uniform() < 0.5 ? -1 : 1) * dice.uniform(4, 10);
    for (int corner = 0; corner < 4; ++corner) {
      const double angle = way / radius + corner * M_PI / 2;
      poles.emplace_back(out * std::sin(angle), radius - out * std::cos(angle));
    }
  }
  const Drive drive(4 * block - 60, ring(radius), poles, 8);
  const MappedDrives mapped = map({drive});
  EXPECT_EQ(mapped.loops.size(), 0u);
  EXPECT_LT(drive.worst(mapped), 0.5);
}

TEST(DriveMapping, BeginsAtTheFirstScanAndIsTheSameEachTime) {
  const Drive drive = ringDrive(4);
  const MappedDrives a = map({drive}), b = map({drive});
  EXPECT_NEAR(a.poses.front().mean.x, 0, 1e-6);
  EXPECT_NEAR(a.poses.front().mean.yaw, 0, 1e-6);
  EXPECT_LT(a.poses.front().covariance.trace(), 1e-6);
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_EQ(a.poses[i].mean.x, b.poses[i].mean.x);
    EXPECT_EQ(a.poses[i].covariance, b.poses[i].covariance);
  }
}

/// Arcs of a ring road, in any order and direction: the second shares places only with the third.
TEST(DriveMapping, ConnectsDrives) {
  const auto poles = ringPoles(70, 61);
  const auto at = [](double way) {
    return Pose2D{70 * std::sin(way / 70), 70 - 70 * std::cos(way / 70), way / 70};
  };
  Pose2D end = at(400);
  end.yaw += M_PI;
  const std::vector<Drive> drives{{140, ring(70), poles, 1, at(0)},
                                  {140, ring(70), poles, 2, at(220)},
                                  {400, ring(-70), poles, 3, end}};
  const MappedDrives mapped = map(drives);
  EXPECT_GE(mapped.loops.size(), 8u);
  EXPECT_LT(joined(drives).worst(mapped), 0.25);
  EXPECT_NEAR(mapped.driven, 680, 2);
  ASSERT_EQ(mapped.odometry.size(), 3u);
  EXPECT_NEAR(mapped.poses.front().mean.x, 0, 1e-6) << "the frame of the first scan";
}

TEST(DriveMapping, RefusesDrivesOfDifferentPlaces) {
  EXPECT_REFUSED(map({ringDrive(1), ringDrive(2)}), "drive 1: none of its places was found");
}

/// A drive round a ring in UTM, with poses that are known.
Drive knownRing(const std::vector<Eigen::Vector2d>& poles, const Pose2D& start,
                double length = 440) {
  Drive drive(length, ring(70), poles, 5, start);
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    drive.scans[i].pose_map_robot = drive.truth[i];
    if (i > 0)
      drive.scans[i].motion = PoseWithCovariance{relative(drive.truth[i - 1], drive.truth[i]),
                                                 1e-6 * Eigen::Matrix3d::Identity()};
  }
  return drive;
}

/// Known poses of a drive stay, and another drive finds its place among them. Its poses are as
/// uncertain as those that it is added to, and more.
TEST(DriveMapping, AddsADriveToPosesThatAreKnown) {
  const auto poles = ringPoles(70, 71);
  const Pose2D start{300000, 5000000, 3.1};
  std::vector<Eigen::Vector2d> moved;
  for (const Eigen::Vector2d& pole : poles)
    moved.push_back(centreOf(compose(start, {pole.x(), pole.y(), 0})));
  const Drive before = knownRing(moved, start);
  const Drive added(200, ring(70), moved, 6, compose(start, {70, 70, M_PI / 2}));
  const MappedDrives mapped = map({before, added}, before.scans.size());
  for (std::size_t i = 0; i < before.truth.size() + added.truth.size(); ++i) {
    const bool known = i < before.truth.size();
    const Pose2D& truth = known ? before.truth[i] : added.truth[i - before.truth.size()];
    const Pose2D& found = mapped.poses[i].mean;
    ASSERT_LT(std::hypot(found.x - truth.x, found.y - truth.y), known ? 0.03 : 0.08) << i;
    ASSERT_NEAR(wrapAngle(found.yaw - truth.yaw), 0, 0.003) << i;
  }

  std::vector<Eigen::Matrix3d> known;  // grow along the drive
  for (std::size_t i = 0; i < before.truth.size(); ++i)
    known.emplace_back(1e-4 * static_cast<double>(i + 1) * Eigen::Matrix3d::Identity());
  const MappedDrives bent = map({before, added}, known.size(), {}, known);
  for (std::size_t i = 0; i < bent.poses.size(); ++i) {
    const bool first = i < before.truth.size();
    // The added drive begins a quarter of the ring behind the other: 220 scans.
    const double expected = first ? 0 : 1e-4 * (220 + static_cast<double>(i - known.size()));
    const Eigen::Matrix3d more = bent.poses[i].covariance - mapped.poses[i].covariance;
    ASSERT_LT((more - expected * Eigen::Matrix3d::Identity()).norm(), 5e-4) << i;
  }
}

TEST(DriveMapping, LoopsOfKnownDrivesAreNotNew) {
  const auto poles = ringPoles(70, 71);
  const Drive before = knownRing(poles, {}, 560);
  const MappedDrives mapped = map({before, Drive(200, ring(70), poles, 6)}, before.scans.size());
  std::size_t closed = 0;  // by the added drive
  for (const ClosedLoop& loop : mapped.loops) closed += loop.second >= before.scans.size() ? 1 : 0;
  EXPECT_GT(closed, 0u);
  EXPECT_LT(closed, mapped.loops.size()) << "1.27 times round, the ring closes loops of its own";
  EXPECT_EQ(mapped.newLoops(), closed);
}

/// Drives that pass no place again: satellites say where they are, and keep them from bending.
TEST(DriveMapping, PositionsFromSatellitesPlaceADrive) {
  double shape = 0, nees = 0;
  for (const std::uint64_t seed : {3u, 4u, 5u, 6u}) {
    Dice dice(seed + 90);
    const Pose2D start{500, -200, 2};
    std::vector<Eigen::Vector2d> poles;
    for (double way = -20; way < 820; way += dice.uniform(5, 10))
      poles.push_back(centreOf(
          compose(start, {way, (dice.uniform() < 0.5 ? -1 : 1) * dice.uniform(4, 10), 0})));
    const Drive drive(800, straight, poles, seed, start);
    const MappedDrives found = map({drive}, 0, fixesOf(drive, {0.5, -0.3}, 0, dice));
    ASSERT_EQ(found.fixes.size(), 1u);
    EXPECT_EQ(found.fixes[0].given, drive.truth.size() - 1);
    // Each tenth is 40 m off, and one of a hundred is beyond three sigmas.
    EXPECT_NEAR(static_cast<double>(found.fixes[0].fitting),
                0.9 * 0.989 * static_cast<double>(found.fixes[0].given), 30);
    EXPECT_LT(found.fixes[0].distance, 6);
    shape += drive.worst(found) / 4;
    for (std::size_t i = 0; i < drive.truth.size(); ++i) {
      const Pose2D &right = drive.truth[i], &pose = found.poses[i].mean;
      const Eigen::Vector3d error(pose.x - right.x, pose.y - right.y,
                                  wrapAngle(pose.yaw - right.yaw));
      ASSERT_LT(error.head<2>().norm(), 5) << i;
      nees += error.dot(found.poses[i].covariance.inverse() * error) /
              static_cast<double>(4 * drive.truth.size());
    }
  }
  EXPECT_GT(nees, 1.5);
  EXPECT_LT(nees, 6) << "3 is expected";
  EXPECT_LT(shape, 1) << "a third of what the fixes are off";
}

TEST(DriveMapping, PositionsFromSatellitesConnectDrivesOfDifferentPlaces) {
  Dice dice(92);
  const Drive a = ringDrive(1), b = ringDrive(2);
  auto fixes = fixesOf(a, {0, 0}, 0, dice);
  EXPECT_REFUSED(map({a, b}, 0, fixes), "drive 1: none of its places was found");
  for (const DriveFix& fix : fixesOf(b, {0, 0}, a.truth.size(), dice)) fixes.push_back(fix);
  EXPECT_LT(joined({a, b}).worst(map({a, b}, 0, fixes)), 8);
}

TEST(DriveMapping, NeedsPoles) {
  const Drive none(50, straight, {}, 1), one(50, straight, {{20, 5}}, 1);
  EXPECT_REFUSED(map({none}), "only 0 poles", "2 are needed");
  EXPECT_REFUSED(map({one}), "only 1 poles", "2 are needed");
}

}  // namespace
}  // namespace polemcl::test_drive_mapping
