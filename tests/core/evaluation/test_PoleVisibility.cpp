#include <gtest/gtest.h>

#include "core/evaluation/PoleVisibility.h"

namespace polemcl::test_pole_visibility {
namespace {

struct Cloud {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> labels;
  void add(double px, double py, double pz, std::uint32_t label) {
    x.push_back(static_cast<float>(px));
    y.push_back(static_cast<float>(py));
    z.push_back(static_cast<float>(pz));
    labels.push_back(label);
  }
  /// `count` points above one another, from `low` to `high`.
  void column(double px, double py, int count, double low, double high, std::uint32_t label) {
    for (int i = 0; i < count; ++i) add(px, py, low + (high - low) * i / (count - 1), label);
  }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();
constexpr std::uint32_t kFoliage = 0x80000000u;

TEST(PoleVisibility, SixReturnsOverSixtyCentimetresWithinFortyMetres) {
  Cloud cloud;
  cloud.column(10, 0, 6, 0.0, 0.625, 1);   // just enough
  cloud.column(10, 5, 5, 0.0, 2.0, 2);     // too few
  cloud.column(10, 10, 20, 0.0, 0.59, 3);  // too low
  cloud.column(40.5, 0, 9, 0.0, 2.0, 4);   // too far
  cloud.column(39.5, 3, 9, 0.0, 2.0, 5);
  const std::vector<WorldPole> poles{{1, 10, 0},   {2, 10, 5},   {3, 10, 10},
                                     {4, 40.5, 0}, {5, 39.5, 3}, {6, 5, 5}};
  const auto sights = sightPoles(cloud.view(), cloud.labels, kHere, poles);
  const std::vector<bool> expected{true, false, false, false, true, false};
  for (std::size_t i = 0; i < poles.size(); ++i) EXPECT_EQ(sights[i].visible, expected[i]) << i;
  EXPECT_EQ(sights[2].returns, 20u);
  EXPECT_EQ(sights[5].returns, 0u);
}

TEST(PoleVisibility, FoliageAndOtherThingsDoNotCount) {
  Cloud cloud;
  cloud.column(10, 0, 5, 0.0, 2.0, 7);
  cloud.column(10, 0, 30, 2.0, 5.0, 7 | kFoliage);
  cloud.column(10, 0, 30, 0.0, 2.0, 0);
  const auto sights = sightPoles(cloud.view(), cloud.labels, kHere, {{7, 10, 0}});
  EXPECT_EQ(sights[0].returns, 5u);
  EXPECT_FALSE(sights[0].visible);
}

TEST(PoleVisibility, HeightsAndRangesAreThoseOfTheMap) {
  // The sensor hangs upside down, 3 m up at (100, 50): up in the map is down in the cloud.
  Eigen::Isometry3d pose(Eigen::Translation3d(100, 50, 3));
  pose.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  Cloud cloud;
  for (const double z : {-1.0, 0.0, 0.2, 0.4, 1.0, 2.5}) cloud.add(5, 0, z, 1);
  const auto sights = sightPoles(cloud.view(), cloud.labels, pose, {{1, 105, 50}, {2, 100, 54}});
  EXPECT_NEAR(sights[0].lowest, 0.5, 1e-6);
  EXPECT_NEAR(sights[0].highest, 4.0, 1e-6);
  EXPECT_DOUBLE_EQ(sights[0].sensor, 3);
  EXPECT_NEAR(sights[0].range, 5, 1e-12);
  EXPECT_DOUBLE_EQ(sights[1].lowest, 3);
  EXPECT_NEAR(sights[1].range, 4, 1e-12);
}

TEST(PoleVisibility, APoleIsTakenAtTheHeightOfALeaningSensor) {
  // Nose down by 0.05: the place level with the sensor, 20 m ahead, hardly comes nearer.
  Eigen::Isometry3d pose(Eigen::Translation3d(1, 2, 10));
  pose.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()));
  PoleSight sight;
  sight.sensor = 10;
  sight.visible = true;
  const auto poles = polesInScan({{1, 21, 2, 0.2}}, {sight}, pose.inverse());
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_NEAR(poles[0].x, 20 * std::cos(0.05), 1e-12);
  EXPECT_NEAR(poles[0].y, 0, 1e-12);
  EXPECT_DOUBLE_EQ(poles[0].radius, 0.2);
  EXPECT_TRUE(poles[0].visible);
}

TEST(PoleVisibility, RefusesWhatDoesNotBelongTogether) {
  Cloud cloud;
  cloud.add(1, 0, 0, 1);
  EXPECT_THROW(sightPoles(cloud.view(), {}, kHere, {}), Error);
  EXPECT_THROW(sightPoles(cloud.view(), cloud.labels, kHere, {{1, 0, 0}, {1, 2, 0}}), Error);
}

}  // namespace
}  // namespace polemcl::test_pole_visibility
