#include <gtest/gtest.h>

#include <cmath>

#include "sim/common/Random.h"
#include "sim/world/Terrain.h"

namespace polemcl::test_terrain {
namespace {

using namespace polemcl::sim;

WorldOptions flatOptions() {
  WorldOptions options;
  options.relief = 0;
  return options;
}
Street straightStreet() {
  return Street(std::vector<Eigen::Vector2d>{{-100, 0}, {100, 0}});
}
TEST(Terrain, FlatRoadAndKerbByHand) {
  const Terrain terrain(flatOptions(), straightStreet(), {});  // road from y = -5 to 5
  EXPECT_NEAR(terrain.height(0, 0), 0, 1e-6);
  EXPECT_NEAR(terrain.height(10, 4.9), 0, 1e-6);
  EXPECT_NEAR(terrain.height(10, 5.1), 0.12, 1e-6);
  EXPECT_NEAR(terrain.height(10, -8), 0.12, 1e-6);
  EXPECT_NEAR(terrain.edge(0, 0), -5, 0.02);
  EXPECT_NEAR(terrain.edge(3, 6.5), 1.5, 0.02);
  EXPECT_NEAR(terrain.edge(3, 60), 6, 1e-6) << "far from every road";
}

TEST(Terrain, SideRoadsLowerTheGround) {
  const Terrain terrain(flatOptions(), straightStreet(), {{{20, 0}, {20, 50}, 3}});
  EXPECT_NEAR(terrain.height(20, 20), 0, 1e-6);
  EXPECT_NEAR(terrain.height(24, 20), 0.12, 1e-6);
}

TEST(Terrain, RaysOnFlatGroundByHand) {
  const Terrain terrain(flatOptions(), straightStreet(), {});
  const Eigen::Vector3d eye(0, 0, 2);
  const auto down = terrain.intersect(eye, {0, 0, -1}, 100);
  EXPECT_NEAR(down.range, 2, 0.003);
  const double slope = 2.0 / 40;  // forward on the road, 40 m away
  const auto ahead = terrain.intersect(eye, Eigen::Vector3d(1, 0, -slope).normalized(), 100);
  EXPECT_NEAR(ahead.range, std::hypot(40, 2), 0.1);
  const auto aside = terrain.intersect(eye, Eigen::Vector3d(0, 1, -0.2).normalized(), 100);
  EXPECT_NEAR(aside.range, 9.4 * std::hypot(1, 0.2), 0.02) << "0.12 m up, so 1.88 m down";
  EXPECT_GT(aside.edge, 0);
  const auto rim = terrain.intersect(eye, Eigen::Vector3d(0, 5.6, -1.88).normalized(), 100);
  EXPECT_NEAR(rim.range, std::hypot(5.6, 1.88), 0.01) << "on the pavement, close to the kerb";
  EXPECT_FALSE(rim.kerbFace);
  EXPECT_TRUE(std::isinf(terrain.intersect(eye, {1, 0, 0}, 100).range));
  EXPECT_TRUE(std::isinf(terrain.intersect(eye, Eigen::Vector3d(1, 0, 1).normalized(), 100).range));
  EXPECT_TRUE(
      std::isinf(terrain.intersect(eye, Eigen::Vector3d(1, 0, -slope).normalized(), 30).range))
      << "beyond the greatest range";
}

TEST(Terrain, ARayThatWouldPassUnderThePavementMeetsTheKerb) {
  const Terrain terrain(flatOptions(), straightStreet(), {});
  // At y = 5 it is 0.06 m above the road: half way up the kerb.
  const Eigen::Vector3d eye(0, 0, 1), direction = Eigen::Vector3d(0, 5, -0.94).normalized();
  const auto hit = terrain.intersect(eye, direction, 100);
  EXPECT_TRUE(hit.kerbFace);
  EXPECT_NEAR(hit.range * direction.y(), 5, 0.03);
}

TEST(Terrain, HitsLieOnTheGroundAndNothingWasMissedBefore) {
  WorldOptions options;
  options.relief = 1;
  const Street street = Street::make(options);
  const Terrain terrain(options, street, {});
  Random random(7);
  int hits = 0, kerbs = 0;
  for (int i = 0; i < 3000; ++i) {
    const Pose2D place = street.at(random.uniform(50, 250), random.uniform(-3, 3));
    const Eigen::Vector3d eye(place.x, place.y, terrain.height(place.x, place.y) + 1.5);
    const double turn = random.uniform(-M_PI, M_PI), fall = random.uniform(0.05, 0.6);
    const Eigen::Vector3d direction =
        Eigen::Vector3d(std::cos(turn), std::sin(turn), -fall).normalized();
    const auto hit = terrain.intersect(eye, direction, 60);
    const double end = std::isfinite(hit.range) ? hit.range : 60;
    for (double range = 0.5; range < end - 0.3;
         range += 0.1) {  // never below ground before, except for bumps
      const Eigen::Vector3d point = eye + range * direction;
      ASSERT_GT(point.z(), terrain.height(point.x(), point.y()) - 0.03) << "ray " << i;
    }
    if (!std::isfinite(hit.range)) continue;
    ++hits;
    kerbs += hit.kerbFace;
    const Eigen::Vector3d point = eye + hit.range * direction;
    const double above = point.z() - terrain.height(point.x(), point.y());
    ASSERT_NEAR(above, 0, hit.kerbFace ? 0.13 : 0.006) << "ray " << i;
  }
  EXPECT_GT(hits, 2500);
  EXPECT_GT(kerbs, 20);
}

}  // namespace
}  // namespace polemcl::test_terrain
