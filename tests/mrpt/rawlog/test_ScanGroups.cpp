#include <gtest/gtest.h>

#include <sstream>

#include "mrpt/rawlog/ScanGroups.h"

namespace polemcl::test_scan_groups {
namespace {

VehicleOptions vehicle(std::size_t lidars = 2) {
  VehicleOptions options;
  options.lidars.resize(lidars);
  return options;
}

LidarScan scan(std::size_t lidar, double time, std::size_t motions = 0) {
  return {nullptr, lidar, time, 0, motions, {}, {}};
}

/// The groups that these scans complete: `a0.00 b0.03 | a0.10 | `; letters for LiDARs, times.
std::string groups(ScanGroups& groups, const std::vector<LidarScan>& scans, bool ended = false) {
  for (const LidarScan& each : scans) groups.add(each);
  std::ostringstream text;
  text.precision(2);
  text << std::fixed;
  for (auto group = groups.next(ended); !group.empty(); group = groups.next(ended)) {
    for (const LidarScan& each : group)
      text << static_cast<char>('a' + each.lidar) << each.time << ' ';
    text << "| ";
  }
  return text.str();
}

TEST(ScanGroups, AGroupIsCompleteWithTheLastLidar) {
  ScanGroups g(vehicle());
  EXPECT_EQ(groups(g, {scan(0, 0)}), "");
  EXPECT_EQ(groups(g, {scan(1, 0.03)}), "a0.00 b0.03 | ");
}

/// The second LiDAR is 70 ms behind the first, so 30 ms before its next scan.
TEST(ScanGroups, ScansThatAreClosestInTimeBelongTogether) {
  ScanGroups g(vehicle());
  for (int i = 0; i < 3; ++i) {
    g.add(scan(0, 0.1 * i));
    g.add(scan(1, 0.1 * i + 0.07));
  }
  EXPECT_EQ(groups(g, {}) + groups(g, {}, true), "a0.00 | b0.07 a0.10 | b0.17 a0.20 | b0.27 | ");
}

TEST(ScanGroups, ScansMayComeInAnotherOrderThanTheirTimes) {
  ScanGroups g(vehicle());
  EXPECT_EQ(groups(g, {scan(1, 0.03), scan(0, 0.01), scan(1, 0.13), scan(0, 0.11)}),
            "b0.03 a0.01 | b0.13 a0.11 | ");
}

TEST(ScanGroups, AMissedScanDoesNotHoldUpTheOthersForLong) {
  ScanGroups g(vehicle());
  EXPECT_EQ(groups(g, {scan(0, 0), scan(0, 0.1)}), "") << "0.05 s within, 0.1 s waiting";
  EXPECT_EQ(groups(g, {scan(0, 0.2)}), "a0.00 | ");
}

TEST(ScanGroups, ALaterScanOfALidarTellsThatItMissedOne) {
  ScanGroups g(vehicle());
  EXPECT_EQ(groups(g, {scan(0, 0), scan(1, 0.12)}), "a0.00 | ");
}

TEST(ScanGroups, AScanThatComesTooLateIsDropped) {
  ScanGroups g(vehicle());
  groups(g, {scan(0, 0.0), scan(1, 0.12)});
  EXPECT_FALSE(g.add(scan(1, 0.0)));
  EXPECT_TRUE(g.add(scan(0, 0.1)));
  EXPECT_EQ(groups(g, {}), "b0.12 a0.10 | ") << "in the order of arrival";
}

TEST(ScanGroups, OneLidarTwiceIsTwoGroups) {
  ScanGroups g(vehicle());
  EXPECT_EQ(groups(g, {scan(0, 0), scan(0, 0.02), scan(1, 0.03)}), "a0.00 | a0.02 b0.03 | ");
}

TEST(ScanGroups, ScansWithoutAMotionBetweenThemBelongTogether) {
  ScanGroups g(vehicle());
  EXPECT_EQ(groups(g, {scan(0, 0, 1), scan(1, 0.2, 1), scan(0, 0.3, 2), scan(1, 0.5, 3)}, true),
            "a0.00 b0.20 | a0.30 | b0.50 | ");
}

TEST(ScanGroups, ThreeLidarsAndOneThatNeverComes) {
  ScanGroups g(vehicle(3));
  std::string all;
  for (int i = 0; i < 6; ++i) {
    all += groups(g, {scan(0, 0.1 * i), scan(1, 0.1 * i + 0.01)});
  }
  EXPECT_EQ(all, "a0.00 b0.01 | a0.10 b0.11 | a0.20 b0.21 | a0.30 b0.31 | ");
}

}  // namespace
}  // namespace polemcl::test_scan_groups
