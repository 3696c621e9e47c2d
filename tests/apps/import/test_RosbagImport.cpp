#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "config/TimingComment.h"
#include "import/ImportApp.h"
#include "io/data/Trajectory.h"
#include "mrpt/rawlog/GnssFixes.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/RosBags.h"
#include "support/ScanFolders.h"

namespace polemcl::test_rosbag_import {
namespace {

using namespace polemcl::apps;
using namespace polemcl::tests;
using namespace testing_apps;

constexpr double start = 1700000000;

class RosbagImport : public testing::Test {
 protected:
  /// Four scans of a LiDAR that turns left, 0.1 s apart; the robot drives 1 m between two of them.
  void writeBag() {
    TestBag bag(folder / "in" / "in_0.db3");
    const int points = bag.topic("/points", pointCloud2), odom = bag.topic("/odom", odometry2),
              tf = bag.topic("/tf_static", transforms2);
    bag.add(tf, 0, transformsMessage({{"base_link", "lidar", 0.5, 0, 1.75, M_PI / 2}}));
    for (int i = 0; i < 4; ++i) {
      bag.add(points, i, turningCloud(start + 0.1 * i, 1, 0.5, 0, 0.1).message());
      bag.add(odom, i, odometryMessage({start + 0.1 * i, 1.0 * i, 0, 0}));
    }
    writeText(folder / "in" / "metadata.yaml", bagMetadata({"in_0.db3"}));
  }
  Outcome run(std::vector<std::string> more = {}) {
    return runProgram(importMain, importArguments(folder, "rosbag2", std::move(more)));
  }
  TempFolder folder;
};

struct Rawlog {
  ScanTiming timing;
  std::vector<mrpt::obs::CActionRobotMovement2D::Ptr> motions;
  std::vector<mrpt::obs::CObservationPointCloud::Ptr> clouds;
};

Rawlog readRawlog(const fs::path& file) {
  RawlogReader reader(file.string());
  RawlogEntry entry;
  Rawlog result;
  while (reader.next(entry)) {
    result.motions.push_back(entry.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>());
    result.clouds.push_back(
        entry.frame->getObservationByClass<mrpt::obs::CObservationPointCloud>());
  }
  result.timing = timingIn(reader.comment(), file.string());
  return result;
}

TEST_F(RosbagImport, MakesARawlogOfABag) {
  writeBag();
  const Outcome outcome = succeeded(run());
  for (const char* words : {"4 scans; 7200 points, 0 invalid", "truth: none",
                            "odometry: from the dataset", "counterclockwise, cut at"})
    EXPECT_HAS(outcome.out, words);
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "out.rawlog"}));
  EXPECT_EQ(names(folder / "in"), std::vector<std::string>({"in_0.db3", "metadata.yaml"}));
  const Rawlog rawlog = readRawlog(folder / "out.rawlog");
  ASSERT_EQ(rawlog.clouds.size(), 4u);
  EXPECT_EQ(rawlog.timing.turn, Turn::counterclockwise);
  EXPECT_NEAR(rawlog.timing.cut, 0.5, 0.01);
  EXPECT_EQ(rawlog.timing.stamp, 0);
  const auto& cloud = *rawlog.clouds[2];
  EXPECT_NEAR(mrpt::Clock::toDouble(cloud.timestamp), start + 0.2, 1e-6);
  EXPECT_NEAR(cloud.sensorPose.x(), 0.5, 1e-12);
  EXPECT_NEAR(cloud.sensorPose.z(), 1.75, 1e-12);
  EXPECT_NEAR(cloud.sensorPose.yaw(), M_PI / 2, 1e-12);
  const auto points = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(cloud.pointcloud);
  ASSERT_TRUE(points);
  float x, y, z;
  points->getPoint(0, x, y, z);
  EXPECT_EQ(x, static_cast<float>(10 * std::cos(0.5)));
  EXPECT_EQ(z, 1);
  EXPECT_EQ(points->getPointIntensity(0), 7);
  const auto motion = rawlog.motions[2]->poseChange->getMeanVal();
  EXPECT_NEAR(motion.x(), 1, 1e-9);
  EXPECT_NEAR(motion.phi(), 0, 1e-9);
  // dt = 0.1 s and a variance of 0.04 m²/s², with the smallest deviation of 1 mm.
  EXPECT_NEAR(rawlog.motions[2]->poseChange->getCovariance()(0, 0), 0.04 * 0.01 + 1e-6, 1e-8);
}

