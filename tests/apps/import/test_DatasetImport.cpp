#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <limits>

#include <polemcl/core/common/Types.h>
#include "import/DatasetImport.h"
#include "io/data/Trajectory.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/DiskCalls.h"
#include "support/Refusal.h"
#include "support/ScanFolders.h"

namespace polemcl::test_dataset_import {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

struct Pair {
  mrpt::obs::CActionRobotMovement2D::Ptr movement;  ///< null: none in the action
  mrpt::obs::CObservationPointCloud::Ptr cloud;
};

std::vector<Pair> readPairs(const fs::path& file) {
  RawlogReader reader(file.string());
  RawlogEntry entry;
  std::vector<Pair> pairs;
  while (reader.next(entry)) {
    EXPECT_TRUE(entry.action && entry.frame && !entry.observation);
    EXPECT_EQ(entry.frame->size(), 1u);
    pairs.push_back({entry.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>(),
                     entry.frame->getObservationByClass<mrpt::obs::CObservationPointCloud>()});
    EXPECT_TRUE(pairs.back().cloud);
  }
  return pairs;
}

Eigen::Vector3d mean(const Pair& pair) {
  const auto pose = pair.movement->poseChange->getMeanVal();
  return {pose.x(), pose.y(), pose.phi()};
}

Eigen::Matrix3d covariance(const Pair& pair) {
  return pair.movement->poseChange->getCovariance().asEigen();
}

class DatasetImport : public testing::Test {
 protected:
  DatasetImport() {
    options.input = folder / "in";
    options.output = folder / "out.rawlog";
  }
  std::string errorOf() {
    return messageOf([&] { importDataset(options); });
  }
  TempFolder folder;
  ImportOptions options;
};

TEST_F(DatasetImport, KeepsTimesPathsAndTruth) {
  writeLine(options.input, 3);
  const auto report = importDataset(options);
  EXPECT_EQ(report.scans, 3u);
  EXPECT_TRUE(report.hasTruth);
  EXPECT_FALSE(report.hasMotion);

  const auto pairs = readPairs(options.output);
  const auto truth = io::readTum(folder / "out.tum");
  ASSERT_EQ(pairs.size(), 3u);
  ASSERT_EQ(truth.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& cloud = *pairs[i].cloud;
    const double time = mrpt::Clock::toDouble(cloud.timestamp);
    EXPECT_NEAR(time, 100 + 0.1 * static_cast<double>(i), 1e-6);
    EXPECT_NEAR(truth[i].time, time, 1e-9);
    EXPECT_NEAR(truth[i].pose.translation().x(), static_cast<double>(i), 1e-9);
    EXPECT_EQ(cloud.getExternalStorageFile(),
              fs::absolute(options.input / "velodyne" / scanName(i)).string());
    cloud.load();
    EXPECT_EQ(cloud.pointcloud->size(), 2u);
  }
}

TEST_F(DatasetImport, RawlogAndTruthAppearTogether) {
  writeLine(options.input, 3);
  const testing_disk::DiskCalls calls;
  importDataset(options);
  EXPECT_EQ(calls.of("rename"),
            (std::vector<std::string>{"rename out.tum, locked", "rename out.rawlog, locked"}));
}

TEST_F(DatasetImport, FirstActionIsIdentityAndOthersAreEmptyWithoutOdometry) {
  writeLine(options.input, 2);
  importDataset(options);
  const auto pairs = readPairs(options.output);
  ASSERT_EQ(pairs.size(), 2u);
  ASSERT_TRUE(pairs[0].movement);
  EXPECT_EQ(pairs[0].movement->estimationMethod,
            mrpt::obs::CActionRobotMovement2D::emScan2DMatching);
  EXPECT_EQ(mean(pairs[0]).norm(), 0);
  EXPECT_FALSE(pairs[1].movement);
}

TEST_F(DatasetImport, OdometryOfTheFolderSurvives) {
  writeLine(options.input, 3);
  writeText(options.input / "odometry.txt",
            "1.5 0.25 0.5 0.1 0.2 0.3\n2 -1 -0.25 0.4 0.5 0.6 # the last one\n");
  EXPECT_TRUE(importDataset(options).hasMotion);
  const auto pairs = readPairs(options.output);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(mean(pairs[1]), Eigen::Vector3d(1.5, 0.25, 0.5));
  EXPECT_EQ(mean(pairs[2]), Eigen::Vector3d(2, -1, -0.25));
  const Eigen::Vector3d variances(0.4 * 0.4, 0.5 * 0.5, 0.6 * 0.6);
  EXPECT_TRUE(covariance(pairs[2]).isApprox(Eigen::Matrix3d(variances.asDiagonal()), 1e-12));
}

TEST_F(DatasetImport, EveryAndOffsetComposeMotionsAndCovariances) {
  writeLine(options.input, 6);
  writeText(options.input / "odometry.txt",
            "9 9 1 1 1 1\n"  // to scan 1: before the first one taken
            "1 0 1.5707963267948966 0.1 0.2 0.3\n"
            "2 0 0 0.4 0.5 0.6\n"
            "1 0 0 0 0 0\n"
            "0 1 0 0 0 0\n");
  options.every = 2;
  options.offset = 1;  // scans 1, 3, 5
  const auto report = importDataset(options);
  EXPECT_EQ(report.scans, 3u);
  EXPECT_EQ(report.skipped, 3u);
  const auto pairs = readPairs(options.output);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(mean(pairs[0]).norm(), 0);
  // One ahead, a left turn, then two ahead: (1, 2), turned by 90 degrees.
  EXPECT_TRUE(mean(pairs[1]).isApprox(Eigen::Vector3d(1, 2, M_PI / 2), 1e-12));
  // By hand: after the turn the second motion's x error shows in y and its y error in -x; the error
  // of the turn, 0.3 rad, moves the end point by -2 m per rad in x.
  Eigen::Matrix3d expected;
  expected << 0.01 + 0.25 + 4 * 0.09, 0, -2 * 0.09,  //
      0, 0.04 + 0.16, 0,                             //
      -2 * 0.09, 0, 0.09 + 0.36;
  EXPECT_TRUE(covariance(pairs[1]).isApprox(expected, 1e-12)) << covariance(pairs[1]);
  EXPECT_TRUE(mean(pairs[2]).isApprox(Eigen::Vector3d(1, 1, 0), 1e-12));
  EXPECT_NEAR(io::readTum(folder / "out.tum")[1].pose.translation().x(), 3, 1e-9);
}

TEST_F(DatasetImport, NoiseIsRelativeToTheTrueMotionAndSeeded) {
  const std::size_t scans = 2001;
  std::string times, rows;
  for (std::size_t i = 0; i < scans; ++i) {  // 2 m ahead and 0.01 rad to the left each time
    static double x = 0, y = 0;
    if (i == 0) x = y = 0;
    const double yaw = 0.01 * static_cast<double>(i);
    writeBin(options.input / "velodyne" / scanName(i), {{1, 2, 3, 0}});
    times += std::to_string(i) + '\n';
    rows += poseRow(x, y, yaw);
    x += 2 * std::cos(yaw);
    y += 2 * std::sin(yaw);
  }
  writeText(options.input / "times.txt", times);
  writeText(options.input / "poses.txt", rows);
  options.odometryNoise = 0.1;
  options.seed = 7;
  EXPECT_TRUE(importDataset(options).hasMotion);
  const auto bytes = readText(options.output);
  const auto pairs = readPairs(options.output);

  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i < scans; ++i) {
    const Eigen::Vector3d error = mean(pairs[i]) - Eigen::Vector3d(2, 0, 0.01);
    sum += error;
    squares += error.cwiseAbs2();
  }
  const double n = static_cast<double>(scans - 1);
  EXPECT_NEAR(sum.x() / n, 0, 0.02);  // 0.2 / sqrt(2000) = 0.0045
  EXPECT_NEAR(std::sqrt(squares.x() / n), 0.2, 0.01);
  EXPECT_LT(std::sqrt(squares.y() / n), 1e-9);  // no sideways motion, no sideways noise
  EXPECT_NEAR(std::sqrt(squares.z() / n), 0.001, 5e-5);
  EXPECT_NEAR(std::sqrt(covariance(pairs[1])(0, 0)), 0.2, 1e-5);

