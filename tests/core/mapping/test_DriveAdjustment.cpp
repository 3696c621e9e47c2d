#include <gtest/gtest.h>

#include <cmath>

#include "core/mapping/DriveAdjustment.h"
#include "support/PoleStreet.h"
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_drive_adjustment {
namespace {
using tests::Dice;

/// 400 m of street, an odometry that reads 2 % too much, poses to start from that wander by
/// decimetres, and an inventory: poles off by 0.3 to 1 m, some missing, some that do not exist.
struct Drive {
  explicit Drive(std::uint64_t seed = 3) {
    tests::StreetOptions options;
    options.scans = 800;
    options.detection = 0.03;
    options.odometry = 0.01;
    options.unmapped = 0.2;
    options.seed = seed;
    const tests::PoleStreet street = tests::makeStreet(options);
    truth = street.truth;
    Dice dice(seed + 100);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double way = 0.5 * static_cast<double>(i);
      const Pose2D wrong{0.2 * std::sin(way / 15), 0.2 * std::cos(way / 19),
                         0.004 * std::sin(way / 11)};
      DrivenScan scan{{truth[i].x + wrong.x, truth[i].y + wrong.y, truth[i].yaw + wrong.yaw},
                      street.frames[i].poles_robot,
                      {}};
      for (PoleDetection& pole : scan.poles_robot)
        pole.covariance = Eigen::Matrix2d::Identity() * 9e-4;
      PoseWithCovariance motion = *street.frames[i].motion;
      motion.mean.x *= 1.02;
      motion.mean.y *= 1.02;
      if (i > 0) scan.motion = PoseWithCovariance{motion.mean, motion.covariance};
      scans.push_back(scan);
    }
    exact = street.map->poles();
    for (MapPole pole : exact) {
      const double direction = dice.uniform(0, 2 * M_PI), distance = dice.uniform(0.3, 1);
      pole.x += distance * std::cos(direction);
      pole.y += distance * std::sin(direction);
      pole.covariance = Eigen::Matrix2d::Identity() * 0.25;
      inventory.push_back(pole);
      if (dice.uniform() > 0.1) continue;
      pole.x += dice.uniform(-10, 10);
      pole.y += dice.uniform(-10, 10);
      inventory.push_back(pole);
    }
  }
  AdjustedDrives adjust() const { return adjustDrives(scans, inventory, DriveAdjustmentOptions()); }
  double error(const Pose2D& pose, std::size_t i) const {
    return std::hypot(pose.x - truth[i].x, pose.y - truth[i].y);
  }
  std::vector<Pose2D> truth;
  std::vector<DrivenScan> scans;
  std::vector<MapPole> exact, inventory;
};

/// Greatest difference between the way of 40 m from a scan on and the true one.
double worstWay(const std::vector<Pose2D>& poses, const std::vector<Pose2D>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i + 80 < poses.size(); ++i) {
    const Pose2D way = relative(poses[i], poses[i + 80]), right = relative(truth[i], truth[i + 80]);
    worst = std::max(worst, std::hypot(way.x - right.x, way.y - right.y));
  }
  return worst;
}

TEST(DriveAdjustment, ShapeOfTheLidarPlaceOfTheInventory) {
  for (const std::uint64_t seed : {3u, 4u, 5u}) {
    SCOPED_TRACE(seed);
    const Drive drive(seed);
    const AdjustedDrives adjusted = drive.adjust();
    ASSERT_EQ(adjusted.poses_map_robot.size(), drive.scans.size());
    double before = 0, after = 0;
    std::vector<Pose2D> start;
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      start.push_back(drive.scans[i].pose_map_robot);
      before += drive.error(start[i], i) / static_cast<double>(drive.scans.size());
      after +=
          drive.error(adjusted.poses_map_robot[i], i) / static_cast<double>(drive.scans.size());
    }
    EXPECT_GT(before, 0.18);
    EXPECT_LT(after, 3 * adjusted.sigma);
    EXPECT_LT(adjusted.sigma, 0.2);
    EXPECT_GT(adjusted.sigma, 0.03) << "the inventory's part does not average out";
    EXPECT_GT(worstWay(start, drive.truth), 0.3);
    EXPECT_LT(worstWay(adjusted.poses_map_robot, drive.truth), 0.1);
    EXPECT_NEAR(adjusted.anchorDistance, 0.68, 0.15);  // rms of 0.3 to 1 m
  }
}

TEST(DriveAdjustment, TwoDrivesGetOneShape) {
  Drive drive;
  const std::size_t count = drive.scans.size();
  for (std::size_t i = 0; i < count; ++i) {
    DrivenScan again = drive.scans[i];  // the same way, from other poses
    again.pose_map_robot.x -= 0.3;
    if (i == 0) again.motion.reset();
    drive.scans.push_back(again);
  }
  const AdjustedDrives adjusted = drive.adjust();
  for (std::size_t i = 0; i < count; i += 50) {
    const Pose2D &a = adjusted.poses_map_robot[i], &b = adjusted.poses_map_robot[count + i];
    EXPECT_LT(std::hypot(a.x - b.x, a.y - b.y), 0.03) << i;
  }
}

TEST(DriveAdjustment, ExactPolesPullThePosesToTheirPlace) {
  Drive drive;
  drive.inventory = drive.exact;
  for (MapPole& pole : drive.inventory) pole.covariance.setZero();
  const AdjustedDrives adjusted = drive.adjust();
  for (std::size_t i = 0; i < drive.truth.size(); i += 10)
    EXPECT_LT(drive.error(adjusted.poses_map_robot[i], i), 0.03) << i;
  EXPECT_LT(adjusted.sigma, 0.03);
}

// LiDAR and odometry make one rigid body of the drive; eight poles, known to 0.5 m, hold it: its
// middle to 0.5 m / sqrt(8) along an axis, its heading to 0.5 m / sqrt(1800 m^2), the sum of their
// squared distances from the middle. From there, the squared distance of the poses is 10 m^2.
TEST(DriveAdjustment, SigmaIsThatOfAnAxis) {
  std::vector<MapPole> map;
  for (const double x : {-10, 0, 10, 20})
    for (const double y : {-10, 10}) map.push_back(tests::mapPoleAt(x, y, 0.25));
  std::vector<DrivenScan> scans;
  for (int i = 0; i <= 10; ++i) {
    DrivenScan scan{{1.0 * i, 0, 0}, {}, {}};
    for (const MapPole& pole : map)
      scan.poles_robot.push_back(tests::detectionAt(pole.x - i, pole.y, 1e-4));
    if (i > 0) scan.motion = PoseWithCovariance{{1, 0, 0}, 1e-6 * Eigen::Matrix3d::Identity()};
    scans.push_back(scan);
  }
  const AdjustedDrives adjusted = adjustDrives(scans, map, DriveAdjustmentOptions());
  ASSERT_EQ(adjusted.anchors.size(), 8u);
  EXPECT_NEAR(adjusted.anchorDistance, 0, 1e-3);
  EXPECT_NEAR(adjusted.sigma, 0.5 * std::sqrt(1 / 8. + 10 / 1800. / 2), 0.005);
}

TEST(DriveAdjustment, NeedsPolesOfTheMap) {
  Drive drive;
  for (MapPole& pole : drive.inventory) pole.x += 500;
  EXPECT_REFUSED(drive.adjust(), "stand near one of the map; 3 are needed");
}

}  // namespace
}  // namespace polemcl::test_drive_adjustment
