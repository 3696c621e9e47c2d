#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "sim/drive/Drive.h"
#include "support/Refusal.h"

namespace polemcl::test_detour {
namespace {

using namespace polemcl::sim;

SimulationOptions withSideStreets(std::uint64_t seed, int detour) {
  SimulationOptions options;
  options.world.seed = seed;
  options.world.length = 700;
  options.world.sideStreets = 2;
  options.detour = detour;
  return options;
}

std::vector<Eigen::Vector2d> placesOf(const Drive& drive) {
  std::vector<Eigen::Vector2d> places;
  for (const auto& pose : drive.T_map_sensor) places.emplace_back(pose.translation().head<2>());
  return places;
}

double distance(const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& place) {
  double best = 1e9;
  for (const auto& other : places) best = std::min(best, (other - place).norm());
  return best;
}

double yawOf(const Eigen::Isometry3d& pose) {
  return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

class Detours : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Detours, LeaveTheStreetAndComeBackWithoutAJerk) {
  const World world = makeWorld(withSideStreets(GetParam(), 0).world);
  ASSERT_EQ(world.detours().size(), 2u);
  const auto straight = placesOf(makeDrive(world, withSideStreets(GetParam(), 0)));
  for (const int detour : {1, 2}) {
    const Drive drive = makeDrive(world, withSideStreets(GetParam(), detour));
    const auto places = placesOf(drive);
    // The sway of a drive depends on its path length: 0.12 m to each side.
    EXPECT_LT((places.front() - straight.front()).norm(), 0.6);
    EXPECT_LT((places.back() - straight.back()).norm(), 1.6);
    double farthest = 0, away = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double far = distance(straight, places[i]);
      farthest = std::max(farthest, far);
      away += far > 3 ? 0.5 : 0;
      EXPECT_LT(world.terrain().edge(places[i].x(), places[i].y()), -1.0) << "on a road";
      if (i == 0) continue;
      EXPECT_NEAR((places[i] - places[i - 1]).norm(), 0.5, 0.12) << i;
      const double turn =
          wrapAngle(yawOf(drive.T_map_sensor[i]) - yawOf(drive.T_map_sensor[i - 1]));
      EXPECT_LT(std::abs(turn), 0.12) << "at most a radius of 4 m";
      EXPECT_LT(std::abs(drive.T_map_sensor[i].translation().z() -
                         drive.T_map_sensor[i - 1].translation().z()),
                0.08)
          << "the ground has no steps";
    }
    EXPECT_GT(farthest, 45);
    EXPECT_GT(away, 150);
    EXPECT_LT(away, 280);
  }
}

TEST_P(Detours, HaveTheirOwnPolesThatTheStreetNeverSees) {
  const World world = makeWorld(withSideStreets(GetParam(), 0).world);
  const auto straight = placesOf(makeDrive(world, withSideStreets(GetParam(), 0)));
  std::vector<std::vector<Eigen::Vector2d>> own(2);
  for (const int detour : {1, 2}) {
    const auto places = placesOf(makeDrive(world, withSideStreets(GetParam(), detour)));
    for (const TruePole& pole : world.poles()) {
      const Eigen::Vector2d place(pole.x, pole.y);
      if (distance(places, place) < 15 && distance(straight, place) > 20)
        own[detour - 1].push_back(place);
      EXPECT_GT(world.terrain().edge(pole.x, pole.y), 0) << "beside every road";
    }
    EXPECT_GT(own[detour - 1].size(), 15u);
  }
  for (const auto& place : own[0]) EXPECT_GT(distance(own[1], place), 40);
}

TEST_P(Detours, NothingStandsInTheirWay) {
  const World world = makeWorld(withSideStreets(GetParam(), 0).world);
  for (const int detour : {1, 2})
    for (double s = 0; s < world.path(detour).length(); s += 1) {
      for (const double lateral : {-2.5, 0.0}) {
        const Pose2D place = world.path(detour).at(s, lateral);
        for (const std::uint32_t i : world.objectsWithin(place.x, place.y, 1)) {
          const WorldObject& object = world.objects()[i];
          for (const Solid& solid : object.solids) {
            if (solid.shape != Shape::box || solid.size.head<2>().maxCoeff() < 0.5) continue;
            if (solid.position.z() - solid.size.z() >
                world.terrain().height(place.x, place.y) + 2.5)
              continue;
            const Eigen::Vector3d local =
                solid.axes.transpose() *
                (Eigen::Vector3d(place.x, place.y, solid.position.z()) - solid.position);
            EXPECT_FALSE(std::abs(local.x()) < solid.size.x() &&
                         std::abs(local.y()) < solid.size.y())
                << name(object.kind) << " at " << s << " of detour " << detour;
          }
        }
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Detours, testing::Values(61, 62, 63));

TEST(Detour, TheStreetItselfIsDrivenAsWithoutSideStreets) {
  SimulationOptions options = withSideStreets(64, 0);
  options.world.relief = 0;  // the grid of bumps starts elsewhere
  const auto with = placesOf(makeDrive(makeWorld(options.world), options));
  options.world.sideStreets = 0;
  const auto without = placesOf(makeDrive(makeWorld(options.world), options));
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_LT((with[i] - without[i]).norm(), 1e-9);
}

TEST(Detour, RefusesAStreetWithoutRoomAndASideStreetThatIsNotThere) {
  SimulationOptions options = withSideStreets(65, 0);
  options.world.length = 300;
  EXPECT_REFUSED(makeWorld(options.world), "400 m");
  options.world.sideStreets = 1;
  options.detour = 2;
  EXPECT_THROW(options.validate(), Error);
}

}  // namespace
}  // namespace polemcl::test_detour
