#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/sensor/SensorOptions.h>
#include "core/common/Binder.h"
#include "mrpt/filter/LocalizationPipeline.h"
#include "support/PoleCity.h"
#include "support/Refusal.h"

namespace polemcl::test_localization_pipeline {
namespace {

/// A city and drives through it in the form that the pipeline takes: one frame per metre.
class PoleLocalizationTest : public testing::Test {
 protected:
  explicit PoleLocalizationTest(const tests::CityOptions& cityOptions = cityOf(31))
      : city(cityOptions) {
    auto poles = std::make_shared<CPoleMap>();
    poles->likelihoodOptions.sigma = 0.05;
    poles->likelihoodOptions.weighted = true;
    poles->setPoles(city.map());
    map = std::make_unique<LocalizationMap>(poles);
  }
  static tests::CityOptions cityOf(std::uint64_t seed) {
    tests::CityOptions options;
    options.seed = seed;
    return options;
  }
  void driveFrom(std::uint64_t seed, double metres) {
    sim::Random random(seed);
    const auto drive =
        tests::drive(city.surroundings(), city.randomWay(random, metres), {}, random);
    for (const tests::Frame& seen : drive) {
      PoleScan frame;
      frame.time = 1e9 + 0.2 * static_cast<double>(frames.size());
      PoseWithCovariance motion;
      motion.mean = seen.motion;
      motion.covariance = Eigen::Vector3d(4e-4, 1e-6, 1e-6).asDiagonal();
      frame.motion = motion;
      frame.poles_robot = seen.poles_robot;
      frames.push_back(frame);
      truth.push_back(seen.truth);
    }
  }
  LocalizationPipeline chain(std::uint32_t seed = 1) const { return {*map, options, seed}; }
  StartOptions atTruth() const {
    StartOptions start;
    start.pose = truth[0];
    return start;
  }
  LocalizationPipeline started(std::uint32_t seed = 1) const {
    LocalizationPipeline localization = chain(seed);
    localization.start(atTruth());
    return localization;
  }
  double error(const LocalizationUpdate& update, std::size_t i) const {
    return std::hypot(update.estimate->mean.x - truth[i].x, update.estimate->mean.y - truth[i].y);
  }

  /// Mean error after the first 20 m.
  double meanError(const std::vector<PoleScan>& drive) const {
    LocalizationPipeline localization = started();
    double sum = 0;
    for (std::size_t i = 0; i < drive.size(); ++i) {
      const LocalizationUpdate update = localization.step(drive[i]);
      if (i >= 20) sum += error(update, i);
    }
    return sum / static_cast<double>(drive.size() - 20);
  }

