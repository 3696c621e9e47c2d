#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/global_localization/GlobalLocalizer.h"
#include "support/PoleCity.h"
#include "support/Refusal.h"

namespace polemcl::test_global_localizer {
namespace {

using tests::CityOptions;
using tests::DriveOptions;
using tests::Frame;
using tests::PoleCity;

CityOptions city(std::uint64_t seed) {
  CityOptions options;
  options.seed = seed;
  return options;
}

CityOptions regularCity(std::uint64_t seed) {
  CityOptions options = city(seed);
  options.regular = true;
  return options;
}

struct Drive {
  std::vector<Frame> frames;
  LocalSubmap submap;
  const Pose2D& truth() const { return frames.back().truth; }
};

Drive driveFrom(const PoleCity& city, std::uint64_t seed, double metres,
                const DriveOptions& options = {}) {
  sim::Random random(seed);
  Drive drive;
  drive.frames = tests::drive(city.surroundings(), city.randomWay(random, metres), options, random);
  for (const Frame& frame : drive.frames) drive.submap.add(frame.motion, frame.poles_robot);
  return drive;
}

bool isRight(const Pose2D& pose, const Pose2D& truth) {
  return std::hypot(pose.x - truth.x, pose.y - truth.y) <= 0.5 &&
         std::abs(wrapAngle(pose.yaw - truth.yaw)) <= 2 * M_PI / 180;
}

/// The map of the city, and the same 5 km east of it.
std::vector<MapPole> mapTwice(const PoleCity& world) {
  std::vector<MapPole> map = world.map();
  const std::size_t half = map.size();
  for (std::size_t i = 0; i < half; ++i) {
    map.push_back(map[i]);
    map.back().x += 5000;
  }
  return map;
}

struct Count {
  int right = 0, wrong = 0, undecided = 0;
  Count& operator+=(const Count& other) {
    right += other.right;
    wrong += other.wrong;
    undecided += other.undecided;
    return *this;
  }
};

/// One start: drives on until the verdict is resolved or the way ends; asked every five metres.
void start(const GlobalLocalizer& localizer, const std::vector<Frame>& frames, Count& count) {
  LocalSubmap submap;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    submap.add(frames[i].motion, frames[i].poles_robot);
    if (i < 5 || i % 5 != 0) continue;
    const GlobalResult result = localizer.localize(submap);
    if (result.verdict != GlobalVerdict::resolved) continue;
    const bool right = isRight(result.hypotheses[0].pose_map_robot, frames[i].truth);
    ++(right ? count.right : count.wrong);
    return;
  }
  ++count.undecided;
}

Count starts(const CityOptions& options, int count, const DriveOptions& driveOptions = {},
             const GlobalOptions& globalOptions = {}) {
  const PoleCity world(options);
  const GlobalLocalizer localizer(world.map(), globalOptions);
  sim::Random random(sim::hash(options.seed, 77));
  Count result;
  for (int i = 0; i < count; ++i)
    start(localizer,
          tests::drive(world.surroundings(), world.randomWay(random, 60), driveOptions, random),
          result);
  return result;
}

/// Read from the XML report for share/reports/BENCHMARK.md.
void record(const Count& count) {
  testing::Test::RecordProperty("right", count.right);
  testing::Test::RecordProperty("wrong", count.wrong);
  testing::Test::RecordProperty("undecided", count.undecided);
}

/// Worlds that no setting was chosen on: 1001 to 1004.
TEST(GlobalLocalizer, FindsTheRobotFromAnywhere) {
  Count sum;
  for (std::uint64_t seed = 1001; seed <= 1004; ++seed) {
    sum += starts(city(seed), 50);
  }
  EXPECT_GE(sum.right, 196);
  EXPECT_LE(sum.wrong, 1);
  record(sum);
}

TEST(GlobalLocalizer, StaysAmbiguousWhereEverythingLooksTheSame) {
  for (std::uint64_t seed : {1011, 1012}) {
    const PoleCity world(regularCity(seed));
    const GlobalLocalizer localizer(world.map());
    for (std::uint64_t i = 0; i < 10; ++i) {
      const Drive drive = driveFrom(world, 100 * seed + i, 60);
      const GlobalResult result = localizer.localize(drive.submap);
      EXPECT_EQ(result.verdict, GlobalVerdict::ambiguous);
      EXPECT_EQ(result.reason, GlobalReason::rivals);
      EXPECT_GT(result.hypotheses.size(), 1u);
    }
  }
}

/// Hardly a pattern at all: lamps every 25 m, a few centimetres out of line.
TEST(GlobalLocalizer, IsNotWrongWhereLittleTellsPlacesApart) {
  Count sum;
  for (double jitter : {0.03, 0.06, 0.12}) {
    CityOptions options = regularCity(1021);
    options.regularJitter = jitter;
    sum += starts(options, 15);
  }
  record(sum);
  EXPECT_EQ(sum.wrong, 0);
  EXPECT_GT(sum.right, 5);
}

/// Rows of trees: all places alike, but for the radii.
TEST(GlobalLocalizer, TellsRegularRowsApartByRadii) {
  CityOptions options = regularCity(1023);
  options.radiusSpread = 0.2;
  const Count compared = starts(options, 20);
  record(compared);
  EXPECT_EQ(compared.wrong, 0);
  EXPECT_GE(compared.right, 10);
  GlobalOptions anyRadius;
  anyRadius.radiusSigma = 1e6;
  EXPECT_EQ(starts(options, 20, {}, anyRadius).undecided, 20);
}

TEST(GlobalLocalizer, TakesAMapWithoutRadii) {
  CityOptions options = city(1024);
  options.radiusSpread = 0.2;
  const PoleCity world(options);
  std::vector<MapPole> map = world.map();
  for (MapPole& pole : map) pole.radius = 0;
  GlobalOptions anyRadius;
  anyRadius.radiusSigma = 1e6;
  const Drive drive = driveFrom(world, 1, 60);
  const GlobalResult result = GlobalLocalizer(map).localize(drive.submap);
  ASSERT_EQ(result.verdict, GlobalVerdict::resolved);
  EXPECT_EQ(result.hypotheses[0].logRatio,
            GlobalLocalizer(map, anyRadius).localize(drive.submap).hypotheses[0].logRatio);
  EXPECT_GT(result.hypotheses[0].logRatio,
            GlobalLocalizer(world.map()).localize(drive.submap).hypotheses[0].logRatio);
}

TEST(GlobalLocalizer, IsNotFooledByAnotherCity) {
  const PoleCity world(city(1031)), other(city(1032));
  const GlobalLocalizer localizer(other.map());
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Drive drive = driveFrom(world, 5000 + i, 60);
    EXPECT_EQ(localizer.localize(drive.submap).verdict, GlobalVerdict::none);
  }
}