  importDataset(options);
  EXPECT_EQ(readText(options.output), bytes);
  options.seed = 8;
  importDataset(options);
  EXPECT_NE(readText(options.output), bytes);
}

TEST_F(DatasetImport, OdometryMayErrInAWayThatStays) {
  writeLine(options.input, 3);
  options.odometryNoise = 0;
  options.odometryScale = 0.25;
  options.odometryYaw = 0.125;
  importDataset(options);
  const auto pairs = readPairs(options.output);
  EXPECT_TRUE(mean(pairs[2]).isApprox(Eigen::Vector3d(1.25, 0, 0.125), 1e-12));
  EXPECT_LT(covariance(pairs[2])(0, 0), 1e-5) << "which the covariance does not know";
}

/// Even and odd scans stay apart, whichever the odometry covers.
TEST_F(DatasetImport, ScansAreNumberedBeforeThoseWithoutOdometryAreLeftOut) {
  writeLine(options.input, 6);
  std::string rows;
  for (int i = 1; i < 6; ++i)
    rows += "100." + std::to_string(i) + ' ' + std::to_string(i) + " 0 0 0 0 0 1\n";
  writeText(folder / "path.tum", rows);
  options.odometry = folder / "path.tum";
  options.every = 2;
  for (const std::size_t offset : {0, 1}) {
    options.offset = offset;
    importDataset(options);
    const auto truth = io::readTum(folder / "out.tum");
    ASSERT_EQ(truth.size(), offset == 0 ? 2u : 3u);
    EXPECT_NEAR(truth[0].time, offset == 0 ? 100.2 : 100.1, 1e-6);
  }
}

