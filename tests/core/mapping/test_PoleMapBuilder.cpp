#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_pole_map_builder {
namespace {

using namespace polemcl::tests;

/// A scan at (x, 0) looking along x that sees poles at the given places of the map, without error.
MappingScan scanAt(double x, const std::vector<Eigen::Vector2d>& seen, std::uint32_t drive = 0) {
  MappingScan scan;
  scan.pose_map_robot = {x, 0, 0};
  scan.drive = drive;
  for (const Eigen::Vector2d& p : seen) scan.poles_robot.push_back(detectionAt(p.x() - x, p.y()));
  return scan;
}

/// One scan in the middle of each section of 1 m; `sees` has 'x' where it sees the pole, '.' where
/// it does not, and ' ' where the section has no scan.
std::vector<MappingScan> pattern(const std::string& sees) {
  std::vector<MappingScan> scans{scanAt(0, {})};  // makes the path start at a border
  for (std::size_t i = 0; i < sees.size(); ++i) {
    if (sees[i] == ' ') continue;
    scans.push_back(scanAt(0.5 + static_cast<double>(i), {}));
    if (sees[i] == 'x') scans.back() = scanAt(0.5 + static_cast<double>(i), {{10, 5}});
  }
  return scans;
}

PoleMapOptions sectionsOfOneMetre(int minCount, int maxGap) {
  PoleMapOptions options;
  options.sectionLength = 1;
  options.everyScan = false;
  options.counting = PoleCounting::run;
  options.minShare = 0;
  options.minCount = minCount;
  options.maxGap = maxGap;
  return options;
}

std::size_t polesOf(const std::string& sees, int minCount, int maxGap) {
  return buildPoleMap(pattern(sees), sectionsOfOneMetre(minCount, maxGap)).poles.size();
}

TEST(PoleMapBuilder, KeepsAPoleSeenOftenEnough) {
  EXPECT_EQ(polesOf("xxx", 3, 0), 1u);
  EXPECT_EQ(polesOf("xx.", 3, 0), 0u);
}

TEST(PoleMapBuilder, AGapUpToTheLargestContinuesTheRun) {
  EXPECT_EQ(polesOf("x..x..x", 3, 2), 1u);
  EXPECT_EQ(polesOf("x..x...x", 3, 2), 0u);
  EXPECT_EQ(polesOf("x.xx", 3, 0), 0u);
  EXPECT_EQ(polesOf("x.xx", 3, 1), 1u);
}

TEST(PoleMapBuilder, SectionsWithoutAScanNeitherCountNorBreak) {
  EXPECT_EQ(polesOf("x    x      x", 3, 0), 1u);
  EXPECT_EQ(polesOf("x  .    .x  x", 3, 2), 1u);
  EXPECT_EQ(polesOf("x  .    .  .x  x", 3, 2), 0u);
  EXPECT_EQ(polesOf("x         x", 3, 2), 0u);
}

TEST(PoleMapBuilder, OneRunMustSufficeByItself) {
  EXPECT_EQ(polesOf("xx......xx", 3, 2), 0u);
  for (const char* enough : {"xx......xxx", "xxx......xx"}) EXPECT_EQ(polesOf(enough, 3, 2), 1u);
  // All keyframes that saw it count for the pole itself, of whatever run.
  EXPECT_EQ(buildPoleMap(pattern("xx......xxx"), sectionsOfOneMetre(3, 2)).poles.at(0).count, 5u);
}

TEST(PoleMapBuilder, ARunDoesNotContinueInAnotherDrive) {
  std::vector<MappingScan> scans;
  for (double x : {0.5, 1.5}) scans.push_back(scanAt(x, {{10, 5}}, 0));
  for (double x : {0.5, 1.5}) scans.push_back(scanAt(x, {{10, 5}}, 1));
  EXPECT_TRUE(buildPoleMap(scans, sectionsOfOneMetre(3, 2)).poles.empty());
  scans.push_back(scanAt(2.5, {{10, 5}}, 1));
  const PoleMapResult result = buildPoleMap(scans, sectionsOfOneMetre(3, 2));
  ASSERT_EQ(result.poles.size(), 1u);
  EXPECT_EQ(result.poles[0].count, 5u);
}

TEST(PoleMapBuilder, TakesTheMiddleScanOfASection) {
  // Only the scan at 0.4 m counts among those at 0, 0.4 and 0.9 m; its pole is the map.
  const std::vector<MappingScan> scans{scanAt(0, {{5, 1}}), scanAt(0.4, {{5, 3}}),
                                       scanAt(0.9, {{5, 6}})};
  const PoleMapResult result = buildPoleMap(scans, sectionsOfOneMetre(1, 0));
  ASSERT_EQ(result.poles.size(), 1u);
  EXPECT_NEAR(result.poles[0].y, 3, 1e-12);
  EXPECT_EQ(result.keyframes, 1u);
  EXPECT_EQ(result.detections, 1u);
}

TEST(PoleMapBuilder, EveryScanIsAKeyframeButSectionsAreCounted) {
  std::vector<MappingScan> scans;  // 0 to 2.9 m: three sections
  for (int i = 0; i < 30; ++i) scans.push_back(scanAt(0.1 * i, {{5, 3}}));
  PoleMapOptions options = sectionsOfOneMetre(3, 0);
  options.everyScan = true;
  const PoleMapResult result = buildPoleMap(scans, options);
  ASSERT_EQ(result.poles.size(), 1u);
  EXPECT_EQ(result.poles[0].count, 30u);
  EXPECT_EQ(result.keyframes, 30u);
  options.minCount = 4;
  EXPECT_TRUE(buildPoleMap(scans, options).poles.empty());
}

TEST(PoleMapBuilder, AStandingVehicleCountsOnce) {
  std::vector<MappingScan> scans;
  for (int i = 0; i < 500; ++i) scans.push_back(scanAt(7 + 0.005 * (i % 2), {{10, 5}}));
  for (bool everyScan : {false, true}) {
    PoleMapOptions options = sectionsOfOneMetre(2, 2);
    options.everyScan = everyScan;
    EXPECT_TRUE(buildPoleMap(scans, options).poles.empty());
    EXPECT_EQ(buildPoleMap(scans, options).keyframes, everyScan ? 50u : 1u);
  }
}

TEST(PoleMapBuilder, MovesDetectionsByTheRobotsPose) {
  MappingScan scan;
  scan.pose_map_robot = {10, 20, M_PI / 2};
  PoleDetection pole;
  pole.x = 3;  // ahead, which is +y of the map
  pole.y = 1;  // left, which is -x
  pole.covariance << 0.04, 0, 0, 0.01;
  scan.poles_robot = {pole};
  PoleMapOptions options = sectionsOfOneMetre(1, 0);
  options.poseSigma = 0.1;
  options.headingSigma = 0.02;
  const PoleMapResult result = buildPoleMap({scan}, options);
  ASSERT_EQ(result.poles.size(), 1u);
  EXPECT_NEAR(result.poles[0].x, 9, 1e-9);
  EXPECT_NEAR(result.poles[0].y, 23, 1e-9);
  // Turned, plus 0.1² each, plus the swing of 0.02 rad at the offset (-1, 3): ±0.06 in x, ±0.02 in
  // y.
  const Eigen::Matrix2d& c = result.poles[0].covariance;
  EXPECT_NEAR(c(0, 0), 0.01 + 0.01 + 0.0036, 1e-6);
  EXPECT_NEAR(c(1, 1), 0.04 + 0.01 + 0.0004, 1e-6);
  EXPECT_NEAR(c(0, 1), 0.06 * 0.02, 1e-6);
}

TEST(PoleMapBuilder, LeavesDoubtfulDetectionsOut) {
  std::vector<MappingScan> scans = pattern("xxx");
  scans[2].poles_robot[0].confidence = 0.4;
  PoleMapOptions options = sectionsOfOneMetre(1, 2);
  options.minConfidence = 0.5;
  EXPECT_EQ(buildPoleMap(scans, options).poles.at(0).count, 2u);
  options.minConfidence = 0.4;
  EXPECT_EQ(buildPoleMap(scans, options).poles.at(0).count, 3u);
  scans[2].poles_robot[0].confidence = 0;
  options.minConfidence = 0;
  EXPECT_EQ(buildPoleMap(scans, options).poles.at(0).count, 2u);
}

// The pole stands at (10, 5): of sections with middles 0.5, 1.5, … those at 6.5 to 13.5 pass it
// nearer than 6.2 m.
TEST(PoleMapBuilder, WhoPassesAPoleMustSeeIt) {
  PoleMapOptions options = sectionsOfOneMetre(3, 30);
  options.nearRange = 6.2;
  const auto poles = [&](const std::string& sees, double share) {
    options.minShare = share;
    return buildPoleMap(pattern(sees), options).poles.size();
  };
  const std::string half = "......x.x.x.x......";  // 4 of the 8 near ones
  EXPECT_EQ(poles(half, 0), 1u);
  EXPECT_EQ(poles(half, 0.5), 1u);
  EXPECT_EQ(poles(half, 0.51), 0u);
  EXPECT_EQ(poles("xxxx................", 0.1), 0u) << "seen from afar only";
  EXPECT_EQ(poles("xxxx..", 1), 1u) << "nothing passes it";
}

// Sections nearer than half of near_range_m (12) do not count if all that saw the pole are farther:
// of the middles 0.5, 1.5, … those at 6.5 to 13.5 are nearer to (10, 5) than 6.2 m, ten others
// than 12.
TEST(PoleMapBuilder, WhoIsTooNearToSeeTheTopNeedNotSeeThePole) {
  PoleMapOptions options = sectionsOfOneMetre(3, 30);
  options.counting = PoleCounting::confidences;
  options.nearRange = 12;
  const auto poles = [&](const std::string& sees, double share) {
    options.minShare = share;
    return buildPoleMap(pattern(sees), options).poles.size();
  };
  EXPECT_EQ(poles("xxxxxx.......xxxxxxx", 1), 0u) << "6.5 is farther than 6 m, and missed it";
  EXPECT_EQ(poles("xxxxxxx......xxxxxxx", 1), 1u) << "the seven of the middle are nearer than 6 m";
  EXPECT_EQ(poles("xxxxxxx..x...xxxxxxx", 1), 0u) << "one of them saw it: all might have";
}

// The same scans with confidences: the sum counts.
TEST(PoleMapBuilder, SectionsCountByTheirConfidence) {
  PoleMapOptions options = sectionsOfOneMetre(1, 2);
  options.counting = PoleCounting::confidences;
  options.everyScan = true;
  std::vector<MappingScan> scans = pattern("xxxx");
  for (MappingScan& scan : scans)
    for (PoleDetection& pole : scan.poles_robot) pole.confidence = 0.6;
  MappingScan again = scans[2];  // two scans of one section: the greater confidence counts
  again.poles_robot[0].confidence = 0.5;
  scans.insert(scans.begin() + 3, again);
  const auto poles = [&](double count, double share) {
    options.minCount = count;
    options.minShare = share;
    return buildPoleMap(scans, options).poles.size();
  };
  EXPECT_EQ(poles(2.39, 0), 1u);
  EXPECT_EQ(poles(2.41, 0), 0u);
  EXPECT_EQ(poles(1, 0.59), 1u);
  EXPECT_EQ(poles(1, 0.61), 0u);
}

// 8 of the 22 sections of 1 m have a scan: that share of the count, but never 1.5 or less.
TEST(PoleMapBuilder, SparseScansNeedLess) {
  PoleMapOptions options = sectionsOfOneMetre(5, 2);
  options.counting = PoleCounting::confidences;
  const std::string twice = "x  x  .  .  .  .  .  .  ", once = "x  .  .  .  .  .  .  .  ";
  EXPECT_EQ(buildPoleMap(pattern(twice), options).poles.size(), 1u);
  EXPECT_EQ(buildPoleMap(pattern(once), options).poles.size(), 0u);
  options.minCount = 5.6;
  EXPECT_EQ(buildPoleMap(pattern(twice), options).poles.size(), 0u);
  options.minCount = 3;
  EXPECT_EQ(buildPoleMap(pattern(once), options).poles.size(), 0u) << "one scan is never enough";
  options.counting = PoleCounting::run;
  EXPECT_EQ(buildPoleMap(pattern(twice), options).poles.size(), 0u) << "the paper's count stays";
}

TEST(PoleMapBuilder, TellsWhatItDid) {
  const PoleMapResult result = buildPoleMap(pattern("x.   xx"), sectionsOfOneMetre(4, 2));
  EXPECT_TRUE(result.poles.empty());
  EXPECT_EQ(result.sections, 7u);
  EXPECT_EQ(result.occupiedSections, 4u);
  EXPECT_EQ(result.keyframes, 4u);
  EXPECT_EQ(result.detections, 3u);
  EXPECT_EQ(result.clusters, 1u);
  EXPECT_EQ(result.bestCount, 3);
  EXPECT_NEAR(result.pathLength, 6.5, 1e-9);
}

/// A street of 200 m up and down, poles on both sides, detections and poses with noise, clutter.
struct Street {
  std::vector<Eigen::Vector2d> truth;
  std::vector<MappingScan> scans;
};
Street noisyStreet(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Street street;
  for (int i = 0; i < 40; ++i)
    street.truth.emplace_back(5 * i + uniform(-1, 1), i % 2 ? 6.0 : -7.0);
  for (int k = 0; k < 800; ++k) {
    const bool back = k >= 400;
    const Pose2D at{back ? 400 - 0.5 * k : 0.5 * k, back ? 1.5 : -1.5, back ? M_PI : 0};
    MappingScan scan;
    scan.pose_map_robot = {at.x + 0.02 * normal(random), at.y + 0.02 * normal(random),
                           at.yaw + 0.002 * normal(random)};
    for (const Eigen::Vector2d& p : street.truth) {
      const Pose2D seen = relative(at, {p.x(), p.y(), 0});
      const double range = std::hypot(seen.x, seen.y);
      if (range > 30 || uniform(0, 1) < 0.3) continue;
      PoleDetection pole;
      const double sigma = 0.01 + 0.002 * range;
      pole.x = seen.x + sigma * normal(random);
      pole.y = seen.y + sigma * normal(random);
      pole.covariance = sigma * sigma * Eigen::Matrix2d::Identity();
      scan.poles_robot.push_back(pole);
    }
    PoleDetection clutter;
    clutter.x = uniform(-30, 30);
    clutter.y = uniform(-30, 30);
    scan.poles_robot.push_back(clutter);
    street.scans.push_back(scan);
  }
  return street;
}

TEST(PoleMapBuilder, MapsStreetsDrivenTwiceToTheCentimetre) {
  for (bool everyScan : {false, true}) {
    std::size_t all = 0;
    double squared = 0;  // in units of the covariances
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Street street = noisyStreet(seed);
      PoleMapOptions options;
      options.everyScan = everyScan;
      options.minCount = 3;
      options.minShare = 0;
      const PoleMapResult result = buildPoleMap(street.scans, options);
      std::size_t found = 0;
      double sum = 0;
      for (const MapPole& pole : result.poles) {
        for (const Eigen::Vector2d& p : street.truth) {
          const Eigen::Vector2d error = Eigen::Vector2d(pole.x, pole.y) - p;
          if (error.norm() > 0.2) continue;
          ++found;
          sum += error.norm();
          squared += error.dot(pole.covariance.inverse() * error);
        }
      }
      EXPECT_EQ(found, street.truth.size()) << "seed " << seed;
      EXPECT_LE(result.poles.size(), street.truth.size() + 2) << "seed " << seed;
      EXPECT_LT(sum / found, everyScan ? 0.006 : 0.011) << "seed " << seed;
      all += found;
    }
    // Chi-square with 1600 degrees of freedom, over its 800 poles: 2, and in 99 of 100 cases within
    // 2.58·sqrt(4/800).
    ASSERT_EQ(all, 800u);
    EXPECT_NEAR(squared / all, 2, 0.182);
  }
}

