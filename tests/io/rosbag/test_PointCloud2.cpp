#include <limits>

#include "io/rosbag/PointCloud2.h"
#include "support/IoFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_point_cloud2 {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

namespace {

RosCloud decode(const TestCloud& cloud) {
  return decodeCloud(cloud.message(), "a.db3: ", true);
}

std::string refusal(const TestCloud& cloud) {
  return messageOf([&] { decode(cloud); });
}

/// A point at (1, 2, 3) whose time field holds this value.
template <class T>
TestCloud timed(const std::string& name, std::uint8_t type, T time) {
  TestCloud cloud;
  cloud.time = 1700000000.25;
  cloud.fields.push_back({name, 16, type});
  cloud.pointBytes = 16 + sizeof(T);
  cloud.point(1, 2, 3, 4).put(time);
  return cloud;
}

}  // namespace

TEST(PointCloud2, PointsArriveBitByBit) {
  const float tiny = std::numeric_limits<float>::denorm_min(), third = 1.0f / 3;
  for (const bool bigEndian : {false, true}) {
    TestCloud cloud;
    cloud.bigEndian = bigEndian;
    cloud.time = 5.5;
    cloud.point(third, -tiny, 3e38f, 0.1f).point(-0.7f, 8, 9, 255);
    const RosCloud read = decode(cloud);
    EXPECT_EQ(read.header.time, 5.5);
    EXPECT_EQ(read.header.frame, "lidar");
    EXPECT_EQ(read.cloud.x, (std::vector<float>{third, -0.7f}));
    EXPECT_EQ(read.cloud.y, (std::vector<float>{-tiny, 8}));
    EXPECT_EQ(read.cloud.z, (std::vector<float>{3e38f, 9}));
    EXPECT_EQ(read.cloud.intensity, (std::vector<float>{0.1f, 255}));
    EXPECT_TRUE(read.offsets.empty());
  }
}

TEST(PointCloud2, FieldsInAnyOrderAndRowsWithPadding) {
  TestCloud cloud;
  cloud.fields = {{"ring", 0, 4}, {"intensity", 2, 4}, {"z", 4, 7}, {"y", 8, 7}, {"x", 12, 7}};
  cloud.height = 2;
  cloud.width = 1;
  cloud.rowBytes = 20;  // four bytes of padding
  cloud.put(std::uint16_t{9}).put(std::uint16_t{300}).put(3.f).put(2.f).put(1.f).put(99.f);
  cloud.put(std::uint16_t{9}).put(std::uint16_t{7}).put(6.f).put(5.f).put(4.f).put(99.f);
  const RosCloud read = decode(cloud);
  EXPECT_EQ(read.cloud.x, (std::vector<float>{1, 4}));
  EXPECT_EQ(read.cloud.z, (std::vector<float>{3, 6}));
  EXPECT_EQ(read.cloud.intensity, (std::vector<float>{300, 7}));
}

TEST(PointCloud2, InvalidPointsAreCountedAndEmptyCloudsAreEmpty) {
  TestCloud cloud;
  cloud.point(std::numeric_limits<float>::quiet_NaN(), 0, 0, 1).point(0, 0, 0, 1);
  EXPECT_EQ(decode(cloud).cloud.invalid, 2u);
  EXPECT_EQ(decode(TestCloud{}).cloud.size(), 0u);
}

TEST(PointCloud2, TimesOfAllKinds) {
  const double stamp = 1700000000.25;
  EXPECT_NEAR(decode(timed("t", 6, std::uint32_t{50000000})).offsets.at(0), 0.05, 1e-12);
  EXPECT_NEAR(decode(timed("time", 7, -0.03f)).offsets.at(0), -0.03, 1e-8);
  EXPECT_NEAR(decode(timed("offset_time", 8, 0.02)).offsets.at(0), 0.02, 1e-12);
  EXPECT_NEAR(decode(timed("timestamp", 8, stamp + 0.08)).offsets.at(0), 0.08, 1e-6);
  EXPECT_NEAR(decode(timed("time_stamp", 8, (stamp + 0.08) * 1e9)).offsets.at(0), 0.08, 1e-6);
  EXPECT_TRUE(decodeCloud(timed("t", 6, std::uint32_t{5}).message(), "", false).offsets.empty());
  EXPECT_NEAR(decode(timed("t", 8, (stamp + 0.08) * 1e3)).offsets.at(0), 0.08, 1e-6);
  EXPECT_NEAR(decode(timed("t", 8, (stamp + 0.08) * 1e6)).offsets.at(0), 0.08, 1e-6);
}

TEST(PointCloud2, TimesOfASimulatedClock) {
  TestCloud cloud = timed("timestamp", 8, 10.05);
  cloud.time = 10;
  EXPECT_NEAR(decode(cloud).offsets.at(0), 0.05, 1e-12);
}

TEST(PointCloud2, TimesThatAreNoneLeaveThePoints) {
  TestCloud cloud = timed("t", 8, 0.05);
  cloud.point(1, 2, 3, 4).put(std::nan(""));
  for (const TestCloud& untimed : {cloud, timed("t", 4, std::uint16_t{5})}) {
    const RosCloud read = decode(untimed);
    EXPECT_EQ(read.cloud.size(), untimed.width);
    EXPECT_TRUE(read.offsets.empty());
  }
}

TEST(PointCloud2, CoordinatesOfDoublePrecision) {
  TestCloud cloud;
  cloud.fields = {{"x", 0, 8}, {"y", 8, 8}, {"z", 16, 8}};
  cloud.pointBytes = 24;
  cloud.width = 1;
  cloud.put(1.5).put(-2.0).put(0.25);
  EXPECT_EQ(decode(cloud).cloud.y, std::vector<float>{-2});
}

TEST(PointCloud2, RefusesSizesThatDoNotFit) {
  TestCloud good;
  good.point(1, 2, 3, 4).point(1, 2, 3, 4);
  TestCloud bad = good;
  bad.width = 3;
  expectIn(refusal(bad), "a.db3: cut short: 32 bytes of points; 1 rows of 3 points of 16 bytes");
  bad = good;
  bad.height = bad.width = 0xffffffff;
  bad.rowBytes = 16;
  expectIn(refusal(bad), "cut short");
  bad = good;
  bad.pointBytes = 0;
  expectIn(refusal(bad), "points of 0 bytes");
  bad = good;
  bad.fields[2].offset = 13;
  expectIn(refusal(bad), "the field z lies outside its point of 16 bytes");
  bad = good;
  bad.fields[1].type = 5;
  expectIn(refusal(bad), "no field y of float32 or float64");
  bad = good;
  bad.fields[3].type = 9;
  expectIn(refusal(bad), "the field intensity has the type 9; 1 to 8");
  const std::string message = good.message();
  for (std::size_t size = 0; size < message.size(); ++size)
    EXPECT_REFUSED(decodeCloud(message.substr(0, size), "a.db3: ", true), "a.db3: ", "cut short");
}

}  // namespace polemcl::test_point_cloud2