TEST_F(DatasetImport, NoiseOverridesTheOdometryOfTheFolder) {
  writeLine(options.input, 2);
  writeText(options.input / "odometry.txt", "7 7 1 1 1 1\n");
  options.odometryNoise = 0;
  importDataset(options);
  EXPECT_TRUE(mean(readPairs(options.output)[1]).isApprox(Eigen::Vector3d(1, 0, 0), 1e-12));
}

TEST_F(DatasetImport, EmbeddedCloudsLoseInvalidPointsAndEmptyScans) {
  writeLine(options.input, 4);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  writeBin(options.input / "velodyne" / scanName(1),
           {{1, 2, 3, 0.5f}, {nan, 0, 0, 0}, {0, 0, 0, 1}});
  writeBin(options.input / "velodyne" / scanName(2), {{nan, nan, nan, 0}});
  writeText(options.input / "odometry.txt", "1 0 0 1 1 1\n1 0 0 1 1 1\n1 0 0 1 1 1\n");
  options.embed = true;
  const auto report = importDataset(options);
  EXPECT_EQ(report.scans, 3u);
  EXPECT_EQ(report.emptyScans, 1u);
  EXPECT_EQ(report.points, 5u);
  EXPECT_EQ(report.invalidPoints, 3u);

  fs::remove_all(options.input);  // nothing outside is needed any more
  const auto pairs = readPairs(options.output);
  ASSERT_EQ(pairs.size(), 3u);
  const auto points =
      std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(pairs[1].cloud->pointcloud);
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), 1u);
  float x, y, z;
  points->getPoint(0, x, y, z);
  EXPECT_EQ(std::vector<float>({x, y, z, points->getPointIntensity(0)}),
            std::vector<float>({1, 2, 3, 0.5f}));
  EXPECT_EQ(mean(pairs[2]).x(), 2);  // from scan 1 to scan 3
  EXPECT_EQ(io::readTum(folder / "out.tum").size(), 3u);
}

