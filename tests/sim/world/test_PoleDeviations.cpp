#include <gtest/gtest.h>

#include <set>

#include "sim/world/StreetObjects.h"
#include "sim/world/World.h"

namespace polemcl::test_pole_deviations {
namespace {

using namespace polemcl::sim;

const Site kSite{{10, 20, 3}, 0.7};

Piece sign() {
  Random random(5);
  return makeSign(kSite, 7, random);
}

/// All rates zero but one.
RealismOptions only(double RealismOptions::*rate) {
  RealismOptions realism;
  realism.scale = 1;
  for (auto each : {&RealismOptions::crooked, &RealismOptions::tapered, &RealismOptions::leaning,
                    &RealismOptions::multiple, &RealismOptions::boxes, &RealismOptions::ivy,
                    &RealismOptions::hedges})
    realism.*each = 0;
  realism.*rate = 1;
  return realism;
}

std::vector<Piece> with(double RealismOptions::*rate, std::uint64_t seed = 1) {
  return deviating(sign(), kSite, only(rate), Random(seed));
}

/// Middle of the posts' axes at a height above ground, and the radius there.
Eigen::Vector3d axisAt(const WorldObject& object, double height) {
  for (const Solid& solid : object.solids) {
    const Eigen::Vector3d up = solid.axes.col(2);
    const double share = (kSite.base.z() + height - solid.position.z()) / (solid.size.z() * up.z());
    if (solid.shape != Shape::frustum || share < 0 || share > 1) continue;
    const Eigen::Vector3d place = solid.position + share * solid.size.z() * up;
    return {place.x(), place.y(), solid.size.x() + share * (solid.size.y() - solid.size.x())};
  }
  return {0, 0, 0};
}

TEST(PoleDeviations, TruthIsTheAxisAtOneAndAHalfMetres) {
  for (auto rate : {&RealismOptions::crooked, &RealismOptions::tapered, &RealismOptions::leaning})
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const auto pieces = with(rate, seed);
      ASSERT_EQ(pieces.size(), 1u);
      const Eigen::Vector3d axis = axisAt(pieces[0].object, 1.5);
      EXPECT_NEAR(pieces[0].pole->x, axis.x(), 0.006);
      EXPECT_NEAR(pieces[0].pole->y, axis.y(), 0.006);
      EXPECT_NEAR(pieces[0].pole->radius, axis.z(), 0.003);
    }
}

TEST(PoleDeviations, BentLeaningAndTaperedPostsAreSo) {
  const Piece straight = sign();
  const auto offset = [&](const Piece& piece, double height) {
    return (axisAt(piece.object, height) - axisAt(straight.object, height)).head<2>().norm();
  };
  EXPECT_GT(offset(with(&RealismOptions::crooked)[0], 1.2), 0.03);
  EXPECT_GT(offset(with(&RealismOptions::leaning)[0], 2), 0.05);
  const Piece tapered = with(&RealismOptions::tapered)[0];
  EXPECT_GT(axisAt(tapered.object, 0.1).z(), 1.3 * axisAt(tapered.object, 2).z());
}

TEST(PoleDeviations, PostsBesideArePolesWithTheirOwnPoints) {
  std::set<std::size_t> numbers;
  for (std::uint64_t seed = 1; seed < 12; ++seed) {
    const auto pieces = with(&RealismOptions::multiple, seed);
    numbers.insert(pieces.size());
    std::set<std::uint32_t> ids;
    for (const Piece& piece : pieces) {
      ASSERT_TRUE(piece.pole);
      ids.insert(piece.pole->id);
      for (const Solid& solid : piece.object.solids) EXPECT_EQ(solid.object, piece.pole->id);
      const double distance =
          std::hypot(piece.pole->x - pieces[0].pole->x, piece.pole->y - pieces[0].pole->y);
      if (&piece != &pieces[0]) {
        EXPECT_GE(distance, 0.3);
        EXPECT_LE(distance, 1.2);
      }
    }
    EXPECT_EQ(ids.size(), pieces.size());
  }
  EXPECT_EQ(numbers, (std::set<std::size_t>{2, 3}));
}

TEST(PoleDeviations, BoxesAndIvyBelongToThePoleAndHedgesDoNot) {
  const std::size_t solids = sign().object.solids.size();
  const Piece box = with(&RealismOptions::boxes)[0];
  EXPECT_EQ(box.object.solids.size(), solids + 1);
  EXPECT_EQ(box.object.solids.back().object, 7u);
  const Piece ivy = with(&RealismOptions::ivy)[0];
  EXPECT_EQ(ivy.object.solids.back().object, 7u | kFoliageBit);
  EXPECT_GT(ivy.object.solids.back().density, 0);
  const auto hedge = with(&RealismOptions::hedges);
  ASSERT_EQ(hedge.size(), 2u);
  EXPECT_EQ(hedge[1].object.kind, Kind::hedge);
  EXPECT_FALSE(hedge[1].pole);
  EXPECT_LT((hedge[1].object.centre - Eigen::Vector2d(box.pole->x, box.pole->y)).norm(), 4);
}

TEST(PoleDeviations, WithoutScaleTheWorldIsAsBefore) {
  WorldOptions plain, real;
  plain.length = real.length = 100;
  real.realism.scale = 1;
  const World a = makeWorld(plain), b = makeWorld(real);
  plain.realism.crooked = 1;  // a rate alone does nothing
  const World c = makeWorld(plain);
  ASSERT_EQ(a.objects().size(), c.objects().size());
  for (std::size_t i = 0; i < a.objects().size(); ++i)
    EXPECT_EQ(a.objects()[i].solids.size(), c.objects()[i].solids.size());
  // The same things stand in the world with deviations, and some more.
  EXPECT_GT(b.objects().size(), a.objects().size());
  std::set<std::uint32_t> ids;
  for (const WorldObject& object : b.objects()) ids.insert(object.id);
  EXPECT_EQ(ids.size(), b.objects().size());
  for (const WorldObject& object : a.objects()) EXPECT_EQ(ids.count(object.id), 1u);
}

}  // namespace
}  // namespace polemcl::test_pole_deviations