  LocalizationOptions options;
  tests::PoleCity city;
  std::unique_ptr<LocalizationMap> map;
  std::vector<PoleScan> frames;
  std::vector<Pose2D> truth;
};

class RegularCity : public PoleLocalizationTest {
 protected:
  RegularCity() : PoleLocalizationTest(regular()) {}
  static tests::CityOptions regular() {
    tests::CityOptions options = cityOf(5);
    options.regular = true;
    options.missing = options.vanished = options.mapNoise = 0;
    return options;
  }
};

TEST_F(PoleLocalizationTest, TracksFromAStartPoseAndSaysOk) {
  driveFrom(1, 150);
  LocalizationPipeline localization = started();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LocalizationUpdate update = localization.step(frames[i]);
    ASSERT_TRUE(update.estimate);
    EXPECT_NE(update.health.state, HealthState::lost);
    if (i < 20) continue;
    EXPECT_LT(error(update, i), 0.1);
    EXPECT_EQ(update.health.state, HealthState::ok) << i << ' ' << name(update.health.reason);
  }
  EXPECT_EQ(localization.searches(), 0u);
}

/// The drive as a LiDAR that turns clockwise from the back sees it while it moves.
std::vector<PoleScan> seenMoving(std::vector<PoleScan> frames, const std::vector<Pose2D>& truth,
                                 double turnSeconds) {
  const ScanTiming timing{Turn::clockwise, turnSeconds, M_PI, 0.5};
  for (std::size_t i = 1; i + 1 < frames.size(); ++i) {
    frames[i].velocity = velocityOf(relative(truth[i - 1], truth[i + 1]), 0.4);
    for (PoleDetection& pole : frames[i].poles_robot) {
      pole.timeOffset = timing.offset(std::atan2(pole.y, pole.x));
      const Pose2D seen =
          relative(motionAfter(*frames[i].velocity, pole.timeOffset), {pole.x, pole.y, 0});
      pole.x = seen.x;
      pole.y = seen.y;
    }
  }
  return frames;
}

// With 0.12 s for a turn, on a vehicle with 5 m/s, poles at the sides are off by 15 cm along the
// way, those behind by 30 cm.
TEST_F(PoleLocalizationTest, PolesMeasuredWhileMovingAreCorrected) {
  driveFrom(1, 145);  // then the way turns round on the spot, which no vehicle does
  std::vector<PoleScan> moving = seenMoving(frames, truth, 0.12);
  for (PoleScan& frame : moving) frame.velocity.reset();
  std::vector<PoleScan> uncorrected = moving;
  for (PoleScan& frame : uncorrected)
    for (PoleDetection& pole : frame.poles_robot) pole.timeOffset = 0;
  const double standing = meanError(frames);
  EXPECT_LT(meanError(moving), 1.2 * standing);
  EXPECT_GT(meanError(uncorrected), 2 * standing);
}

// Odometry that states its velocity, 5 % too great as its motions are: both are corrected.
TEST_F(PoleLocalizationTest, StatedVelocitiesAreCalibratedAsMotionsAre) {
  driveFrom(1, 150);
  std::vector<PoleScan> moving = seenMoving(frames, truth, 0.8);
  const double unbiased = meanError(moving);
  for (PoleScan& frame : moving) {
    frame.motion->mean.x *= 1.05;
    frame.motion->mean.y *= 1.05;
    if (!frame.velocity) continue;
    frame.velocity->x *= 1.05;
    frame.velocity->y *= 1.05;
  }
  EXPECT_LT(meanError(moving), 1.2 * unbiased);
}

TEST_F(PoleLocalizationTest, OdometryWithAWrongScaleAndABiasIsCalibrated) {
  driveFrom(1, 300);
  const double unbiased = meanError(frames);
  for (PoleScan& frame : frames) {
    frame.motion->mean.yaw += 0.0009 * frame.motion->mean.x;  // 0.05 deg/m
    frame.motion->mean.x *= 1.05;
    frame.motion->mean.y *= 1.05;
  }
  EXPECT_LT(meanError(frames), 1.2 * unbiased);
  LocalizationPipeline localization = started();
  LocalizationUpdate update;
  for (const PoleScan& frame : frames) update = localization.step(frame);
  EXPECT_NEAR(update.odometryErrors.scale, 1 / 1.05 - 1, 0.01);
  EXPECT_NEAR(update.odometryErrors.yaw, -0.0009, 0.0003);
  options.calibrateOdometry = false;
  EXPECT_GT(meanError(frames), 1.5 * unbiased);
}

TEST_F(PoleLocalizationTest, FoundWithoutAStartPose) {
  for (const std::uint64_t seed : {2, 3, 4}) {
    frames.clear();
    truth.clear();
    driveFrom(seed, 100);
    LocalizationPipeline localization = chain();
    localization.initializeGlobally();
    std::size_t known = frames.size();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const LocalizationUpdate update = localization.step(frames[i]);
      if (!update.estimate) {
        EXPECT_EQ(update.health.reason, HealthReason::searching);
        continue;
      }
      EXPECT_TRUE(known < i || update.relocalized);
      known = std::min(known, i);
      EXPECT_LT(error(update, i), 0.5);
      EXPECT_TRUE(i <= known + 10 || update.health.state == HealthState::ok);
    }
    EXPECT_LE(known, 60u);
  }
}

