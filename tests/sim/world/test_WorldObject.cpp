#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sim/world/WorldObject.h"

namespace polemcl::test_world_object {

using namespace polemcl::sim;
using V = Eigen::Vector3d;

TEST(WorldObject, SolidsAreTurnedAndMovedToTheSite) {
  const Site site{V(10, 20, 1), M_PI / 2};  // local x points to map y
  ObjectBuilder builder(Kind::car, site);
  builder.box(V(2, 1, 0.5), V(1, 0.5, 0.25), materials::kMetal);
  const WorldObject object = builder.build(7);
  ASSERT_EQ(object.solids.size(), 1u);
  EXPECT_TRUE(object.solids[0].position.isApprox(V(9, 22, 1.5)));
  EXPECT_TRUE(object.solids[0].axes.col(0).isApprox(V(0, 1, 0), 1e-12));
  EXPECT_EQ(object.solids[0].object, 7u);
}

TEST(WorldObject, PostsRunFromOneEndToTheOther) {
  ObjectBuilder builder(Kind::lampPost, Site{});
  builder.post(V(0, 0, 1), V(3, 0, 5), 0.2, 0.1, materials::kMetal);
  const WorldObject object = builder.build(1);
  const Solid& post = object.solids[0];
  EXPECT_NEAR(post.size.z(), 5, 1e-12);
  EXPECT_TRUE((post.position + post.size.z() * post.axes.col(2)).isApprox(V(3, 0, 5)));
  EXPECT_NEAR(post.axes.determinant(), 1, 1e-12);
}

TEST(WorldObject, TheCircleHoldsAllSolids) {
  ObjectBuilder builder(Kind::house, Site{V(5, 5, 0), 0.4});
  builder.box(V(4, 0, 1), V(3, 2, 1), materials::kBrick, 0.3);
  builder.post(V(-2, 0, 0), V(-4, 1, 1), 0.3, 0.2, materials::kMetal);
  builder.ellipsoid(V(0, 6, 1), V(1, 2, 1), materials::kLeaves);
  const WorldObject object = builder.build(1);
  for (const Solid& solid : object.solids)
    for (int i = 0; i < 64; ++i) {  // corners and ends of every solid
      const V sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      V local = sign.cwiseProduct(solid.size);
      if (solid.shape == Shape::frustum) {
        const double radius = i & 8 ? solid.size.y() : solid.size.x();
        local = V(radius * std::cos(i), radius * std::sin(i), i & 8 ? solid.size.z() : 0);
      } else if (solid.shape == Shape::ellipsoid) {
        local = V(std::cos(i), std::sin(i), 0).cwiseProduct(solid.size);
      }
      const V point = solid.position + solid.axes * local;
      EXPECT_LE((point.head<2>() - object.centre).norm(), object.radius + 1e-9);
    }
}

TEST(WorldObject, CrownsAreLabelledApartFromTheTrunk) {
  ObjectBuilder builder(Kind::tree, Site{});
  builder.post(V(0, 0, 0), V(0, 0, 3), 0.2, 0.2, materials::kBark);
  builder.startCrown();
  builder.ellipsoid(V(0, 0, 4), V(1, 1, 1), materials::kLeaves, 0.1);
  const WorldObject tree = builder.build(9);
  EXPECT_EQ(tree.solids[0].object, 9u);
  EXPECT_EQ(tree.solids[1].object, 9u | kFoliageBit);
}

}  // namespace polemcl::test_world_object