TEST(GlobalLocalizer, WithstandsAnOldMapAndManyFalseDetections) {
  CityOptions options = city(1041);
  options.missing = options.vanished = 0.3;
  DriveOptions driveOptions;
  driveOptions.falsePerFrame = 4;
  const Count count = starts(options, 100, driveOptions);
  record(count);
  EXPECT_EQ(count.wrong, 0);
  EXPECT_GE(count.right, 85);
}

/// Two copies of a city side by side: both places are right, and it must say so.
TEST(GlobalLocalizer, NamesBothOfTwoEqualPlaces) {
  const PoleCity world(city(1051));
  const std::vector<MapPole> map = mapTwice(world);
  const Drive drive = driveFrom(world, 1, 60);
  const GlobalResult result = GlobalLocalizer(map).localize(drive.submap);
  EXPECT_EQ(result.verdict, GlobalVerdict::ambiguous);
  ASSERT_GE(result.hypotheses.size(), 2u);
  Pose2D copy = drive.truth();
  copy.x += 5000;
  const Pose2D &first = result.hypotheses[0].pose_map_robot,
               &second = result.hypotheses[1].pose_map_robot;
  EXPECT_TRUE((isRight(first, drive.truth()) && isRight(second, copy)) ||
              (isRight(second, drive.truth()) && isRight(first, copy)));
  EXPECT_NEAR(result.hypotheses[0].weight, 0.5, 0.01);
  EXPECT_NEAR(result.hypotheses[1].weight, 0.5, 0.01);
}

