#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>

#include <polemcl/core/extraction/PoleExtractor.h>
#include <polemcl/io/data/Cloud.h>
#include <polemcl/localizer/Localizer.h>
#include <polemcl/localizer/MapBuilder.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include "localizer/ScanOdometry.h"
#include "support/LocalizeTest.h"
#include "support/Refusal.h"
#include "support/Samples.h"
#include "support/StreetTest.h"

namespace polemcl::test_localizer {
namespace {

using namespace testing_apps;

/// The street with odometry as poses, beside the scans of poles.
class LocalizerTest : public LocalizeTest {
 protected:
  LocalizerTest() {
    std::string rawlog;
    Pose2D at;
    for (std::size_t i = 0; i < street.frames.size(); ++i) {
      const PoleScan& frame = street.frames[i];
      if (i > 0 && frame.motion) at = compose(at, frame.motion->mean);
      mrpt::obs::CObservationOdometry reading;
      reading.timestamp = mrpt::Clock::fromDouble(frame.time);
      reading.odometry = mrpt::poses::CPose2D(at.x, at.y, at.yaw);
      odometry.push_back({reading.odometry.x(), reading.odometry.y(), reading.odometry.phi()});
      CObservationPoles poles;
      poles.timestamp = reading.timestamp;
      poles.poles = frame.poles_robot;
      poles.points = static_cast<std::uint32_t>(frame.points);
      scans_poles.push_back(poles);
      rawlog += samples::bytesOf(reading) + samples::bytesOf(poles);
    }
    writeText(folder / "in.rawlog", rawlog);
  }
  Localizer localizer() const {
    return {Settings((folder / "config.ini").string()), folder / "map.polemap"};
  }
  std::vector<Pose2D> odometry;
  std::vector<CObservationPoles> scans_poles;
};

TEST_F(LocalizerTest, GivesThePosesOfPoleLocalize) {
  const Pose2D& start = street.truth.front();
  const std::string text = std::to_string(start.x) + "," + std::to_string(start.y) + "," +
                           std::to_string(start.yaw * 180 / M_PI) + ",0.5,3";
  const Outcome outcome = succeeded(run({"--start", text}));
  const auto expected = io::planar(io::readTum(out("run_00.tum")));
  ASSERT_EQ(expected.size(), scans);
  Localizer own(Settings(out("config.ini").string()), folder / "map.polemap");
  for (std::size_t i = 0; i < scans; ++i) {
    const auto update = own.step(scans_poles[i], odometry[i]);
    ASSERT_TRUE(update.estimate);
    const Pose2D& pose = update.estimate->mean;
    EXPECT_NEAR(pose.x, expected[i].pose.x, 1e-6) << i;  // the digits of the file
    EXPECT_NEAR(pose.y, expected[i].pose.y, 1e-6);
    EXPECT_NEAR(pose.yaw, expected[i].pose.yaw, 1e-8);
    EXPECT_EQ(own.poles().size(), scans_poles[i].poles.size());
  }
  EXPECT_EQ(own.odometryJumps(), 0u);
}

TEST_F(LocalizerTest, PolesAndObservationsAreTheSame) {
  Localizer a = localizer(), b = localizer();
  a.start(street.truth.front());
  b.start(street.truth.front());
  for (std::size_t i = 0; i < scans; ++i) {
    const auto first = a.step(scans_poles[i], odometry[i]);
    const auto other = b.step(street.frames[i].time, scans_poles[i].poles, odometry[i]);
    EXPECT_EQ(first.estimate->mean.x, other.estimate->mean.x);
    EXPECT_EQ(first.health.state, other.health.state);
  }
}

TEST_F(LocalizerTest, AJumpOfTheOdometryIsBridged) {
  Localizer own = localizer();
  own.start(street.truth.front());
  for (std::size_t i = 0; i < scans; ++i) {
    Pose2D reading = odometry[i];
    if (i >= scans / 2) reading.x += 1000;
    const auto update = own.step(scans_poles[i], reading);
    ASSERT_TRUE(update.estimate);
    EXPECT_NEAR(update.estimate->mean.x, street.truth[i].x, 0.3);
  }
  EXPECT_EQ(own.odometryJumps(), 1u);
}

TEST_F(LocalizerTest, ARefusedScanLeavesNoOdometryBehind) {
  Localizer own = localizer(), untouched = localizer();
  own.start(street.truth.front());
  untouched.start(street.truth.front());
  for (std::size_t i = 0; i < scans; ++i) {
    Pose2D reading = odometry[i];
    if (i >= scans / 2) reading.x += 1000;  // a jump
    if (i == scans / 4) {
      std::vector<PoleDetection> poles = scans_poles[i].poles;
      poles.at(0).x = NAN;
      EXPECT_HAS(messageOf([&] { own.step(street.frames[i].time + 1000, poles, reading); }),
                 "pole 0 has");
    }
    const auto update = own.step(scans_poles[i], reading);
    EXPECT_EQ(update.estimate->mean.x, untouched.step(scans_poles[i], reading).estimate->mean.x);
  }
  EXPECT_EQ(own.odometryJumps(), 1u);
}

TEST_F(LocalizerTest, ANewStartTakesTimesThatBeginAgain) {
  Localizer own = localizer();
  own.start(street.truth.front());
  for (std::size_t i = 0; i < scans / 2; ++i)
    own.step(scans_poles[i], {odometry[i].x + 5000, odometry[i].y, odometry[i].yaw});
  own.start(street.truth.front());
  for (std::size_t i = 0; i < scans; ++i) {  // beyond the end of the first drive
    const auto update = own.step(scans_poles[i], odometry[i]);
    ASSERT_TRUE(update.estimate);
    EXPECT_NEAR(update.estimate->mean.x, street.truth[i].x, 0.3) << i;
  }
  EXPECT_EQ(own.odometryJumps(), 0u);
}

TEST_F(LocalizerTest, SaysWhatIsWrong) {
  Localizer own = localizer();
  EXPECT_HAS(messageOf([&] { own.step(scans_poles[0], {}); }), "has not been started");
  EXPECT_HAS(messageOf([&] { own.start({1e6, 0, 0}); }), "pole");
  own.startAnywhere();
  EXPECT_HAS(messageOf([&] { own.step(scans_poles[0], {NAN, 0, 0}); }), "finite");
  own.step(scans_poles[1], odometry[1]);
  EXPECT_HAS(messageOf([&] { own.step(scans_poles[0], odometry[0]); }), "time does not increase");
  EXPECT_HAS(messageOf([&] { own.step(scans_poles[2], {NAN, 0, 0}); }), "finite");
  EXPECT_HAS(messageOf([&] { Localizer(Settings(), folder / "none.polemap"); }), "none.polemap");
}

TEST(SettingsTest, AreReadReplacedAndWritten) {
  Settings settings("hdl32e.ini", {"filter.particles=123"});
  EXPECT_HAS(settings.text(), "particles = 123 ");
  EXPECT_HAS(settings.text(), "model = hdl32e ");
  EXPECT_EQ(settings.sensor().model, "hdl32e");
  EXPECT_EQ(settings.extraction().method, ExtractionMethod::scanLine);
  EXPECT_NO_THROW(PoleExtractor(settings.sensor(), settings.extraction()));
  const std::string before = settings.text();
  EXPECT_HAS(messageOf([&] { settings.set("filter.particle=1"); }), "is particles meant?");
  EXPECT_EQ(settings.text(), before);
  Settings copy = settings;
  copy.set("sensor.model=vlp16");
  EXPECT_HAS(copy.text(), "model = vlp16 ");
  EXPECT_EQ(settings.text(), before);
  EXPECT_HAS(messageOf([] { Settings("none.ini"); }), "none.ini");
  const Settings moved = std::move(copy);
  copy = settings;  // NOLINT: what was moved from can be assigned to
  EXPECT_EQ(copy.text(), before);
}

TEST_F(StreetTest, PointsBecomePoses) {
  constexpr std::size_t number = 25;
  importStreet("in", number);
  buildAtTruth();
  const auto truth = io::planar(io::readTum(folder / "in.tum"));
  Localizer localizer(Settings(config()), folder / "map.polemap");
  localizer.start(truth[0].pose, 0.5, 0.1);
  for (std::size_t i = 0; i < number; ++i) {
    const io::Cloud cloud = io::readKittiBin(folder / "in" / "velodyne" / scanName(i));
    const auto update = localizer.step(truth[i].time, cloud.view(), truth[i].pose);
    EXPECT_GE(localizer.poles().size(), 4u);
    if (i < 5) continue;  // converging
    ASSERT_TRUE(update.estimate);
    EXPECT_NEAR(update.estimate->mean.x, truth[i].pose.x, 0.1);
    EXPECT_NEAR(update.estimate->mean.y, truth[i].pose.y, 0.1);
  }
}

/// A drive along the street of writeStreet() with odometry that comes by itself.
class OdometryTest : public StreetTest {
 protected:
  static constexpr std::size_t number = 12;
  OdometryTest() {
    importStreet("in", number);
    buildAtTruth();
  }
  Localizer started() const {
    Localizer localizer(Settings(config()), folder / "map.polemap");
    EXPECT_FALSE(localizer.isStarted());
    localizer.start({0, 0, 0}, 0.5, 0.1);
    EXPECT_TRUE(localizer.isStarted());
    return localizer;
  }
  static double timeOf(std::size_t i) { return 50 + 0.2 * static_cast<double>(i); }
  /// What the odometry says at a scan: the truth in a frame of its own.
  static OdometryReading readingAt(std::size_t i) {
    const double yaw = 0.05 * std::sin(0.7 * static_cast<double>(i));
    OdometryReading reading;
    reading.time = timeOf(i);
    reading.pose = compose(pose_odometry_map, {static_cast<double>(i), 0, yaw});
    return reading;
  }
  /// Between two scans, where the odometry interpolated between them is anyway.
  static OdometryReading readingAfter(std::size_t i) {
    const Pose2D before = readingAt(i).pose, step = relative(before, readingAt(i + 1).pose);
    OdometryReading reading;
    reading.time = timeOf(i) + 0.1;
    reading.pose = compose(before, {step.x / 2, step.y / 2, step.yaw / 2});
    return reading;
  }
  io::Cloud cloud(std::size_t i) const {
    return io::readKittiBin(folder / "in" / "velodyne" / scanName(i));
  }
  LocalizationUpdate step(Localizer& localizer, std::size_t i) const {
    return localizer.step(timeOf(i), cloud(i).view(), Eigen::Isometry3d::Identity());
  }
  static constexpr Pose2D pose_odometry_map{30, -20, 1};
};

TEST_F(OdometryTest, MayComeAtOtherTimesThanTheScans) {
  Localizer own = started(), known = started();
  for (std::size_t i = 0; i < number; ++i) {
    EXPECT_FALSE(own.hasOdometry(timeOf(i)));
    own.addOdometry(readingAt(i));
    EXPECT_TRUE(own.hasOdometry(timeOf(i)));
    own.addOdometry(readingAfter(i));
    OdometryReading late = readingAt(0);  // left out
    own.addOdometry(late);
    const auto update = step(own, i);
    const auto expected = known.step(timeOf(i), cloud(i).view(), readingAt(i).pose);
    ASSERT_TRUE(update.estimate);
    EXPECT_EQ(update.estimate->mean.x, expected.estimate->mean.x) << i;
    EXPECT_EQ(update.estimate->mean.yaw, expected.estimate->mean.yaw) << i;
    const Pose2D robot = compose(*own.odometryFrame(), readingAt(i).pose);
    EXPECT_NEAR(robot.x, update.estimate->mean.x, 1e-9);
    EXPECT_NEAR(robot.y, update.estimate->mean.y, 1e-9);
    EXPECT_NEAR(robot.yaw, update.estimate->mean.yaw, 1e-9);
  }
}

TEST_F(OdometryTest, ItsCovarianceIsThatOfARawlog) {
  Localizer own = started(), player = started();
  std::vector<PoseWithCovariance> expected;
  player.play(at("in.rawlog"), [&](const auto& update) { expected.push_back(*update.estimate); });
  ASSERT_EQ(expected.size(), number);
  for (std::size_t i = 0; i < number; ++i) {
    OdometryReading reading = readingAt(i);  // sigmas of writeStreet() without those that are added
    const Eigen::Vector3d variances(4e-4 - 1e-6, 1e-4 - 1e-6, 9e-6 - 1e-8);
    reading.velocityCovariance = (variances / (0.2 * 0.2)).asDiagonal();
    own.addOdometry(reading);
    const auto update = step(own, i);
    EXPECT_NEAR(update.estimate->mean.x, expected[i].mean.x, 1e-6) << i;
    EXPECT_NEAR(update.estimate->mean.y, expected[i].mean.y, 1e-6) << i;
    EXPECT_NEAR(update.estimate->covariance(0, 0), expected[i].covariance(0, 0), 1e-8) << i;
  }
}

TEST_F(OdometryTest, AMountedLidarSeesTheSamePoles) {
  Localizer own = started(), straight = started();
  Eigen::Isometry3d T_robot_lidar(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  T_robot_lidar.translation() = Eigen::Vector3d(2, 0.5, 0);
  for (std::size_t i = 0; i < number; ++i) {
    own.addOdometry(readingAt(i));
    straight.addOdometry(readingAt(i));
    // The robot whose LiDAR this is stands 2 m behind and 0.5 m to the right of the other.
    io::Cloud turned = cloud(i);
    turned.x.swap(turned.y);
    for (float& y : turned.y) y = -y;
    const auto update = own.step(timeOf(i), turned.view(), T_robot_lidar);
    step(straight, i);
    ASSERT_EQ(own.poles().size(), straight.poles().size());
    EXPECT_EQ(update.poles, own.poles().size());
    for (const PoleDetection& pole : straight.poles()) {
      double nearest = 1;
      for (const PoleDetection& other : own.poles())
        nearest = std::min(nearest, std::hypot(other.x - pole.x - 2, other.y - pole.y - 0.5));
      EXPECT_LT(nearest, 0.05) << pole.x << ' ' << pole.y;
    }
  }
}

TEST_F(OdometryTest, SaysWhatIsMissing) {
  Localizer own = started();
  EXPECT_HAS(messageOf([&] { step(own, 0); }), "no odometry within 0.5 s of the scan at 50.000 s");
  OdometryReading wrong;
  wrong.pose.x = NAN;
  EXPECT_HAS(messageOf([&] { own.addOdometry(wrong); }), "must be finite");
  wrong = readingAt(0);
  wrong.time = 1.7e18;  // nanoseconds
  EXPECT_HAS(messageOf([&] { own.addOdometry(wrong); }), "times are seconds");
  EXPECT_HAS(messageOf([&] { own.step(1.7e18, std::vector<PoleDetection>(), Pose2D()); }),
             "seconds");
  own.addOdometry(readingAt(0));
  Eigen::Isometry3d wide = Eigen::Isometry3d::Identity();
  wide.linear() *= 2;
  EXPECT_HAS(messageOf([&] { own.step(timeOf(0), cloud(0).view(), wide); }), "T_robot_lidar");
  for (const double time : {static_cast<double>(NAN), -0.5, 1e300})
    EXPECT_HAS(messageOf([&] { own.step(time, cloud(0).view(), Pose2D()); }), "at least 0");
  const std::vector<float> one{1};
  EXPECT_HAS(messageOf([&] {
               own.step(1, PointsView{one.data(), one.data(), nullptr, 1}, Pose2D());
             }),
             "points without x, y or z");
  for (const double radius : {-5.0, static_cast<double>(NAN)}) {
    EXPECT_HAS(messageOf([&] { own.startWithin(0, 0, radius); }), "radius");
    EXPECT_HAS(messageOf([&] { own.start({}, radius); }), "radius");
  }
  EXPECT_FALSE(own.odometryFrame());
}

TEST_F(OdometryTest, ScansInAGapOfTheReadingsAreRefused) {
  Localizer own = started();
  for (const double later : {-1.8, 0.4}) {
    OdometryReading reading = readingAt(0);
    reading.time += later;
    own.addOdometry(reading);
  }
  EXPECT_TRUE(own.hasOdometry(timeOf(0)));
  EXPECT_HAS(messageOf([&] { step(own, 0); }), "no odometry within 0.5 s of the scan");
  EXPECT_NO_THROW(step(own, 2)) << "the time of a reading";
}

TEST_F(OdometryTest, AClockThatWasSetIsFollowedAfterASecond) {
  Localizer own = started();
  OdometryReading wrong = readingAt(0);
  wrong.time += 1e6;
  wrong.velocity = Velocity{NAN, 0, 0};
  own.addOdometry(readingAt(0));
  step(own, 0);
  own.addOdometry(wrong);
  std::size_t taken = 0;
  for (std::size_t i = 1; i < number; ++i) {
    own.addOdometry(readingAt(i));
    try {
      const auto update = step(own, i);
      EXPECT_NEAR(update.estimate->mean.x, static_cast<double>(i), 0.3) << i;
      ++taken;
    } catch (const Error& error) {
      EXPECT_HAS(std::string(error.what()), "no odometry within 0.5 s");
    }
  }
  EXPECT_EQ(taken, number - 6) << "readings are 0.2 s apart: five were left out";
}

TEST_F(OdometryTest, AfterAClockThatBeginsAgainANewStartTakesItsTimes) {
  Localizer own = started();
  for (std::size_t i = 0; i < number; ++i) {
    own.addOdometry(readingAt(i));
    step(own, i);
  }
  for (std::size_t i = 0; i < number; ++i) own.addOdometry(readingAt(i));
  EXPECT_TRUE(own.odometryFrame());
  EXPECT_FALSE(own.poles().empty());
  own.start({6, 0, 0}, 0.3, 0.1);
  EXPECT_FALSE(own.odometryFrame()) << "that of the last drive";
  EXPECT_TRUE(own.poles().empty());
  for (std::size_t i = 6; i < number; ++i) {
    const auto update = step(own, i);
    EXPECT_NEAR(update.estimate->mean.x, static_cast<double>(i), 0.3) << i;
  }
}

/// Readings at 50 Hz and 10 m/s.
OdometryReading fastReading(int i, double late) {
  OdometryReading reading;
  reading.time = 50 + 0.02 * i - late;
  reading.pose.x = 0.2 * i;
  return reading;
}

TEST(ScanOdometry, AClockThatIsSetBackByHalfASecondIsNoJump) {
  ScanOdometry odometry{MotionOptions()};
  for (int i = 0; i <= 50; ++i) odometry.add(fastReading(i, 0));
  odometry.pass(51, *odometry.track().at(51));
  for (int i = 51; i <= 100; ++i) odometry.add(fastReading(i, 0.51));
  const double time = fastReading(100, 0.51).time;
  const auto motion = odometry.motionTo(time, *odometry.track().at(time));
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->mean.x, 10, 1e-9);
  EXPECT_EQ(odometry.track().jumps(), 0u);
}

TEST(ScanOdometry, AJumpAfterAReadingThatComesLateIsAJump) {
  ScanOdometry odometry{MotionOptions()};
  for (int i = 0; i <= 50; ++i) odometry.add(fastReading(i, 0));
  odometry.pass(51, *odometry.track().at(51));
  odometry.add(fastReading(48, 0));
  for (int i = 51; i <= 100; ++i) {
    OdometryReading reading = fastReading(i, 0);
    reading.pose.x += 1000;
    odometry.add(reading);
  }
  EXPECT_NEAR(odometry.motionTo(52, *odometry.track().at(52))->mean.x, 10, 1e-9);
  EXPECT_EQ(odometry.track().jumps(), 1u);
}

/// The scan may still be refused.
TEST(ScanOdometry, TheOdometryAtAScanIsKeptOnlyWhenItIsAdded) {
  ScanOdometry odometry{MotionOptions()};
  for (const double time : {50.0, 51.0}) {
    odometry.addAtScan(time, {time, 0, 0});
    odometry.pass(time, odometry.atScan(time, {time, 0, 0}));
  }
  const Pose2D jump{1000, 0, 0}, pose = odometry.atScan(52, jump);
  EXPECT_NEAR(pose.x, 52, 1e-9);
  EXPECT_EQ(odometry.track().jumps(), 0u);
  EXPECT_FALSE(odometry.track().reaches(52));
  odometry.addAtScan(52, jump);
  EXPECT_EQ(odometry.track().jumps(), 1u);
  EXPECT_EQ(odometry.track().at(52)->x, pose.x);
}

/// Hours without a scan must not fill the memory.
TEST_F(OdometryTest, IsKeptForAMinute) {
  Localizer own = started();
  for (const double later : {0.0, 0.2, 30.0, 59.0}) {
    OdometryReading reading = readingAt(0);
    reading.time += later;
    own.addOdometry(reading);
  }
  EXPECT_NO_THROW(step(own, 0));
  Localizer late = started();
  for (const double later : {0.0, 0.2, 30.0, 59.0, 61.0, 90.0, 120.0}) {
    OdometryReading reading = readingAt(0);
    reading.time += later;
    late.addOdometry(reading);
  }
  EXPECT_HAS(messageOf([&] { step(late, 0); }), "no odometry within 0.5 s of the scan");
}

TEST_F(StreetTest, PointsBecomeTheMapOfPoleMapBuild) {
  constexpr std::size_t number = 12;
  importStreet("in", number);
  buildAtTruth();
  const auto truth = io::planar(io::readTum(folder / "in.tum"));
  MapBuilder builder{Settings(config())};
  EXPECT_HAS(messageOf([&] { builder.save(folder / "none.polemap"); }), "no pole found in 0 scans");
  for (std::size_t i = 0; i < number; ++i)
    builder.add(truth[i].time, io::readKittiBin(folder / "in" / "velodyne" / scanName(i)).view(),
                truth[i].pose);
  EXPECT_HAS(messageOf([&] { builder.save(folder / "own.csv"); }), "must end in .polemap");
  builder.save(folder / "own.polemap");
  CPoleMap expected, own;
  expected.loadFromPoleMapFile(at("map.polemap"));
  own.loadFromPoleMapFile(at("own.polemap"));
  ASSERT_GE(own.poles().size(), 4u);
  ASSERT_EQ(own.poles().size(), expected.poles().size());
  for (std::size_t i = 0; i < own.poles().size(); ++i) {
    EXPECT_EQ(own.poles()[i].x, expected.poles()[i].x);
    EXPECT_EQ(own.poles()[i].count, expected.poles()[i].count);
  }
  const auto wrong = [&](double time, double x) {
    return messageOf([&] { builder.add(time, {}, {x, 0, 0}); });
  };
  EXPECT_HAS(wrong(truth[0].time, 0), "time does not increase: scan 12");
  EXPECT_HAS(wrong(truth.back().time + 1, NAN), "the pose of scan 12 is not finite");
}

}  // namespace
}  // namespace polemcl::test_localizer