TEST_F(DatasetImport, EmptyFilesAreDroppedWithoutEmbedding) {
  writeLine(options.input, 3);
  writeBin(options.input / "velodyne" / scanName(1), {});
  const auto report = importDataset(options);
  EXPECT_EQ(report.scans, 2u);
  EXPECT_EQ(report.emptyScans, 1u);
  EXPECT_FALSE(report.notes.empty());
}

TEST_F(DatasetImport, SensorPoseIsStoredAndTakenOffThePoses) {
  writeLine(options.input, 2);
  options.T_robot_sensor = parseSensorPose("1 2 3 90 0 0");
  importDataset(options);
  const auto pose = readPairs(options.output)[0].cloud->sensorPose;
  EXPECT_DOUBLE_EQ(pose.x(), 1);
  EXPECT_DOUBLE_EQ(pose.z(), 3);
  EXPECT_NEAR(pose.yaw(), M_PI / 2, 1e-12);
  // The sensor at (1, 0, 0) looks along the map's x. It looks to the robot's left and sits at
  // (1, 2, 3) there: so the robot looks along -y, and is at (1, 0, 0) + (-2, 1, -3).
  const auto truth = io::readTum(folder / "out.tum");
  EXPECT_TRUE(truth[1].pose.translation().isApprox(Eigen::Vector3d(-1, 1, -3), 1e-8));
  EXPECT_NEAR(io::planar(truth[1].pose).yaw, -M_PI / 2, 1e-8);
}

TEST_F(DatasetImport, ParsesSensorPoses) {
  const auto pose = parseSensorPose(" 1 -2.5 3e-1  0 0 180 ");
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1, -2.5, 0.3)));
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitX()));
  for (const char* text : {"", "1 2 3", "1 2 3 4 5 x", "1 2 3 4 5 nan", "1 2 3 4 5 6 7"})
    EXPECT_THROW(parseSensorPose(text), Error) << text;
}

TEST_F(DatasetImport, WithoutPosesThereIsNoTruth) {
  writeLine(options.input, 2, false);
  EXPECT_FALSE(importDataset(options).hasTruth);
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "out.rawlog"}));
}

TEST_F(DatasetImport, RefusesNoiseWithoutPoses) {
  writeLine(options.input, 2, false);
  options.odometryNoise = 0.02;
  EXPECT_NE(errorOf().find("--odometry-noise needs true poses"), std::string::npos) << errorOf();
}

TEST_F(DatasetImport, RefusesOptionsThatMakeNoSense) {
  writeLine(options.input, 2);
  const ImportOptions good = options;
  options.offset = 2;
  EXPECT_NE(errorOf().find("--offset 2 leaves no scan"), std::string::npos) << errorOf();
  options = good;
  options.every = 0;
  EXPECT_NE(errorOf().find("--every 0"), std::string::npos) << errorOf();
  options = good;
  options.odometryNoise = -0.1;
  EXPECT_NE(errorOf().find("--odometry-noise -0.1"), std::string::npos) << errorOf();
  options = good;
  options.odometryScale = 0.01;
  EXPECT_NE(errorOf().find("--odometry-noise makes"), std::string::npos) << errorOf();
  options.odometryNoise = 0;
  options.odometryScale = 0.6;
  EXPECT_NE(errorOf().find("-0.5 to 0.5"), std::string::npos) << errorOf();
  options = good;
  options.output = folder / "out.tum";
  EXPECT_NE(errorOf().find("must end in .rawlog"), std::string::npos) << errorOf();
}