/// Where the drive began, to within 20 m, decides between the two.
TEST(GlobalLocalizer, DecidesByTheAreaWhereTheDriveBegan) {
  const PoleCity world(city(1051));
  const std::vector<MapPole> map = mapTwice(world);
  const GlobalLocalizer localizer(map);
  const Drive drive = driveFrom(world, 1, 60);
  const Pose2D& begin = drive.frames.front().truth;
  for (const double copy : {0.0, 5000.0}) {
    const SearchArea area{{begin.x + copy + 15, begin.y}, 20};
    const GlobalResult result = localizer.localize(drive.submap, area);
    ASSERT_EQ(result.verdict, GlobalVerdict::resolved);
    Pose2D truth = drive.truth();
    truth.x += copy;
    EXPECT_TRUE(isRight(result.hypotheses[0].pose_map_robot, truth));
  }
  const SearchArea elsewhere{{begin.x + 30, begin.y}, 20};
  EXPECT_EQ(localizer.localize(drive.submap, elsewhere).verdict, GlobalVerdict::none);
}

/// A map turned and moved gives the same answer, turned and moved.
TEST(GlobalLocalizer, DoesNotDependOnTheMapsFrame) {
  const PoleCity world(city(1061));
  const Pose2D moved{-31000, 47000, 2.1};
  std::vector<MapPole> map = world.map();
  for (MapPole& pole : map) {
    const Pose2D at = compose(moved, {pole.x, pole.y, 0});
    pole.x = at.x;
    pole.y = at.y;
  }
  const GlobalLocalizer here(world.map()), there(map);
  for (std::uint64_t seed : {1, 2, 3}) {
    const Drive drive = driveFrom(world, seed, 40);
    const GlobalResult a = here.localize(drive.submap), b = there.localize(drive.submap);
    EXPECT_EQ(a.verdict, b.verdict);
    ASSERT_FALSE(a.hypotheses.empty() || b.hypotheses.empty());
    EXPECT_EQ(a.hypotheses[0].matched, b.hypotheses[0].matched);
    const Pose2D expected = compose(moved, a.hypotheses[0].pose_map_robot);
    const Pose2D& got = b.hypotheses[0].pose_map_robot;
    EXPECT_NEAR(expected.x, got.x, 1e-4);
    EXPECT_NEAR(expected.y, got.y, 1e-4);
    EXPECT_NEAR(wrapAngle(expected.yaw - got.yaw), 0, 1e-6);
  }
}

TEST(GlobalLocalizer, FindsTheOdometrysScale) {
  const PoleCity world(city(1081));
  const GlobalLocalizer localizer(world.map());
  for (double error : {-0.02, 0.02}) {
    DriveOptions options;
    options.scaleError = error;
    const Drive drive = driveFrom(world, 4, 60, options);
    const GlobalResult result = localizer.localize(drive.submap);
    ASSERT_EQ(result.verdict, GlobalVerdict::resolved);
    EXPECT_TRUE(isRight(result.hypotheses[0].pose_map_robot, drive.truth()));
    EXPECT_NEAR(result.hypotheses[0].scale, -error, 0.01);  // too long a way has to shrink
  }
}