TEST_F(PoleLocalizationTest, AKidnappedVehicleIsLostAndFoundAgain) {
  driveFrom(6, 120);
  const std::size_t jump = frames.size();
  driveFrom(7, 120);  // elsewhere; the odometry does not contain the jump
  LocalizationPipeline localization = started();
  std::size_t lost = 0, found = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LocalizationUpdate update = localization.step(frames[i]);
    const bool isLost = update.health.state == HealthState::lost;
    if (i < jump) {
      EXPECT_FALSE(isLost);
      continue;
    }
    if (lost == 0 && isLost) lost = i;
    if (lost == 0 && static_cast<double>(i - jump) > 8) {
      EXPECT_NE(update.health.state, HealthState::ok) << i - jump;
    }
    if (found == 0 && update.relocalized) found = i;
    if (found != 0) {
      EXPECT_LT(error(update, i), 0.5);
    }
  }
  ASSERT_GT(lost, 0u);
  EXPECT_LE(lost - jump, 20u);
  ASSERT_GT(found, 0u);
  EXPECT_LE(found - jump, 60u);
}

TEST_F(PoleLocalizationTest, AFilterThatSettledBesideTheTruthIsPutRightByTheSearch) {
  driveFrom(9, 80);
  for (PoleScan& frame : frames)  // odometry much too certain to move the filter
    frame.motion->covariance = Eigen::Vector3d(1e-8, 1e-10, 1e-10).asDiagonal();
  options.filter.extraSigma = options.filter.extraSigmaYaw = 1e-6;
  options.monitorOdometry = false;
  LocalizationPipeline localization = chain();
  StartOptions start = atTruth();
  start.radius = start.heading = 1e-3;
  start.pose->y += 0.4;
  localization.start(start);
  bool putRight = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LocalizationUpdate update = localization.step(frames[i]);
    EXPECT_NE(update.health.reason, HealthReason::elsewhere);
    EXPECT_FALSE(update.relocalized && update.health.state == HealthState::lost);
    putRight |= update.relocalized;
  }
  EXPECT_TRUE(putRight);
}

TEST_F(PoleLocalizationTest, AnotherCitysMapIsLost) {
  driveFrom(8, 60);
  auto poles = std::make_shared<CPoleMap>(*map->poles);
  poles->setPoles(tests::PoleCity(cityOf(77)).map());
  LocalizationPipeline localization(LocalizationMap(poles), options, 1);
  localization.start(atTruth());
  std::size_t lost = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LocalizationUpdate update = localization.step(frames[i]);
    EXPECT_NE(update.health.state, HealthState::ok);
    if (lost == 0 && update.health.state == HealthState::lost) lost = i;
    EXPECT_TRUE(lost == 0 || update.health.state == HealthState::lost) << i;
  }
  EXPECT_GT(lost, 0u);
  EXPECT_LE(lost, 20u);
}

TEST_F(PoleLocalizationTest, WithoutRecoveryItIsNeverOkAgain) {
  options.recover = false;
  driveFrom(6, 60);
  const std::size_t jump = frames.size();
  driveFrom(7, 90);
  LocalizationPipeline localization = started();
  std::size_t lost = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const HealthState state = localization.step(frames[i]).health.state;
    EXPECT_TRUE(i <= jump || state != HealthState::ok) << i - jump;
    if (lost == 0 && state == HealthState::lost) lost = i;
  }
  EXPECT_GT(lost, jump);
  EXPECT_LE(lost, jump + 20);
  EXPECT_EQ(localization.searches(), 0u);
}

TEST_F(RegularCity, WhereAllLooksAlikeSeveralPlacesAreKept) {
  driveFrom(3, 55);
  LocalizationPipeline localization = chain();
  localization.initializeGlobally();
  bool adopted = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LocalizationUpdate update = localization.step(frames[i]);
    EXPECT_NE(update.health.state, HealthState::ok);
    if (!update.estimate) continue;
    adopted = true;
    EXPECT_EQ(update.health.reason, HealthReason::ambiguous);
    EXPECT_LT(update.health.modeShare, 0.95);
    EXPECT_GT(update.health.spread, 10);  // the covariance includes the other places
  }
  EXPECT_TRUE(adopted);
}

