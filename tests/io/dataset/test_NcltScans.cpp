#include <algorithm>
#include <cmath>

#include "io/dataset/NcltScans.h"
#include "support/IoFiles.h"
#include "support/NcltSamples.h"

namespace polemcl::test_nclt_scans {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace testing_nclt;

class NcltScansTest : public FolderTest {
 protected:
  std::vector<NcltTurn> find(const std::string& content) {
    notes.clear();
    return findNcltTurns(write("velodyne_hits.bin", content), notes);
  }
  std::vector<std::string> notes;
};

TEST_F(NcltScansTest, ReadsPointsInStepsOfFiveMillimetres) {
  // The first point by hand: 21000 = 5.000 m, 19000 = -5.000 m, 20199 = 0.995 m.
  const std::string bytes("\x08\x52\x38\x4a\xe7\x4e\xc8\x1f", 8);
  const Cloud cloud =
      readNcltSync(write("a.bin", bytes + point(0, 0, 0) + point(-100, 227.675, 1, 255, 0)));
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_FLOAT_EQ(cloud.x[0], 5);
  EXPECT_FLOAT_EQ(cloud.y[0], -5);
  EXPECT_FLOAT_EQ(cloud.z[0], 0.995f);
  EXPECT_EQ(cloud.intensity, (std::vector<float>{200, 255}));
  EXPECT_FLOAT_EQ(cloud.x[1], -100);
  EXPECT_FLOAT_EQ(cloud.y[1], 227.675f);
  EXPECT_EQ(cloud.invalid, 1u);
}

TEST_F(NcltScansTest, RefusesAScanCutShort) {
  EXPECT_REFUSED(readNcltSync(write("a.bin", point(1, 2, 3) + "abc")), "a.bin",
                 "cut short: 11 bytes", "multiple of 8");
}

TEST_F(NcltScansTest, ReadsTheRealScan) {
  POLEMCL_NEEDS_DATA();
  const Cloud cloud = readNcltSync(dataFolder() / "nclt_scan" / "1326652795280148.bin");
  EXPECT_EQ(cloud.size() + cloud.invalid, 188368u / 8);
  // z is down: the ground within 6 m lies about 0.1 m above the origin.
  std::vector<float> z;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (std::hypot(cloud.x[i], cloud.y[i]) < 6 && cloud.z[i] > -0.6f) z.push_back(cloud.z[i]);
  ASSERT_GT(z.size(), 1000u);
  const auto middle = z.begin() + static_cast<std::ptrdiff_t>(z.size() / 2);
  std::nth_element(z.begin(), middle, z.end());
  EXPECT_NEAR(*middle, -0.1, 0.05);
}

TEST_F(NcltScansTest, TurnsEndWhereTheBeamsHaveComeRound) {
  // Slightly more than 10° per packet, 36 packets per revolution: the first revolution has packets
  // 0 … 35, the second 36 … 71, and 8 remain.
  const auto turns = find(turning(80, 10.005));
  const std::uint64_t packetBytes = 24 + 16;
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_EQ(turns[0].offset, 0u);
  EXPECT_EQ(turns[0].bytes, 36 * packetBytes);
  EXPECT_EQ(turns[1].offset, 36 * packetBytes);
  EXPECT_EQ(turns[1].bytes, 36 * packetBytes);
  EXPECT_NEAR(turns[0].begin, start * 1e-6, 1e-6);
  EXPECT_NEAR(turns[0].middle, start * 1e-6 + 0.175, 1e-6);
  EXPECT_NEAR(turns[0].end, start * 1e-6 + 0.35, 1e-6);
  expectIn(notes.at(0), "2 whole turns, 1 incomplete");
}

TEST_F(NcltScansTest, TurnsDoNotDriftWhenStepsDoNotDivideThem) {
  // 7° steps, clockwise: revolutions begin at the first packet at or beyond 360°, 720°, …
  const auto turns = find(turning(210, -7));
  ASSERT_EQ(turns.size(), 4u);
  EXPECT_EQ(turns[1].offset, 52u * 40);
  EXPECT_EQ(turns[2].offset, 103u * 40);
  EXPECT_EQ(turns[3].offset, 155u * 40);
}

TEST_F(NcltScansTest, TurnsWithAPauseAreLeftOut) {
  // 20 packets, a pause of a second, a complete revolution and one more packet.
  const auto turns = find(turning(20, 10.005) + turning(37, 10.005, start + 2000000));
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_EQ(turns[0].offset, 20u * 40);
  expectIn(notes.at(0), "1 whole turns, 2 incomplete");
}

TEST_F(NcltScansTest, RefusesDamagedPackets) {
  const std::string good = turning(80, 10.005);
  EXPECT_REFUSED(find(good.substr(0, good.size() - 3)), "velodyne_hits.bin", "byte 3184",
                 "cut short");
  EXPECT_REFUSED(find(good.substr(0, 3170)), "byte 3160", "cut short");
  std::string damaged = good;
  damaged[40] = 'x';
  EXPECT_REFUSED(find(damaged), "byte 40", "44444");
  damaged = good;
  damaged.replace(8, 4, little(100001, 4));
  EXPECT_REFUSED(find(damaged), "byte 0", "100001 points");
  EXPECT_REFUSED(find(turning(20, 10.005)), "velodyne_hits.bin", "no whole turn");
  EXPECT_REFUSED(find(""), "no whole turn");
  EXPECT_REFUSED(findNcltTurns(path("no.bin"), notes), "no.bin", "No such file");
}

TEST_F(NcltScansTest, PointsOfATurnComeIntoTheBodyFrame) {
  const fs::path file =
      write("h.bin", packet(start, point(10, 0, 0) + point(0, 0, 0) + point(0, 0, 2, 90)));
  const NcltTurn turn{0, 24 + 24, start * 1e-6, start * 1e-6, start * 1e-6};
  const Cloud cloud = readNcltTurn(file, turn, std::nullopt);
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.invalid, 1u);
  // The LiDAR's x looks to the left of the body (y is right), 0.957 m above (z is down).
  EXPECT_NEAR(cloud.x[0], -0.12, 0.01);
  EXPECT_NEAR(cloud.y[0], -10, 0.01);
  EXPECT_NEAR(cloud.z[0], -0.957, 0.03);
  EXPECT_NEAR(cloud.z[1], 2 - 0.957, 0.001);
  EXPECT_EQ(cloud.intensity[1], 90);
}