TEST(GlobalLocalizer, RanksItsHypothesesAndCountsWhatTheyMatch) {
  const PoleCity world(regularCity(1091));
  GlobalOptions options;
  options.maxHypotheses = 7;
  const GlobalLocalizer localizer(world.map(), options);
  const Drive drive = driveFrom(world, 2, 60);
  const GlobalResult result = localizer.localize(drive.submap);
  ASSERT_EQ(result.hypotheses.size(), 7u);
  double weights = 0;
  for (std::size_t i = 0; i < result.hypotheses.size(); ++i) {
    const GlobalHypothesis& h = result.hypotheses[i];
    weights += h.weight;
    EXPECT_NEAR(h.matchedShare, static_cast<double>(h.matched) / result.poles, 1e-12);
    EXPECT_LE(h.matched, result.poles);
    const Pose2D robot = compose(h.pose_map_local, drive.submap.pose());
    EXPECT_NEAR(robot.x, h.pose_map_robot.x, 1e-9);
    EXPECT_NEAR(robot.y, h.pose_map_robot.y, 1e-9);
    if (i == 0) continue;
    EXPECT_LE(h.logRatio, result.hypotheses[i - 1].logRatio);
    for (std::size_t k = 0; k < i; ++k) {
      const Pose2D between = relative(result.hypotheses[k].pose_map_robot, h.pose_map_robot);
      EXPECT_TRUE(std::hypot(between.x, between.y) > options.distinct ||
                  std::abs(between.yaw) > options.distinctYaw);
    }
  }
  EXPECT_NEAR(weights, 1, 1e-12);
}

TEST(GlobalLocalizer, SaysTheSameTwice) {
  const PoleCity world(city(1101));
  const Drive drive = driveFrom(world, 3, 30);
  const GlobalResult a = GlobalLocalizer(world.map()).localize(drive.submap);
  const GlobalResult b = GlobalLocalizer(world.map()).localize(drive.submap);
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].pose_map_robot.x, b.hypotheses[i].pose_map_robot.x);
    EXPECT_EQ(a.hypotheses[i].pose_map_robot.yaw, b.hypotheses[i].pose_map_robot.yaw);
    EXPECT_EQ(a.hypotheses[i].logRatio, b.hypotheses[i].logRatio);
  }
}

/// Poles beside the way that were never seen speak against a place: of two equal sets of matches
/// the one with fewer of them wins.
TEST(GlobalLocalizer, HoldsUnseenPolesAgainstAPlace) {
  const PoleCity world(city(1111));
  std::vector<MapPole> map = world.map();
  const std::size_t half = map.size();
  for (std::size_t i = 0; i < half; ++i) {
    map.push_back(map[i]);
    map.back().x += 5000;
  }
  const Drive drive = driveFrom(world, 6, 60);
  for (std::size_t k = 0; k < drive.frames.size();
       k += 3) {  // poles on the way itself, in the copy
    map.push_back(map.front());
    map.back().x = drive.frames[k].truth.x + 5000;
    map.back().y = drive.frames[k].truth.y;
  }
  const GlobalResult result = GlobalLocalizer(map).localize(drive.submap);
  ASSERT_EQ(result.verdict, GlobalVerdict::resolved);
  EXPECT_TRUE(isRight(result.hypotheses[0].pose_map_robot, drive.truth()));
  ASSERT_GE(result.hypotheses.size(), 2u);
  EXPECT_GE(result.hypotheses[1].unseen, result.hypotheses[0].unseen + 18);
}

/// Nothing false and nothing missing: one pair of poles is mostly enough, whichever way round it
/// lies.
TEST(GlobalLocalizer, FindsAPlaceByOnePair) {
  CityOptions options = city(1112);
  options.missing = options.vanished = 0;
  const PoleCity world(options);
  GlobalOptions one;
  one.maxPairs = 1;
  const GlobalLocalizer localizer(world.map(), one);
  DriveOptions clean;
  clean.falsePerFrame = 0;
  sim::Random random(3);
  int right = 0;
  for (int i = 0; i < 20; ++i) {
    const std::vector<Frame> frames =
        tests::drive({world.surroundings().poles, {}}, world.randomWay(random, 40), clean, random);
    LocalSubmap submap;
    for (const Frame& frame : frames) submap.add(frame.motion, frame.poles_robot);
    const GlobalResult result = localizer.localize(submap);
    right += result.verdict == GlobalVerdict::resolved &&
             isRight(result.hypotheses[0].pose_map_robot, frames.back().truth);
  }
  EXPECT_GE(right, 17);
}