/// Only places near where the drive began are left, so that the first answer is the right one.
TEST_F(RegularCity, WhereAllLooksAlikeTheAreaOfTheStartDecides) {
  driveFrom(3, 55);
  LocalizationPipeline localization = chain();
  localization.initializeGlobally(SearchArea{{truth[0].x + 3, truth[0].y}, 10});
  std::size_t known = frames.size();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LocalizationUpdate update = localization.step(frames[i]);
    if (!update.estimate) continue;
    known = std::min(known, i);
    EXPECT_LT(error(update, i), 0.5);
  }
  EXPECT_LT(known, 30u);
  LocalizationPipeline elsewhere = chain();
  EXPECT_REFUSED(elsewhere.initializeGlobally(SearchArea{{1e5, 0}, 10}), "from the nearest pole");
}

TEST_F(PoleLocalizationTest, TheFilterGetsPolesSeenBeforeAndNotTooOften) {
  driveFrom(1, 40);
  const auto used = [&](bool average, double every) {
    options.tracking.average = average;
    options.tracking.every = every;
    LocalizationPipeline localization = started();
    std::vector<std::size_t> poles;
    for (const PoleScan& frame : frames) poles.push_back(localization.step(frame).step.poles);
    return poles;
  };
  const auto all = used(false, 1), every = used(true, 1), seldom = used(true, 5);
  std::size_t sums[3] = {};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(all[i], frames[i].poles_robot.size());
    EXPECT_LE(every[i], all[i]);
    sums[0] += all[i], sums[1] += every[i], sums[2] += seldom[i];
  }
  EXPECT_EQ(every[0], all[0]);  // no wait at the start
  EXPECT_LT(sums[1], 0.95 * sums[0]);
  EXPECT_LT(sums[2], 0.5 * sums[1]);
}

TEST_F(PoleLocalizationTest, ScansFarApartAreUsedAsTheyAre) {
  driveFrom(1, 60);
  LocalizationPipeline localization = started();
  localization.step(frames[0]);
  const std::size_t apart = 3;  // frames are a metre apart
  for (std::size_t i = apart; i < frames.size(); i += apart) {
    PoleScan frame = frames[i];
    frame.motion->mean = relative(truth[i - apart], truth[i]);
    EXPECT_EQ(localization.step(frame).step.poles, frame.poles_robot.size());
  }
}

// What chance matches say about the place is not new while the vehicle stands.
TEST_F(PoleLocalizationTest, FarOutliersCountByTheWay) {
  driveFrom(1, 40);
  const auto lastPose = [&](double farOutlier, bool stands) {
    auto poles = std::make_shared<CPoleMap>(*map->poles);
    poles->likelihoodOptions.farOutlier = farOutlier;
    LocalizationPipeline localization({poles}, options, 1);
    StartOptions start = atTruth();
    start.radius = start.heading = 0;  // the first scan counts in full, but alike for all
    localization.start(start);
    localization.step(frames[0]);
    Pose2D pose;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      PoleScan frame = frames[stands ? 0 : i];
      frame.time = frames[i].time;
      if (stands) frame.motion->mean = {};
      pose = localization.step(frame).estimate->mean;
    }
    return pose;
  };
  EXPECT_EQ(lastPose(0.1, true).x, lastPose(1, true).x);
  EXPECT_NE(lastPose(0.1, false).x, lastPose(1, false).x);
}

TEST_F(PoleLocalizationTest, ByTheSectionTheFilterGetsPolesAtItsEnd) {
  driveFrom(9, 60);  // one scan per metre
  options.tracking.average = false;
  options.tracking.cadence = Cadence::section;
  options.tracking.localMaps.sectionLength = 5;
  LocalizationPipeline localization = chain();
  StartOptions start = atTruth();
  start.particles = 10000;
  localization.start(start);
  std::size_t updates = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LocalizationUpdate update = localization.step(frames[i]);
    EXPECT_EQ(update.poles, frames[i].poles_robot.size());
    if (update.step.poles == 0) continue;
    ++updates;
    EXPECT_TRUE(i % 5 <= 1 && i > 0) << i;  // the odometry error is below a metre
    EXPECT_LT(error(update, i), 0.3);
  }
  EXPECT_NEAR(static_cast<double>(updates), 11.5, 1);
}

