#include <gtest/gtest.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <fstream>
#include <limits>

#include "mrpt/rawlog/GnssFixes.h"
#include "support/Refusal.h"
#include "support/Samples.h"

namespace polemcl::test_gnss_fixes {
namespace {

using namespace mrpt::obs;

constexpr double kStart = 1700000000;  ///< s

/// A receiver's observation, 49° north, 8.5° west, 1 m ahead and 2 m to the left.
CObservationGPS::Ptr received(double time, int quality, std::optional<double> hdop = {}) {
  auto gps = CObservationGPS::Create();
  gps->timestamp = mrpt::Clock::fromDouble(kStart + time);
  gps->sensorPose = mrpt::poses::CPose3D(1, 2, 3);
  gnss::Message_NMEA_GGA gga;
  gga.fields.latitude_degrees = 49;
  gga.fields.longitude_degrees = -8.5;
  gga.fields.fix_quality = static_cast<std::uint8_t>(quality);
  gga.fields.thereis_HDOP = hdop.has_value();
  gga.fields.HDOP = static_cast<float>(hdop.value_or(7));
  gps->setMsg(gga);
  return gps;
}

gnss::Message_NMEA_GGA::content_t& ggaOf(CObservationGPS& gps) {
  return gps.getMsgByClass<gnss::Message_NMEA_GGA>().fields;
}

struct GnssFixesTest : testing::Test {
  std::vector<GnssFix> read(const std::string& bytes, bool allowTruncated = false) const {
    std::ofstream(path, std::ios::binary) << bytes;
    return readGnssFixes(path, allowTruncated);
  }
  std::vector<GnssFix> read(const std::vector<CObservationGPS::Ptr>& observations) const {
    std::string bytes;
    for (const auto& observation : observations) bytes += samples::bytesOf(*observation);
    return read(bytes);
  }
  const testing_apps::TempFolder folder;
  const std::string path = folder / "s.rawlog";
};

TEST_F(GnssFixesTest, ReadsSingleObservationsAndThoseInFramesInOrderOfTime) {
  CSensoryFrame frame;
  frame.insert(std::make_shared<CObservationPoles>(samples::observation()));
  frame.insert(received(2, 1));
  frame.insert(received(0.5, 1));
  const std::string bytes = samples::bytesOf(*received(1, 1)) + samples::bytesOf(frame) +
                            samples::bytesOf(*received(1.5, 1));
  const auto fixes = read(bytes);
  ASSERT_EQ(fixes.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(fixes[i].time, kStart + 0.5 * static_cast<double>(i + 1), 1e-6);
  EXPECT_EQ(fixes[3].latitude, 49);
  EXPECT_EQ(fixes[3].longitude, -8.5);
  EXPECT_EQ(fixes[3].antenna_robot, Eigen::Vector2d(1, 2));
  const std::string cut = bytes.substr(0, bytes.size() - 9);
  EXPECT_REFUSED(read(cut), path, "truncated");
  EXPECT_EQ(read(cut, true).size(), 3u);
}

TEST_F(GnssFixesTest, SigmasAreThoseOfTheQuality) {
  const auto fixes = read({received(1, 1), received(2, 1, 0.5), received(3, 2), received(4, 2, 1.5),
                           received(5, 3, 2), received(6, 4, 2), received(7, 5, 2),
                           received(8, 9, 2), received(9, 1, 0)});
  const std::vector<double> sigmas{2.5, 1.25, 1, 1.5, 5, 0.02, 0.3, 5, 2.5};
  ASSERT_EQ(fixes.size(), sigmas.size());
  for (std::size_t i = 0; i < sigmas.size(); ++i) EXPECT_EQ(fixes[i].sigma, sigmas[i]) << i;
}

TEST_F(GnssFixesTest, LeavesOutWhatIsNoPosition) {
  std::vector<CObservationGPS::Ptr> bad;
  for (const int quality : {0, 6, 7, 8}) bad.push_back(received(1, quality));
  for (int i = 0; i < 6; ++i) bad.push_back(received(1, 1, 1.0));
  bad[4]->timestamp = INVALID_TIMESTAMP;
  bad[5]->messages.clear();
  ggaOf(*bad[6]).latitude_degrees = std::numeric_limits<double>::quiet_NaN();
  ggaOf(*bad[7]).longitude_degrees = 181;
  ggaOf(*bad[8]).HDOP = std::numeric_limits<float>::infinity();
  bad[9]->sensorPose.x(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < bad.size(); ++i)
    EXPECT_EQ(read({received(0, 1), bad[i]}).size(), 1u) << i;
}

TEST_F(GnssFixesTest, WhatIsWrittenIsReadBack) {
  GnssFix fix{kStart + 0.25, -33.5, 151.25, 3.75, {-0.5, 0.25}};
  const auto observation = gnssObservation(fix);
  EXPECT_EQ(observation->sensorLabel, "gnss");
  const auto fixes = read({observation});
  ASSERT_EQ(fixes.size(), 1u);
  EXPECT_EQ(fixes[0].time, fix.time);
  EXPECT_EQ(fixes[0].latitude, fix.latitude);
  EXPECT_EQ(fixes[0].longitude, fix.longitude);
  EXPECT_EQ(fixes[0].sigma, fix.sigma);
  EXPECT_EQ(fixes[0].antenna_robot, fix.antenna_robot);
}

}  // namespace
}  // namespace polemcl::test_gnss_fixes