TEST_F(NcltScansTest, TheMotionOfTheBodyIsTakenOut) {
  // A wall 10 m in front of the body, seen at the begin, middle and end of a revolution. The body
  // moves 2 m: the distances are 11, 10 and 9 m. The LiDAR's -y is the body's -x.
  const Eigen::Isometry3d T_lidar_body = ncltBodyLidar().inverse();
  std::string bytes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d seen = T_lidar_body * Eigen::Vector3d(11 - i, 0, 0);
    bytes +=
        packet(start + static_cast<std::uint64_t>(i) * 50000, point(seen.x(), seen.y(), seen.z()));
  }
  const fs::path file = write("h.bin", bytes);
  const double begin = start * 1e-6;
  const NcltTurn turn{0, bytes.size(), begin, begin + 0.05, begin + 0.1};
  TurnMotion motion;
  motion.T_middle_begin.translation().x() = -1;
  motion.T_middle_end.translation().x() = 1;
  const Cloud still = readNcltTurn(file, turn, std::nullopt),
              moved = readNcltTurn(file, turn, motion);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(still.x[static_cast<std::size_t>(i)], 11 - i, 0.01);
    EXPECT_NEAR(moved.x[static_cast<std::size_t>(i)], 10, 0.01);
  }
}

}  // namespace
}  // namespace polemcl::test_nclt_scans