/// Where two poles stand for each one of a coarse map, half of them match.
TEST(GlobalLocalizer, CreditsAMapPoleOnce) {
  const PoleCity world(city(1113));
  std::vector<MapPole> map = world.map();
  for (MapPole& pole : map) pole.covariance = 0.15 * 0.15 * Eigen::Matrix2d::Identity();
  tests::Surroundings twins{world.surroundings().poles, {}};
  for (const Eigen::Vector2d& pole : world.surroundings().poles)
    twins.poles.emplace_back(pole.x() + 0.3, pole.y());
  sim::Random random(4);
  LocalSubmap submap;
  for (const Frame& frame : tests::drive(twins, world.randomWay(random, 40), {}, random))
    submap.add(frame.motion, frame.poles_robot);
  const GlobalResult result = GlobalLocalizer(map).localize(submap);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_GT(result.hypotheses[0].matchedShare, 0.35);
  EXPECT_LT(result.hypotheses[0].matchedShare, 0.55);
}

/// A map full of poles that stand no more is still the right map.
TEST(GlobalLocalizer, LetsNoUnseenPolesOutvoteTheMatches) {
  const PoleCity world(city(1115));
  std::vector<MapPole> map = world.map();
  const Drive drive = driveFrom(world, 6, 60);
  sim::Random random(9);
  for (const Frame& frame : drive.frames) {
    map.push_back(map.front());
    map.back().x = frame.truth.x + random.uniform(-3, 3);
    map.back().y = frame.truth.y + random.uniform(-3, 3);
  }
  const GlobalResult result = GlobalLocalizer(map).localize(drive.submap);
  ASSERT_EQ(result.verdict, GlobalVerdict::resolved);
  EXPECT_TRUE(isRight(result.hypotheses[0].pose_map_robot, drive.truth()));
  EXPECT_GT(result.hypotheses[0].unseen, 40u);
  EXPECT_GT(result.hypotheses[0].logRatio, 0);
}

TEST(GlobalLocalizer, TellsWhyThereIsNoAnswer) {
  const PoleCity world(city(1121));
  const GlobalLocalizer localizer(world.map());
  EXPECT_EQ(localizer.localize(LocalSubmap()).reason, GlobalReason::fewPoles);
  const Drive drive = driveFrom(world, 1, 30);
  const GlobalResult empty = GlobalLocalizer({}).localize(drive.submap);
  EXPECT_EQ(empty.verdict, GlobalVerdict::none);
  EXPECT_EQ(empty.reason, GlobalReason::noPlace);
  // Not all of what is seen is on the map.
  GlobalOptions strict;
  strict.minMatched = static_cast<int>(localizer.localize(drive.submap).poles);
  EXPECT_EQ(GlobalLocalizer(world.map(), strict).localize(drive.submap).reason,
            GlobalReason::fewMatched);
  strict.minMatched = 4;
  strict.minShare = 1;
  EXPECT_EQ(GlobalLocalizer(world.map(), strict).localize(drive.submap).reason,
            GlobalReason::smallShare);
}

TEST(GlobalLocalizer, BoundsItsWork) {
  const PoleCity world(regularCity(1131));
  GlobalOptions options;
  options.maxCandidates = 3000;
  const Drive drive = driveFrom(world, 1, 60);
  const std::size_t all = GlobalLocalizer(world.map()).localize(drive.submap).candidates;
  const std::size_t bounded =
      GlobalLocalizer(world.map(), options).localize(drive.submap).candidates;
  EXPECT_GT(all, 3000u);
  EXPECT_LT(all, 16000u);  // 13,666: pairs are looked up within what they may be off
  EXPECT_LE(bounded, 3000u);
  EXPECT_GT(bounded, 0u);
}

TEST(GlobalLocalizer, RefusesAPoleThatIsNowhere) {
  std::vector<MapPole> map(3);
  map[2].y = std::nan("");
  EXPECT_REFUSED(GlobalLocalizer(map), "pole 2");
}

}  // namespace
}  // namespace polemcl::test_global_localizer
