// `pole-import nclt`, `mulran`, and `--poses`: from the owners' files to rawlog and truth.

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <algorithm>

#include "extract/ExtractApp.h"
#include "import/DatasetImport.h"
#include "import/ImportApp.h"
#include "io/data/Trajectory.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/NcltSamples.h"
#include "support/ScanFolders.h"

namespace polemcl::test_import_owners {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;
using namespace testing_nclt;

class ImportOwners : public testing::Test {
 protected:
  Outcome run(const std::string& dataset, std::vector<std::string> more = {}) {
    return runProgram(importMain, importArguments(folder, dataset, std::move(more)));
  }
  /// Clouds of the rawlog, loaded.
  std::vector<mrpt::obs::CObservationPointCloud::Ptr> clouds() {
    RawlogReader reader((folder / "out.rawlog").string());
    RawlogEntry entry;
    std::vector<mrpt::obs::CObservationPointCloud::Ptr> all;
    motions.clear();
    while (reader.next(entry)) {
      all.push_back(entry.frame->getObservationByClass<mrpt::obs::CObservationPointCloud>());
      all.back()->load();
      motions.push_back(entry.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>());
    }
    return all;
  }
  /// Three scans 0.2 s apart, a metre north each.
  void writeNclt() {
    std::string truth, track;
    for (unsigned i = 0; i < 3; ++i) {
      const std::uint64_t t = start + i * 200000;
      writeText(folder / "in" / "velodyne_sync" / (std::to_string(t) + ".bin"),
                point(4, 2, -1, 200) + point(0, 0, 0));
      truth += testing_nclt::poseRow(t, 10.0 + i, 20, 0, 0, 0, 0);
      track += testing_nclt::poseRow(t, i, 0, 0, 0, 0, 0);
    }
    writeText(folder / "in" / "groundtruth_2012-01-15.csv", truth);
    writeText(folder / "in" / "odometry_mu_100hz.csv", track);
  }
  TempFolder folder;
  std::vector<mrpt::obs::CActionRobotMovement2D::Ptr> motions;
};

TEST_F(ImportOwners, NcltTakesOneSessionOfSeveral) {
  writeNclt();
  for (const char* date : {"2012-01-15", "2012-01-22"}) {
    fs::create_directories(folder / "all" / "velodyne_data" / date);
    fs::copy(folder / "in" / "velodyne_sync",
             folder / "all" / "velodyne_data" / date / "velodyne_sync",
             fs::copy_options::recursive);
    fs::create_directories(folder / "all" / "ground_truth");
    fs::copy(folder / "in" / "groundtruth_2012-01-15.csv",
             folder / "all" / "ground_truth" / ("groundtruth_" + std::string(date) + ".csv"));
  }
  const auto from = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"nclt", "--input", (folder / "all").string(), "--output",
                               (folder / "out.rawlog").string()});
    return runProgram(importMain, more);
  };
  const Outcome outcome = succeeded(from({"--session", "2012-01-22"}));
  EXPECT_NE(outcome.out.find("3 scans"), std::string::npos) << outcome.out;
  EXPECT_TRUE(fs::exists(folder / "out.tum"));
  expectFailure(from({}), {"velodyne_data", "--session", "2012-01-15, 2012-01-22"});
  expectFailure(from({"--session", "2013-01-10"}), {"2013-01-10", "no such folder"});
  expectUsageError(run("folder", {"--session", "2012-01-22"}));
}

TEST_F(ImportOwners, Nclt) {
  writeNclt();
  const Outcome outcome = succeeded(run("nclt"));
  for (const char* words : {"3 scans; 3 points, 3 invalid", "truth: beside it", "from the dataset"})
    EXPECT_NE(outcome.out.find(words), std::string::npos) << outcome.out;
  fs::remove_all(folder / "in");  // the points are inside
  const auto all = clouds();
  ASSERT_EQ(all.size(), 3u);
  ASSERT_EQ(all[1]->pointcloud->size(), 1u);
  float x = 0, y = 0, z = 0;
  all[1]->pointcloud->getPoint(0, x, y, z);
  EXPECT_FLOAT_EQ(x, 4);  // the body frame, z down …
  EXPECT_FLOAT_EQ(y, 2);
  EXPECT_FLOAT_EQ(z, -1);
  double xRobot = 0, yRobot = 0, zRobot = 0;
  all[1]->sensorPose.composePoint(4, 2, -1, xRobot, yRobot, zRobot);
  EXPECT_NEAR(yRobot, -2, 1e-9);  // … which the sensor pose turns upright
  EXPECT_NEAR(zRobot, 1, 1e-9);
  EXPECT_NEAR(motions[1]->poseChange->getMeanVal().x(), 1, 1e-6);
  const auto truth = io::readTum(folder / "out.tum");
  ASSERT_EQ(truth.size(), 3u);
  EXPECT_TRUE(truth[2].pose.translation().isApprox(Eigen::Vector3d(20, 12, 0), 1e-6));
  EXPECT_NEAR(io::planar(truth[2].pose).yaw, M_PI / 2, 1e-6);
}

