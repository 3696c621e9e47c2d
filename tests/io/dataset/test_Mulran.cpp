#include <cmath>

#include "io/data/Trajectory.h"
#include "io/dataset/Mulran.h"
#include "support/IoFiles.h"

namespace polemcl::test_mulran {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

constexpr const char* kNames[] = {"1561000444390857630", "1561000444489636410",
                                  "1561000444590000000"};

/// The vehicle drives and looks east at 10 m/s, in UTM; one row per 10 ms.
std::string drive(int rows) {
  std::string text;
  for (int i = 0; i < rows; ++i) {
    char row[256];
    std::snprintf(row, sizeof row, "%lld,1,0,0,%.4f,0,1,0,4025000.5,0,0,1,19.25\n",
                  1561000444350000000LL + i * 10000000LL, 355000 + 0.1 * i);
    text += row;
  }
  return text;
}

class MulranTest : public FolderTest {
 protected:
  void SetUp() override {
    for (const char* name : kNames)
      write("KAIST01/Ouster/" + std::string(name) + ".bin", floats({1, 2, 3, 100}));
    write("KAIST01/global_pose.csv", drive(40));
  }
  ScanFolder load() const { return readMulran(path("KAIST01"), mulranBaseLidar()); }
};

TEST_F(MulranTest, ReadsScansAndTheVehiclesPoses) {
  const ScanFolder sequence = load();
  ASSERT_EQ(sequence.scans.size(), 3u);
  EXPECT_FALSE(sequence.read);  // rawlogs can refer to these files
  EXPECT_NEAR(sequence.scans[0].time, 1561000444.390857630, 3e-7);
  EXPECT_EQ(sequence.scans[0].cloud.filename(), "1561000444390857630.bin");
  // 40.857630 ms after the first row, at 10 m/s; the first position is 355000 m.
  const Eigen::Isometry3d& pose = *sequence.scans[0].T_map_robot;
  EXPECT_NEAR(pose.translation().x(), 355000 + 10 * 0.04085763, 1e-5);
  EXPECT_NEAR(pose.translation().y(), 4025000.5, 1e-6);
  EXPECT_NEAR(pose.translation().z(), 19.25, 1e-6);
  EXPECT_NEAR(planar(pose).yaw, 0, 1e-9);
  EXPECT_FALSE(sequence.scans[1].motion);
  EXPECT_TRUE(sequence.notes.empty());
}

TEST_F(MulranTest, TheRobotMayBeTheLidar) {
  const ScanFolder sequence = readMulran(path("KAIST01"), Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d& pose = *sequence.scans[0].T_map_robot;
  EXPECT_NEAR(pose.translation().x(), 355000 + 10 * 0.04085763 + 1.7042, 1e-5);
  EXPECT_NEAR(pose.translation().y(), 4025000.5 - 0.021, 1e-6);
  EXPECT_NEAR(pose.translation().z(), 19.25 + 1.8047, 1e-6);
  EXPECT_NEAR(planar(pose).yaw, 179.6654 * M_PI / 180, 1e-9);  // it looks backwards
}

TEST_F(MulranTest, ReadsTheLayoutWithSensorData) {
  fs::create_directories(path("KAIST01/sensor_data"));
  fs::rename(path("KAIST01/Ouster"), path("KAIST01/sensor_data/Ouster"));
  write("KAIST01/sensor_data/ouster_front_stamp.csv",
        std::string(kNames[0]) + "\n" + kNames[1] + "\n1561000444500000000\n" + kNames[2] + "\n");
  const ScanFolder sequence = load();
  ASSERT_EQ(sequence.scans.size(), 3u);
  expectIn(sequence.notes.at(0), "ouster_front_stamp.csv", "1 of its 4 times have no scan");
}

TEST_F(MulranTest, ScansWithoutTruthAreLeftOut) {
  write("KAIST01/global_pose.csv", drive(20));  // the last scan is after its end
  const ScanFolder sequence = load();
  EXPECT_EQ(sequence.scans.size(), 2u);
  expectIn(sequence.notes.at(0), "1 of 3 scans left out, at times without truth");
}

TEST_F(MulranTest, TablesMayBeCompressed) {
  writeGzip(path("KAIST01/global_pose.csv.gz"), read(path("KAIST01/global_pose.csv")));
  fs::remove(path("KAIST01/global_pose.csv"));
  EXPECT_TRUE(load().scans[0].T_map_robot);
}

TEST_F(MulranTest, TheTruthMayBeMissing) {
  fs::remove(path("KAIST01/global_pose.csv"));
  const ScanFolder sequence = load();
  EXPECT_FALSE(sequence.scans[0].T_map_robot);
  expectIn(sequence.notes.at(0), "no global_pose.csv");
}

TEST_F(MulranTest, ReadsPositionsFromSatellites) {
  write("KAIST01/sensor_data/gps.csv",
        "1561000444500000000,36.37,127.36,60,9,0,0,0,16,0,0,0,40\n"
        "1561000444400000000,36.38,127.35,60,0,0,0,0,0,0,0,0,0\n"
        "1561000444600000000,136.38,127.35,60,1,0,0,0,1,0,0,0,1\n");
  const ScanFolder sequence = load();
  ASSERT_EQ(sequence.fixes.size(), 2u) << "one is not on the globe";
  EXPECT_NEAR(sequence.fixes[0].time, 1561000444.4, 1e-6);
  EXPECT_EQ(sequence.fixes[0].sigma, 2.5);
  EXPECT_EQ(sequence.fixes[1].latitude, 36.37);
  EXPECT_EQ(sequence.fixes[1].longitude, 127.36);
  EXPECT_NEAR(sequence.fixes[1].sigma, std::sqrt((9 + 16) / 2.0), 1e-12);
  expectIn(sequence.notes.at(0), "gps.csv: 2 positions from satellites");
  write("KAIST01/sensor_data/gps.csv", "1561000444500000000,36.37,127.36\n");
  EXPECT_REFUSED(load(), "gps.csv:1:");
}

TEST_F(MulranTest, RefusesWhatIsDamaged) {
  write("KAIST01/global_pose.csv", "1,1,0,0,0,0,1,0,0,0,0,1,0\n2,1,0,0\n");
  EXPECT_REFUSED(load(), "global_pose.csv:2: ", "4 numbers, 13 expected");
  write("KAIST01/global_pose.csv", "1,2,0,0,0,0,1,0,0,0,0,1,0\n");
  EXPECT_REFUSED(load(), "global_pose.csv:1: ", "not a rotation");
  write("KAIST01/global_pose.csv", "1,1,0,0,0,0,1,0,0,0,0,1,0\n");
  EXPECT_REFUSED(load(), "global_pose.csv", "no truth at the time of any scan",
                 "1561000444.391 ... 1561000444.590 s");
  write("KAIST01/ouster_front_stamp.csv", std::string(kNames[0]) + "\nx\n");
  EXPECT_REFUSED(load(), "ouster_front_stamp.csv:2: ", "'x' is not a time");
  write("KAIST01/Ouster/" + std::string(kNames[1]) + ".bin", "12345");
  EXPECT_REFUSED(load(), kNames[1], "cut short: 5 bytes");
  fs::remove_all(path("KAIST01/Ouster"));
  EXPECT_REFUSED(load(), path("KAIST01/Ouster").string(), "No such file");
}

}  // namespace
}  // namespace polemcl::test_mulran