TEST_F(PoleLocalizationTest, TheHeaviestPlaceMayReplaceTheEstimate) {
  driveFrom(9, 1);
  frames[0].poles_robot.clear();  // the particles stay as drawn
  options.filter.tempering = 0;
  const auto estimate = [&](bool heaviest) {
    options.filter.heaviestPlace = heaviest;
    options.filter.estimate = PoseEstimator::bestShare;
    LocalizationPipeline localization = started();
    return localization.step(frames[0]).estimate->mean;
  };
  // Equal weights: the best tenth is an arbitrary one, the heaviest place contains all.
  const Pose2D all = estimate(true), tenth = estimate(false);
  PoleParticleFilter filter(map->poles, options.filter, 1);
  filter.start(atTruth());
  const std::vector<double> equal(filter.particles().size(), 0);
  EXPECT_NEAR(all.x, weightedMean(filter.particles(), equal).mean.x, 1e-9);
  EXPECT_NEAR(tenth.x, bestShareMean(filter.particles(), equal, 0.1).mean.x, 1e-9);
  EXPECT_GT(std::hypot(all.x - tenth.x, all.y - tenth.y), 1e-3);
}

TEST_F(PoleLocalizationTest, SameSeedSameBytes) {
  driveFrom(9, 40);
  const auto run = [&](std::uint32_t seed) {
    LocalizationPipeline localization = started(seed);
    std::vector<double> values;
    for (const PoleScan& frame : frames)
      values.push_back(localization.step(frame).estimate->mean.x);
    return values;
  };
  EXPECT_EQ(run(4), run(4));
  EXPECT_NE(run(4), run(5));
}

TEST_F(PoleLocalizationTest, RefusesAStartThatIsNoNumber) {
  driveFrom(1, 5);
  LocalizationPipeline localization = chain();
  StartOptions start = atTruth();
  start.pose->y = NAN;
  EXPECT_REFUSED(
      localization.start(start),
      "is not finite; position_m and yaw_deg in [start], or the pose given, must be numbers");
}

TEST_F(PoleLocalizationTest, RefusesFramesBeforeTheStartAndBadFramesWithoutChange) {
  driveFrom(1, 30);
  LocalizationPipeline localization = chain(), untouched = chain();
  EXPECT_THROW(localization.step(frames[0]), Error);
  localization.initializeGlobally();
  untouched.initializeGlobally();
  localization.step(frames[0]);
  untouched.step(frames[0]);
  EXPECT_THROW(localization.step(frames[0]), Error);  // same time again
  PoleScan bad = frames[1];
  bad.motion.reset();
  EXPECT_THROW(localization.step(bad), Error);
  bad.motion = frames[1].motion;
  bad.motion->mean.x = NAN;
  EXPECT_THROW(localization.step(bad), Error);
  EXPECT_EQ(localization.submap().frames(), untouched.submap().frames());
  EXPECT_NO_THROW(localization.step(frames[1]));
}

TEST(LocalizationMap, RefusesAMapWithoutPoles) {
  EXPECT_THROW(LocalizationMap(std::make_shared<CPoleMap>()), Error);
  EXPECT_THROW(LocalizationMap(nullptr), Error);
}

TEST(TrackingOptions, RefusesValuesOutOfRange) {
  TrackingOptions options;
  EXPECT_NO_THROW(checkOptions(options));
  options.minHits = 0;
  EXPECT_THROW(checkOptions(options), Error);
  options = {};
  options.every = -1;
  EXPECT_THROW(checkOptions(options), Error);
  options = {};
  options.cadence = Cadence::section;
  EXPECT_THROW(checkOptions(options), Error);  // averaging needs every scan
  options.average = false;
  EXPECT_NO_THROW(checkOptions(options));
  options.localMaps.maps = 0;
  EXPECT_THROW(checkOptions(options), Error);
}

}  // namespace
}  // namespace polemcl::test_localization_pipeline