TEST_F(DatasetImport, RefusesAnOutputBeforeItReadsTheDataset) {
  writeLine(options.input, 2);
  writeText(options.input / "velodyne" / scanName(0), "damaged");
  options.output = folder / "none" / "out.rawlog";
  EXPECT_HAS(errorOf(), "cannot write " + options.output.string());
}

TEST_F(DatasetImport, PathsBehindSymbolicLinksStayWhatTheyAre) {
  writeLine(folder / "real" / "data", 2);
  fs::create_directories(folder / "real" / "b");
  fs::create_directory_symlink(folder / "real" / "b", folder / "link");
  options.input = folder / "link" / ".." / "data";
  importDataset(options);
  const auto cloud = readPairs(options.output).at(0).cloud;
  EXPECT_TRUE(fs::equivalent(cloud->getExternalStorageFile(),
                             folder / "real" / "data" / "velodyne" / scanName(0)));
}

TEST_F(DatasetImport, RefusesWhenAllSelectedScansAreEmpty) {
  writeLine(options.input, 4);
  for (std::size_t i : {1, 3}) writeBin(options.input / "velodyne" / scanName(i), {});
  options.every = 2;
  options.offset = 1;
  EXPECT_NE(errorOf().find("no usable scan"), std::string::npos) << errorOf();
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in"}));
}

TEST_F(DatasetImport, RefusesTimesThatAreNotInSeconds) {
  for (const char* times : {"1700000000000000000\n1700000000100000000\n", "-1\n0\n"}) {
    writeLine(options.input, 2);
    std::ofstream(options.input / "times.txt") << times;
    const std::string error = errorOf();
    EXPECT_NE(error.find("000000.bin has the time "), std::string::npos) << error;
    EXPECT_NE(error.find("seconds from 0 to 1e11 are allowed"), std::string::npos) << error;
    EXPECT_FALSE(fs::exists(options.output));
  }
}

TEST_F(DatasetImport, NotesTimesThatPassForSecondsButAreFarApart) {
  writeLine(options.input, 3);
  const auto notes = [&](const char* times) {
    std::ofstream(options.input / "times.txt") << times;
    return importDataset(options).notes;
  };
  const std::vector<std::string> milliseconds = notes("0\n100\n200\n");
  ASSERT_EQ(milliseconds.size(), 1u);
  EXPECT_HAS(milliseconds[0], "scans are 100 s apart (median): times must be in seconds");
  EXPECT_TRUE(notes("0\n4\n8\n").empty());
}

TEST_F(DatasetImport, RefusesATruncatedScan) {
  writeLine(options.input, 3);
  writeText(options.input / "velodyne" / scanName(2), "17 bytes are bad!");
  EXPECT_NE(errorOf().find("000002.bin"), std::string::npos) << errorOf();
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in"}));
}

TEST_F(DatasetImport, AFailureHalfWayLeavesOldOutputsAsTheyWere) {
  writeLine(options.input, 3);
  writeText(options.output, "old rawlog");
  writeText(folder / "out.tum", "old truth");
  options.embed = true;
  const auto spoil = [&](std::size_t done, std::size_t) {
    if (done == 2) fs::resize_file(options.input / "velodyne" / scanName(2), 17);
  };
  EXPECT_THROW(importDataset(options, spoil), Error);
  EXPECT_EQ(readText(options.output), "old rawlog");
  EXPECT_EQ(readText(folder / "out.tum"), "old truth");
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "out.rawlog", "out.tum"}));
}

TEST_F(DatasetImport, OldOutputsStayUntilTheNewOnesAreComplete) {
  writeLine(options.input, 3);
  writeText(options.output, "old rawlog");
  importDataset(options, [&](std::size_t, std::size_t) {
    EXPECT_EQ(readText(options.output), "old rawlog");
  });
  EXPECT_EQ(readPairs(options.output).size(), 3u);
}

}  // namespace
}  // namespace polemcl::test_dataset_import
