#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <sys/resource.h>

#include <csignal>

#include "import/ImportApp.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/ScanFolders.h"

namespace polemcl::test_import_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// While it lives, files can grow to one megabyte, and no further: as on a full disk.
class SmallDisk {
 public:
  SmallDisk() {
    m_handler = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &m_limit);
    rlimit small = m_limit;
    small.rlim_cur = 1 << 20;
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &m_limit);
    std::signal(SIGXFSZ, m_handler);
  }

 private:
  void (*m_handler)(int);
  rlimit m_limit{};
};

class ImportApp : public testing::Test {
 protected:
  Outcome run(const std::string& dataset, std::vector<std::string> more = {}) {
    return runProgram(importMain, importArguments(folder, dataset, std::move(more)));
  }
  TempFolder folder;
};

std::string commentOf(const fs::path& rawlog) {
  polemcl::RawlogReader reader(rawlog.string());
  polemcl::RawlogEntry entry;
  reader.next(entry);
  return reader.comment();
}

TEST_F(ImportApp, KeepsTheMeasuringTimesInTheRawlog) {
  writeLine(folder / "in", 2);
  EXPECT_EQ(run("folder").code, 0);
  EXPECT_EQ(commentOf(folder / "out.rawlog"), "") << "nothing is known of them";
  const std::vector<std::string> stated{
      "--turn", "counterclockwise", "--cut-deg", "-90", "--turn-s", "0.05", "--stamp-turn", "1"};
  EXPECT_EQ(run("folder", stated).code, 0);
  const std::string comment = commentOf(folder / "out.rawlog");
  for (const char* line :
       {"turn = counterclockwise", "cut_deg = -90", "turn_s = 0.05", "stamp_turn = 1"})
    EXPECT_HAS(comment, line);
  EXPECT_EQ(run("folder", {"--turn", "clockwise", "--moving-cut"}).code, 0);
  EXPECT_HAS(commentOf(folder / "out.rawlog"), "moving_cut = true");
  EXPECT_EQ(run("folder", {"--turn", "clockwise", "--moving-cut", "--cut-deg", "9"}).code, 2);
  writeText(folder / "in" / "scan_timing.ini", "[scan_timing]\nturn = clockwise\n");
  EXPECT_EQ(run("folder").code, 0);
  EXPECT_HAS(commentOf(folder / "out.rawlog"), "turn = clockwise");
  EXPECT_EQ(run("folder", stated).code, 0);
  EXPECT_HAS(commentOf(folder / "out.rawlog"), "turn = counterclockwise");
  writeText(folder / "in" / "scan_timing.ini", "[scan_timing]\nturn = around\n");
  expectFailure(run("folder"), {"scan_timing.ini", "turn = around"});
  writeText(folder / "in" / "scan_timing.ini",
            "; [scan_timing]\n[scan-timing]\nturn = clockwise\n");
  expectFailure(run("folder"), {"scan_timing.ini", "no section [scan_timing]"});
  EXPECT_EQ(run("folder", {"--cut-deg", "90"}).code, 2) << "needs --turn";
}

TEST_F(ImportApp, NotesPosesThatClimbLikeThoseOfACamera) {
  writeLine(folder / "in", 3);
  writeText(folder / "in" / "poses.txt",
            "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0.1 0 0 1 3\n1 0 0 0 0 1 0 0 0 0 1 6\n");
  EXPECT_HAS(run("folder").out, "note: the true poses span 6.0 m in z and 0.1 m in x and y");
  writeText(folder / "in" / "poses.txt",
            "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 29 0 1 0 0 0 0 1 3\n1 0 0 0 0 1 0 0 0 0 1 6\n");
  EXPECT_HAS(run("folder").out, "note: the true poses span 6.0 m in z and 29.0 m in x and y");
  writeText(folder / "in" / "poses.txt",
            "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 31 0 1 0 0 0 0 1 3\n1 0 0 0 0 1 0 0 0 0 1 6\n");
  EXPECT_EQ(run("folder").out.find("note:"), std::string::npos) << "a steep street";
}