TEST_F(RosbagImport, StatedPosesAndTimingsComeFirst) {
  writeBag();
  std::string poses;
  for (int i = 0; i < 4; ++i)
    poses += std::to_string(start + 0.1 * i) + " " + std::to_string(i) + " 5 0 0 0 0 1\n";
  writeText(folder / "truth.tum", poses);
  const Outcome outcome = succeeded(run({"--sensor-pose", "1 2 3 0 0 0", "--turn", "clockwise",
                                         "--poses", (folder / "truth.tum").string()}));
  EXPECT_EQ(outcome.out.find("counterclockwise"), std::string::npos) << outcome.out;
  const Rawlog rawlog = readRawlog(folder / "out.rawlog");
  EXPECT_EQ(rawlog.timing.turn, Turn::clockwise);
  EXPECT_EQ(rawlog.clouds[0]->sensorPose.y(), 2);
  EXPECT_NEAR(io::readTum(folder / "out.tum")[3].pose.translation().x(), 3, 1e-5);
  writeText(folder / "in" / "scan_timing.ini", "[scan_timing]\nturn = compensated\n");
  EXPECT_EQ(run().code, 0);
  EXPECT_EQ(readRawlog(folder / "out.rawlog").timing.turn, Turn::compensated);
}

TEST_F(RosbagImport, ChoosesTopics) {
  writeBag();
  {
    TestBag second(folder / "in" / "in_1.db3");
    TestCloud cloud;
    cloud.time = start + 0.1;
    second.add(second.topic("/rear", pointCloud2), 9, cloud.point(1, 2, 3, 4).message());
  }
  fs::remove(folder / "in" / "metadata.yaml");
  expectFailure(run(), {"/points (4 messages), /rear (1 messages)", "--cloud-topic"});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in"}));
  const Outcome outcome = succeeded(run({"--cloud-topic", "/rear", "--odometry-topic", "/odom"}));
  EXPECT_HAS(outcome.out, "1 scans; 1 points");
}

TEST_F(RosbagImport, PositionsFromSatellitesComeBeforeTheNextScan) {
  writeBag();
  {
    TestBag more(folder / "in" / "in_1.db3");
    for (const char* name : {"/fix", "/rtk"}) {
      const int topic = more.topic(name, fix2);
      for (const double time : {0.15, -5.0, 0.2, 9.0})
        more.add(topic, 9, fixMessage({start + time, 49, 8.5, {2, 6}}));
    }
  }
  fs::remove(folder / "in" / "metadata.yaml");
  EXPECT_HAS(run().out, "/fix (4 messages), /rtk (4 messages); none is used");
  EXPECT_TRUE(readGnssFixes((folder / "out.rawlog").string(), false).empty());
  const Outcome outcome = succeeded(run({"--gnss-topic", "/fix"}));
  EXPECT_HAS(outcome.out, "/fix: 4 positions from satellites");

  RawlogReader reader((folder / "out.rawlog").string());
  RawlogEntry entry;
  std::string kinds;
  while (reader.next(entry)) kinds += entry.observation ? 'g' : entry.action ? 's' : '?';
  EXPECT_EQ(kinds, "gssgsgsg");
  const auto fixes = readGnssFixes((folder / "out.rawlog").string(), false);
  ASSERT_EQ(fixes.size(), 4u);
  EXPECT_NEAR(fixes[1].time, start + 0.15, 1e-6);
  EXPECT_EQ(fixes[1].latitude, 49);
  EXPECT_EQ(fixes[1].longitude, 8.5);
  EXPECT_NEAR(fixes[1].sigma, 2, 1e-6);
}

TEST_F(RosbagImport, BadInputAndWrongUsage) {
  writeBag();
  writeText(folder / "in" / "metadata.yaml", bagMetadata({"other.db3.zstd"}, "zstd", "FILE"));
  expectFailure(run(), {"other.db3.zstd: the file is compressed as a whole", "zstd -d"});
  expectUsageError(run({"--imu-topic"}));
  expectUsageError(runProgram(importMain, importArguments(folder, "pcd", {"--cloud-topic", "/p"})));
}

}  // namespace
}  // namespace polemcl::test_rosbag_import