TEST_F(ImportOwners, NcltComposesMotionsOfScansThatAreNotTaken) {
  writeNclt();
  EXPECT_EQ(run("nclt", {"--every", "2", "--quiet"}).code, 0);
  ASSERT_EQ(clouds().size(), 2u);
  EXPECT_NEAR(motions[1]->poseChange->getMeanVal().x(), 2, 1e-6);
}

TEST_F(ImportOwners, NcltFailuresNameTheFile) {
  writeNclt();
  writeText(folder / "in" / "groundtruth_2012-01-15.csv", "1,2,3\n");
  expectFailure(run("nclt"), {"groundtruth_2012-01-15.csv:1: ", "7 expected"});
  fs::remove_all(folder / "in" / "velodyne_sync");
  expectFailure(run("nclt"), {"velodyne_sync", "velodyne_hits.bin"});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in"}));
}

TEST_F(ImportOwners, Mulran) {
  for (const char* name : {"1561000444390857630", "1561000444490857630"})
    writeBin(folder / "in" / "Ouster" / (std::string(name) + ".bin"), {{1, 2, 3, 99}});
  writeText(folder / "in" / "global_pose.csv",
            "1561000444390857630,1,0,0,355000,0,1,0,4025000,0,0,1,19\n"
            "1561000444490857630,1,0,0,355001,0,1,0,4025000,0,0,1,19\n");
  const Outcome outcome = succeeded(run("mulran", {"--odometry-noise", "0"}));
  const auto all = clouds();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]->getExternalStorageFile(),
            fs::absolute(folder / "in" / "Ouster" / "1561000444390857630.bin").string());
  EXPECT_NEAR(all[0]->sensorPose.x(), 1.7042, 1e-9);
  EXPECT_NEAR(all[0]->sensorPose.yaw(), 179.6654 * M_PI / 180, 1e-9);
  EXPECT_NEAR(motions[1]->poseChange->getMeanVal().x(), 1, 1e-9);
  EXPECT_NEAR(io::readTum(folder / "out.tum")[1].pose.translation().x(), 355001, 1e-9);
}

TEST_F(ImportOwners, PosesReplaceThoseOfTheDataset) {
  writeLine(folder / "in", 3);  // at 100, 100.1, 100.2 s
  writeText(folder / "p.tum", "100 7 0 0 0 0 0 1\n100.15 9 0 0 0 0 0 1\n");
  const std::string file = (folder / "p.tum").string();
  auto outcome = run("folder", {"--poses", file});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 of 3 scans left out"), std::string::npos) << outcome.out;
  auto truth = io::readTum(folder / "out.tum");
  ASSERT_EQ(truth.size(), 2u);
  EXPECT_NEAR(truth[0].pose.translation().x(), 7, 1e-9);
  outcome =
      run("folder", {"--poses", file, "--poses-of", "sensor", "--sensor-pose", "2 0 0 0 0 0"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NEAR(io::readTum(folder / "out.tum")[0].pose.translation().x(), 5, 1e-9);
  expectUsageError(run("folder", {"--poses", file, "--poses-of", "camera"}));
  expectUsageError(run("folder", {"--poses-of", "robot"}));
  expectFailure(run("folder", {"--poses", (folder / "no.tum").string()}), {"no.tum"});
  // The truth of an earlier import may be poses, but not be replaced meanwhile.
  const std::string before = readText(folder / "out.tum");
  expectFailure(run("folder", {"--poses", (folder / "out.tum").string()}), {"out.tum", "--output"});
  EXPECT_EQ(readText(folder / "out.tum"), before);
}

TEST_F(ImportOwners, PosesForPcdFiles) {
  for (const char* name : {"1.pcd", "2.pcd"})
    writeText(folder / "in" / name,
              "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nDATA ascii\n1 2 3\n");
  writeText(folder / "p.tum", "1e9 7 0 0 0 0 0 1\n1000000000.1 9 0 0 0 0 0 1\n");
  const Outcome outcome = succeeded(run("pcd", {"--poses", (folder / "p.tum").string()}));
  EXPECT_NEAR(io::readTum(folder / "out.tum")[1].time, 1000000000.1, 1e-6);
}

TEST_F(ImportOwners, TheRealNcltScanGivesPolesWithItsConfiguration) {
  POLEMCL_NEEDS_DATA();
  const auto rawlog = (folder / "out.rawlog").string(), csv = (folder / "poles.csv").string();
  const Outcome outcome = succeeded(runProgram(
      importMain, {"nclt", "--input", (dataFolder() / "nclt_scan").string(), "--output", rawlog}));
  const Outcome extracted = succeeded(
      runProgram(extractMain, {"--config", POLEMCL_SOURCE_DIR "/config/nclt.ini", "--input", rawlog,
                               "--output", (folder / "poles.rawlog").string(), "--csv", csv}));
  const std::string rows = readText(csv);
  EXPECT_GE(std::count(rows.begin(), rows.end(), '\n'), 1 + 5) << rows;  // a header, poles
}

}  // namespace
}  // namespace polemcl::test_import_owners
