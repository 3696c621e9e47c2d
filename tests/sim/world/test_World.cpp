#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>

#include <polemcl/core/common/Types.h>
#include "sim/world/World.h"
#include "support/Worlds.h"

namespace polemcl::test_world {

using namespace polemcl::sim;
using namespace polemcl::tests;

TEST(World, SameSeedSameWorldAndAnotherSeedAnother) {
  const World a = makeWorld(streetOptions(1)), b = makeWorld(streetOptions(1)),
              c = makeWorld(streetOptions(2));
  ASSERT_EQ(a.objects().size(), b.objects().size());
  for (std::size_t i = 0; i < a.objects().size(); ++i) {
    ASSERT_EQ(a.objects()[i].id, b.objects()[i].id);
    ASSERT_EQ(a.objects()[i].centre, b.objects()[i].centre);
    ASSERT_EQ(a.objects()[i].solids.size(), b.objects()[i].solids.size());
  }
  EXPECT_NE(a.objects().size(), c.objects().size());
}

TEST(World, EveryKindStandsSomewhere) {
  std::set<Kind> kinds;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const World world = makeWorld(streetOptions(seed));
    for (const WorldObject& object : world.objects()) kinds.insert(object.kind);
  }
  EXPECT_EQ(kinds.size(), static_cast<std::size_t>(Kind::column) + 1);
}

TEST(World, PolesAreSlimTallAndBesideTheRoad) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const World world = makeWorld(streetOptions(seed));
    EXPECT_GT(world.poles().size(), 60u);
    for (const TruePole& pole : world.poles()) {
      EXPECT_GE(pole.top, 2.0);
      EXPECT_GE(pole.radius, 0.02) << name(pole.kind);
      EXPECT_LE(pole.radius, 0.4) << name(pole.kind);
      EXPECT_GT(world.terrain().edge(pole.x, pole.y), 0) << name(pole.kind);
    }
  }
}

TEST(World, TruthLiesOnTheAxisOfTheTrunk) {
  const World world = makeWorld(streetOptions(4));
  const auto poles = polesById(world);
  int checked = 0;
  for (const WorldObject& object : world.objects()) {
    const auto pole = poles.find(object.id);
    if (pole == poles.end()) continue;
    // The widest post at 1.5 m above the ground.
    const double height = 1.5 + world.terrain().height(pole->second.x, pole->second.y);
    double widest = 0, off = 1e9;
    for (const Solid& solid : object.solids) {
      if (solid.shape != Shape::frustum || solid.axes(2, 2) < 0.9) continue;
      const double along = (height - solid.position.z()) / solid.axes(2, 2);
      if (along < 0 || along > solid.size.z()) continue;
      const double radius =
          solid.size.x() + (solid.size.y() - solid.size.x()) * along / solid.size.z();
      const Eigen::Vector3d place = solid.position + along * solid.axes.col(2);
      if (radius <= widest) continue;
      widest = radius;
      off = std::hypot(place.x() - pole->second.x, place.y() - pole->second.y);
    }
    ASSERT_GT(widest, 0) << name(object.kind);
    EXPECT_LT(off, 0.01) << name(object.kind);
    EXPECT_NEAR(widest, pole->second.radius, 0.005) << name(object.kind);
    ++checked;
  }
  EXPECT_EQ(checked, static_cast<int>(poles.size()));
}

TEST(World, AnotherDayRemovesAFewPolesAddsAFewAndLeavesTheRest) {
  int before = 0, gone = 0, added = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto today = polesById(makeWorld(streetOptions(seed, 0))),
               later = polesById(makeWorld(streetOptions(seed, 3)));
    before += static_cast<int>(today.size());
    for (const auto& [id, pole] : today) {
      const auto same = later.find(id);
      if (same == later.end()) {
        ++gone;
        continue;
      }
      EXPECT_EQ(same->second.x, pole.x);
      EXPECT_EQ(same->second.y, pole.y);
      EXPECT_EQ(same->second.radius, pole.radius);
    }
    for (const auto& pole : later) added += today.count(pole.first) == 0;
  }
  EXPECT_NEAR(static_cast<double>(gone) / before, 0.03, 0.02);
  EXPECT_NEAR(static_cast<double>(added) / before, 0.02, 0.015);
}

