// Sessions with erring poses are aligned to the map, piece by piece.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/mapping/SessionAlignment.h"
#include "support/Poles.h"

namespace polemcl::test_session_alignment {
namespace {

constexpr double kLength = 300;  // m of street

MapPole standing(double x, double y) {
  return tests::mapPoleAt(x, y, 1e-4);
}

/// A pole every 12 m on each side, not quite regular.
std::vector<MapPole> street() {
  std::vector<MapPole> poles;
  for (int i = 0; i < 25; ++i) {
    poles.push_back(standing(12 * i + std::sin(3 * i), 7 + std::cos(5 * i)));
    poles.push_back(standing(12 * i + 5 + std::cos(2 * i), -8 + std::sin(7 * i)));
  }
  return poles;
}

/// Poses along x, a scan each metre; each scan sees the poles within 20 m.
std::vector<SessionScan> driveThrough(const std::vector<MapPole>& poles) {
  std::mt19937 random(1);
  const auto noise = [&] { return 0.02 * (random() / 2147483648.0 - 1); };  // m, uniform
  std::vector<SessionScan> scans;
  for (int i = 0; i <= static_cast<int>(kLength); ++i) {
    SessionScan scan;
    scan.time = i;
    scan.pose_map_robot = {static_cast<double>(i), 0, 0.1};
    for (const MapPole& pole : poles) {
      if (std::hypot(pole.x - i, pole.y) > 20) continue;
      const Pose2D seen = relative(scan.pose_map_robot, {pole.x, pole.y, 0});
      PoleDetection detection;
      detection.x = seen.x + noise();
      detection.y = seen.y + noise();
      detection.covariance = Eigen::Matrix2d::Identity() * 4e-4;
      scan.poles_robot.push_back(detection);
    }
    scans.push_back(scan);
  }
  return scans;
}

/// Errors of 0.3 m and 0.5° that change over 100 m.
std::vector<SessionScan> erring(std::vector<SessionScan> scans) {
  for (SessionScan& scan : scans) {
    Pose2D& pose = scan.pose_map_robot;
    const double s = pose.x / 100;
    pose.x += 0.3 * std::cos(s);
    pose.y += 0.3 * std::sin(2 * s);
    pose.yaw += 0.0087 * std::cos(1.5 * s);
  }
  return scans;
}

struct Worst {
  double position = 0, heading = 0;
};

Worst worst(const std::vector<SessionScan>& a, const std::vector<SessionScan>& b, std::size_t from,
            std::size_t to) {
  Worst result;
  for (std::size_t i = from; i < to; ++i) {
    const Pose2D apart = relative(a[i].pose_map_robot, b[i].pose_map_robot);
    result.position = std::max(result.position, std::hypot(apart.x, apart.y));
    result.heading = std::max(result.heading, std::abs(apart.yaw));
  }
  return result;
}

std::vector<SessionScan> aligned(const std::vector<SessionScan>& scans,
                                 const std::vector<MapPole>& map,
                                 AlignmentSummary* summary = nullptr) {
  return alignedSession(scans, landmarksFrom(map), {}, {}, summary);
}

TEST(SessionAlignment, RemovesErrorsOfDecimetres) {
  const auto right = driveThrough(street()), wrong = erring(right);
  AlignmentSummary summary;
  const auto result = aligned(wrong, street(), &summary);
  EXPECT_GT(worst(right, wrong, 0, right.size()).position, 0.3);
  EXPECT_LT(worst(right, result, 0, right.size()).position, 0.04);
  EXPECT_LT(worst(right, result, 0, right.size()).heading, 0.003);
  EXPECT_EQ(summary.scans, right.size());
  EXPECT_NEAR(summary.largestShift, worst(right, wrong, 0, right.size()).position, 0.05);
}

TEST(SessionAlignment, TheFirstScanCounts) {
  const std::vector<SessionScan> right{driveThrough(street()).at(150)};
  std::vector<SessionScan> wrong = right;
  wrong[0].pose_map_robot.x += 0.3;
  EXPECT_LT(worst(right, aligned(wrong, street()), 0, 1).position, 0.05);
}

TEST(SessionAlignment, LeavesRightPosesWhereTheyAre) {
  const auto right = driveThrough(street());
  EXPECT_LT(worst(right, aligned(right, street()), 0, right.size()).position, 0.02);
}

// A third of the poles were set 0.4 m aside: they must not take the session with them.
TEST(SessionAlignment, MovedPolesDoNotMoveTheSession) {
  auto today = street();
  for (std::size_t i = 0; i < today.size(); i += 3) today[i].y += 0.4;
  const auto right = driveThrough(today);
  const auto result = aligned(erring(right), street());
  EXPECT_LT(worst(right, result, 0, right.size()).position, 0.06);
}

// Where the map has too few poles, the correction fades over 100 m.
TEST(SessionAlignment, WithoutEnoughPolesItFollowsTheNeighbours) {
  auto map = street();
  map.erase(std::remove_if(map.begin(), map.end(), [](const auto& p) { return p.x > 150; }),
            map.end());
  map.push_back(standing(290, 30.7));  // one pole cannot align anything
  const auto right = driveThrough(street()), wrong = erring(right);
  AlignmentSummary summary;
  const auto result = aligned(wrong, map, &summary);
  EXPECT_LT(worst(right, result, 0, 140).position, 0.04);
  EXPECT_LT(summary.scans, 200u);
  const auto correction = [&](std::size_t i) {
    return result[i].pose_map_robot.x - wrong[i].pose_map_robot.x;
  };
  ASSERT_GT(std::abs(correction(160)), 0.002);
  EXPECT_NEAR(correction(300) / correction(200), std::exp(-1), 0.02);
  for (std::size_t i = 1; i < result.size(); ++i)
    EXPECT_LT(std::abs(correction(i) - correction(i - 1)), 0.03) << i;
}

TEST(SessionAlignment, StandingStillCountsOnce) {
  auto right = driveThrough(street());
  right.insert(right.begin() + 150, 500, right[150]);
  right[400].poles_robot.clear();
  const auto result = aligned(erring(right), street());
  EXPECT_LT(worst(right, result, 0, right.size()).position, 0.04);
}

TEST(SessionAlignment, AnEmptySessionOrMapIsLeftAlone) {
  EXPECT_TRUE(aligned({}, street()).empty());
  const auto wrong = erring(driveThrough(street()));
  EXPECT_EQ(worst(wrong, aligned(wrong, {}), 0, wrong.size()).position, 0);
}

// In a map in which nothing changed, such a session must not move a pole.
TEST(SessionAlignment, ErringSessionsDoNotMoveThePoles) {
  const auto right = driveThrough(street());
  MapUpdateOptions options;
  MapUpdateCounts counts;
  LandmarkMap map = landmarksFrom(street());
  for (int session = 0; session < 3; ++session)
    map = updateMap(map, erring(right), {}, options, &counts);
  EXPECT_EQ(counts.moved, 0u);
  EXPECT_EQ(presentPoles(map).size(), street().size());
  EXPECT_EQ(counts.alignment.scans, right.size());
  options.alignSigma = 0;  // without the alignment they move or come twice
  updateMap(landmarksFrom(street()), erring(right), {}, options, &counts);
  EXPECT_GT(counts.moved + counts.entered + counts.left, 10u);
  EXPECT_EQ(counts.alignment.scans, 0u);
}

TEST(SessionAlignment, UncertainScansChangeNothing) {
  auto scans = driveThrough(street());
  for (SessionScan& scan : scans) scan.poseCovariance(1, 1) = 0.3 * 0.3;
  MapUpdateCounts counts;
  const LandmarkMap map = landmarksFrom(street());
  const LandmarkMap after = updateMap(map, scans, {}, {}, &counts);
  EXPECT_EQ(counts.uncertain, scans.size());
  EXPECT_EQ(counts.scans, 0u);
  ASSERT_EQ(after.poles.size(), map.poles.size());
  for (std::size_t i = 0; i < map.poles.size(); ++i) {
    EXPECT_EQ(after.poles[i].pole.x, map.poles[i].pole.x);
    EXPECT_EQ(after.poles[i].history.existence, map.poles[i].history.existence);
  }
}

// A pole pulled by a session whose poses are uncertain keeps more of its place.
TEST(SessionAlignment, UncertainPosesWeighLess) {
  auto map = street();
  map[20].y += 0.1;
  auto sure = driveThrough(street()), unsure = sure;
  for (SessionScan& scan : unsure) scan.poseCovariance.diagonal() << 0.04, 0.04, 1e-4;
  const auto placeAfter = [&](const std::vector<SessionScan>& scans) {
    for (const MapPole& pole : presentPoles(updateMap(landmarksFrom(map), scans, {}, {})))
      if (std::hypot(pole.x - map[20].x, pole.y - map[20].y) < 0.2) return pole.y - map[20].y;
    return 0.0;
  };
  EXPECT_LT(placeAfter(sure), 1.3 * placeAfter(unsure));
  EXPECT_LT(placeAfter(sure), -0.01);
  SessionScan broken = sure[0];
  broken.poseCovariance(0, 0) = -1;
  EXPECT_THROW(updateMap(landmarksFrom(map), {broken}, {}, {}), Error);
}

}  // namespace
}  // namespace polemcl::test_session_alignment