TEST_F(ImportApp, ImportsPcdFilesIntoTheRawlog) {
  for (const char* name : {"1.pcd", "2.pcd"})
    writeText(folder / "in" / name,
              "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nDATA ascii\n1 2 3\nnan 0 0\n");
  const Outcome outcome = succeeded(run("pcd"));
  for (const char* words : {"2 scans; 2 points, 2 invalid", "truth: none",
                            "to localize, give --odometry", "0.1 s apart"})
    EXPECT_NE(outcome.out.find(words), std::string::npos) << outcome.out;
  fs::remove_all(folder / "in");  // the points are inside
  polemcl::RawlogReader reader((folder / "out.rawlog").string());
  polemcl::RawlogEntry entry;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(reader.next(entry));
    const auto cloud = entry.frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
    ASSERT_TRUE(cloud && cloud->pointcloud);
    EXPECT_EQ(cloud->pointcloud->size(), 1u);
  }
}

TEST_F(ImportApp, DamagedPcdFilesAreLeftOutIfAsked) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nDATA ascii\n";
  for (const char* name : {"1.pcd", "3.pcd"}) writeText(folder / "in" / name, head + "1 2 3\n");
  writeText(folder / "in" / "2.pcd", head);
  expectFailure(run("pcd"), {"2.pcd", "cut short", "--skip-damaged leaves such scans out"});
  const Outcome outcome = succeeded(run("pcd", {"--skip-damaged"}));
  for (const char* words : {"2 scans, 1 damaged ones left out", "note: left out: ", "2.pcd"})
    EXPECT_HAS(outcome.out, words);
  EXPECT_EQ(outcome.out.find("empty"), std::string::npos) << outcome.out;
  for (const char* name : {"1.pcd", "3.pcd"}) writeText(folder / "in" / name, head);
  expectFailure(run("pcd", {"--skip-damaged"}), {"all 3 selected ones are empty or damaged"});
  expectFailure(run("folder"), {"no folder velodyne", "`pole-import pcd`"});
}

TEST_F(ImportApp, ImportsAFolder) {
  writeLine(folder / "in", 3);
  const Outcome outcome =
      succeeded(run("folder", {"--every", "2", "--odometry-noise", "0.02", "--seed", "7"}));
  EXPECT_NE(outcome.out.find("2 scans, 1 left out"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("true motion with noise"), std::string::npos) << outcome.out;
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "out.rawlog", "out.tum"}));
}

TEST_F(ImportApp, ImportsKittiOdometry) {
  writeLine(folder / "in", 2);
  // The camera looks along the LiDAR's x: camera x is -y, camera y is -z, camera z is x.
  writeText(folder / "in" / "calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  writeText(folder / "in" / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2.5\n");
  const Outcome outcome = succeeded(run("kitti-odometry", {"--quiet"}));
  EXPECT_EQ(outcome.out, "");
  const auto truth = readText(folder / "out.tum");
  EXPECT_NE(truth.find(" 2.5"), std::string::npos) << truth;
}