TEST(PoleMapBuilder, TheOrderOfDetectionsInAScanIsOfNoConsequence) {
  Street street = noisyStreet(2);
  const PoleMapResult expected = buildPoleMap(street.scans, {});
  std::mt19937_64 random(3);
  for (MappingScan& scan : street.scans)
    std::shuffle(scan.poles_robot.begin(), scan.poles_robot.end(), random);
  expectSame(buildPoleMap(street.scans, {}).poles, expected.poles);
}

TEST(PoleMapBuilder, NoScansNoMap) {
  const PoleMapResult result = buildPoleMap({}, {});
  EXPECT_TRUE(result.poles.empty());
  EXPECT_EQ(result.sections, 0u);
}

TEST(PoleMapBuilder, RefusesWhatIsNotFiniteAndSaysWhere) {
  const auto refuses = [](const std::vector<MappingScan>& scans, const std::string& what) {
    EXPECT_REFUSED(buildPoleMap(scans, {}), what);
  };
  auto scans = pattern("xxx");
  scans[1].pose_map_robot.yaw = std::nan("");
  refuses(scans, "pose of scan 1");
  scans = pattern("xxx");
  scans[2].poles_robot[0].x = std::numeric_limits<double>::infinity();
  refuses(scans, "pole 0 of scan 2");
  scans = pattern("xxx");
  scans[2].poles_robot[0].confidence = 2;
  refuses(scans, "pole 0 of scan 2");
  scans = pattern("xxx");
  scans[3].poles_robot[0].covariance << 0.01, 0.02, 0.02, 0.01;
  refuses(scans, "pole 0 of scan 3");
}

TEST(PoleMapBuilder, RefusesPlacesBeyondAllMaps) {
  auto scans = pattern("xxx");
  scans[1].pose_map_robot.x = -1.1e9;
  EXPECT_REFUSED(buildPoleMap(scans, {}), "pose of scan 1 is more than 1e9 m from the origin");
  scans = pattern("xxx");
  scans[2].poles_robot[0].y = 1e30;
  EXPECT_REFUSED(buildPoleMap(scans, {}), "pole 0 of scan 2 has a place more than 1e9 m away");
}

}  // namespace
}  // namespace polemcl::test_pole_map_builder