TEST(World, CarsAndPeopleAreElsewhereOnAnotherDay) {
  const World today = makeWorld(streetOptions(5, 0)), later = makeWorld(streetOptions(5, 1));
  const auto places = [](const World& world, Kind kind) {
    std::set<std::pair<double, double>> found;
    for (const WorldObject& object : world.objects())
      if (object.kind == kind) found.insert({object.centre.x(), object.centre.y()});
    return found;
  };
  for (const Kind kind : {Kind::car, Kind::person}) {
    const auto a = places(today, kind), b = places(later, kind);
    EXPECT_GT(a.size(), 10u);
    std::vector<std::pair<double, double>> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    EXPECT_TRUE(both.empty()) << name(kind);
  }
  EXPECT_EQ(places(today, Kind::house), places(later, Kind::house));
}

TEST(World, NoPoleStandsInAHouseOrACar) {
  // A road that returns beside itself: houses of one part reach into the gardens of the other.
  const std::string track = testing::TempDir() + "hairpin_" + std::to_string(getpid()) + ".txt";
  {
    std::ofstream file(track);
    for (int i = 0; i <= 250; ++i) file << "1 0 0 " << i << " 0 1 0 0 0 0 1 0\n";
    for (int i = 1; i < 36; ++i) file << "1 0 0 250 0 1 0 " << i << " 0 0 1 0\n";
    for (int i = 250; i >= 0; --i) file << "1 0 0 " << i << " 0 1 0 36 0 0 1 0\n";
  }
  WorldOptions options = streetOptions(6);
  options.track = track;
  const World world = makeWorld(options);
  std::remove(track.c_str());
  EXPECT_GT(world.poles().size(), 50u);
  for (const TruePole& pole : world.poles())
    for (const WorldObject& object : world.objects()) {
      if (object.kind != Kind::house && object.kind != Kind::car) continue;
      for (const Solid& solid : object.solids) {
        if (solid.shape != Shape::box || solid.size.z() < 0.3) continue;
        const Eigen::Vector3d ground(pole.x, pole.y, solid.position.z());
        const Eigen::Vector3d local = solid.axes.transpose() * (ground - solid.position);
        EXPECT_FALSE(std::abs(local.x()) < solid.size.x() && std::abs(local.y()) < solid.size.y() &&
                     solid.position.z() - solid.size.z() <
                         world.terrain().height(pole.x, pole.y) + 1)
            << name(pole.kind) << " in " << name(object.kind);
      }
    }
}

TEST(World, ObjectsWithinEqualsBruteForce) {
  const World world = makeWorld(streetOptions(2));
  for (int i = 0; i < 50; ++i) {
    const Pose2D place = world.street().at(8.0 * i, 3);
    const double radius = 2 + i;
    std::vector<std::uint32_t> expected;
    for (std::size_t k = 0; k < world.objects().size(); ++k) {
      const WorldObject& object = world.objects()[k];
      const double distance = (object.centre - Eigen::Vector2d(place.x, place.y)).norm();
      if (distance <= radius + object.radius) expected.push_back(static_cast<std::uint32_t>(k));
    }
    EXPECT_EQ(world.objectsWithin(place.x, place.y, radius), expected);
  }
}

TEST(World, BareBranchesHaveNoLeaves) {
  WorldOptions options = streetOptions(3);
  options.foliage = 0;
  const World world = makeWorld(options);
  for (const WorldObject& object : world.objects()) {
    if (object.kind != Kind::tree) continue;
    for (const Solid& solid : object.solids) EXPECT_EQ(solid.density, 0);
  }
}

TEST(World, RefusesWhatTheOptionsRefuse) {
  WorldOptions options;
  options.length = -1;
  EXPECT_THROW(makeWorld(options), Error);
}

}  // namespace polemcl::test_world