TEST_F(ImportApp, ImportsKittiRawWithTheCalibrationOfItsDate) {
  const auto drive = folder / "date" / "drive";
  for (int i = 0; i < 2; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "%010d", i);
    writeBin(drive / "velodyne_points" / "data" / (std::string(name) + ".bin"), {{1, 2, 3, 0}});
    writeText(drive / "oxts" / "data" / (std::string(name) + ".txt"),
              "49.0 8.4 110 0 0 0.5 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n");
  }
  const std::string times = "2011-09-26 13:02:25.500000000\n2011-09-26 13:02:25.600000000\n";
  writeText(drive / "velodyne_points" / "timestamps.txt", times);
  writeText(drive / "oxts" / "timestamps.txt", times);
  writeText(folder / "date" / "calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
  const std::vector<std::string> arguments{"kitti-raw", "--input", drive.string() + "/", "--output",
                                           (folder / "out.rawlog").string()};
  auto outcome = runProgram(importMain, arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_HAS(commentOf(folder / "out.rawlog"), "turn = clockwise") << "raw scans";
  auto here = arguments;
  here[2] = (drive / ".").string();
  EXPECT_EQ(runProgram(importMain, here).err, "");
  fs::rename(folder / "date" / "calib_imu_to_velo.txt", folder / "calib_imu_to_velo.txt");
  expectFailure(runProgram(importMain, arguments), {"calib_imu_to_velo.txt"});
  auto elsewhere = arguments;
  elsewhere.insert(elsewhere.end(), {"--calib", folder.path().string()});
  outcome = runProgram(importMain, elsewhere);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(ImportApp, TakesASensorPoseThatStartsWithAMinus) {
  writeLine(folder / "in", 2);
  const Outcome outcome = succeeded(run("folder", {"--sensor-pose", "-1.5 0 0 0 0 0"}));
  EXPECT_NE(readText(folder / "out.tum").find(" 1.5"), std::string::npos);
}

TEST_F(ImportApp, ReportsWhatWasDropped) {
  writeLine(folder / "in", 3);
  writeBin(folder / "in" / "velodyne" / scanName(1), {{0, 0, 0, 0}});
  const Outcome outcome = succeeded(run("folder", {"--embed"}));
  EXPECT_NE(outcome.out.find("1 empty ones dropped"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("1 invalid ones dropped"), std::string::npos) << outcome.out;
}

TEST_F(ImportApp, FailuresNameTheFile) {
  expectFailure(run("folder"), {(folder / "in").string()});
  writeLine(folder / "in", 3);
  writeText(folder / "in" / "poses.txt", poseRow(0, 0, 0) + poseRow(1, 0, 0));
  expectFailure(run("folder"), {"poses.txt", "2", "3"});
  writeLine(folder / "in", 3);
  fs::resize_file(folder / "in" / "velodyne" / scanName(2), 20);
  expectFailure(run("folder"), {scanName(2), "20"});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in"}));
}

TEST_F(ImportApp, FailsWhenTheOutputCannotBeWritten) {
  writeLine(folder / "in", 2);
  const auto outcome = runProgram(importMain, {"folder", "--input", (folder / "in").string(),
                                               "--output", (folder / "no/out.rawlog").string()});
  expectFailure(outcome, {"no"});
}

TEST_F(ImportApp, AFullDiskLeavesTheOldOutput) {
  writeLine(folder / "in", 3);
  writeBin(folder / "in" / "velodyne" / scanName(2), Points(100000, {1, 2, 3, 0}));
  writeText(folder / "out.rawlog", "old");
  Outcome outcome;
  {
    const SmallDisk small;
    outcome = run("folder", {"--embed"});
  }
  expectFailure(outcome, {"out.rawlog"});
  EXPECT_EQ(readText(folder / "out.rawlog"), "old");
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "out.rawlog"}));
  EXPECT_EQ(run("folder", {"--embed"}).code, 0);
}

TEST_F(ImportApp, WrongUsage) {
  writeLine(folder / "in", 2);
  expectUsageError(runProgram(importMain, {}));
  expectUsageError(runProgram(importMain, {"folder", "--input", "a"}));
  expectUsageError(run("floder"));
  expectUsageError(run("folder", {"--every", "0"}));
  expectUsageError(run("folder", {"--every", "2.5"}));
  expectUsageError(run("folder", {"--offset", "-1"}));
  expectUsageError(run("folder", {"--odometry-noise", "-0.1"}));
  expectUsageError(run("folder", {"--sensor-pose", "1 2 3"}));
  expectUsageError(run("folder", {"--calib", "x"}));
}

TEST_F(ImportApp, ImportsRealScans) {
  POLEMCL_NEEDS_DATA();
  const Outcome outcome = succeeded(
      runProgram(importMain, {"folder", "--input", (dataFolder() / "kitti_raw_0005").string(),
                              "--output", (folder / "out.rawlog").string(), "--every", "2"}));
  EXPECT_NE(outcome.out.find(" 40 scans"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("odometry: from the dataset"), std::string::npos) << outcome.out;
}

TEST_F(ImportApp, TheTruthReplacesNoInput) {
  writeText(folder / "s.tum", "0 1 2 0 0 0 0 1\n");
  expectFailure(runProgram(importMain, {"folder", "--input", (folder / "in").string(), "--poses",
                                        (folder / "s.tum").string(), "--output",
                                        (folder / "s.rawlog").string()}),
                {"--output", "s.tum: is an input (--poses)"});
}

}  // namespace
}  // namespace polemcl::test_import_app
