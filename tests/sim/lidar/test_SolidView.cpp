#include <gtest/gtest.h>

#include <polemcl/core/common/Types.h>
#include "sim/common/Random.h"
#include "sim/lidar/SolidView.h"
#include "sim/world/WorldObject.h"

namespace polemcl::test_solid_view {
namespace {

using namespace polemcl::sim;
using V = Eigen::Vector3d;

Solid randomSolid(Random& random) {
  Solid solid;
  solid.shape = static_cast<Shape>(random.below(4));
  solid.position = V(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3, 6));
  solid.axes = Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), V::UnitZ()).toRotationMatrix();
  solid.size = V(random.uniform(0.05, 3), random.uniform(0.05, 3), random.uniform(0.05, 4));
  if (solid.shape == Shape::frustum) {
    const V axis(random.normal(), random.normal(), random.normal());
    solid.axes = axesAlong(axis);
    solid.size = V(random.uniform(0.03, 0.5), random.uniform(0.03, 0.5), random.uniform(0.5, 6));
  }
  solid.density = solid.shape == Shape::thicket ? 0.5f : 0.0f;
  return solid;
}

/// Sensor poses with a tilt of up to 6 degrees.
Eigen::Isometry3d randomPose(Random& random) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), V::UnitZ()) *
                   Eigen::AngleAxisd(random.uniform(-0.07, 0.07), V::UnitY()) *
                   Eigen::AngleAxisd(random.uniform(-0.07, 0.07), V::UnitX()))
                      .toRotationMatrix();
  pose.translation() = V(random.uniform(-2, 2), random.uniform(-2, 2), 1.5);
  return pose;
}
TEST(SolidView, BoundsHoldEveryHit) {
  Random random(21);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Solid solid = randomSolid(random);
    const SolidView view(solid, randomPose(random), 5);
    BoundsMargin margin;
    margin.translation = 0.3;
    margin.highestRise = 0.2;
    const SolidBounds bounds = view.bounds(margin);
    for (int k = 0; k < 60; ++k) {
      // A ray that starts a little off the origin, aimed near the solid.
      const Eigen::Vector3f start(static_cast<float>(random.uniform(-0.2, 0.2)),
                                  static_cast<float>(random.uniform(-0.2, 0.2)),
                                  static_cast<float>(random.uniform(0, 0.2)));
      const Eigen::Vector3f centre = view.toLocal.transpose() * -view.offset;
      const Eigen::Vector3f aside(static_cast<float>(random.normal(0, 2)),
                                  static_cast<float>(random.normal(0, 2)),
                                  static_cast<float>(random.normal(0, 2)));
      const Eigen::Vector3f direction = (centre + aside - start).normalized();
      const ShapeHit hit =
          view.intersect({view.toLocal * start + view.offset, view.toLocal * direction}, 3);
      if (!std::isfinite(hit.range)) continue;
      ++hits;
      const double off =
          std::abs(wrapAngle(std::atan2(direction.y(), direction.x()) - bounds.azimuth));
      const double tangent = direction.z() / direction.head<2>().norm();
      const char* what = solid.shape == Shape::frustum ? "frustum" : "other";
      // A start 0.28 m to the side changes directions by that over the distance; the margin is 0.3
      // m.
      ASSERT_LE(off, bounds.halfAzimuth + 1e-4) << what << i;
      ASSERT_GE(tangent, bounds.lowTangent - 1e-4) << what << i;
      ASSERT_LE(tangent, bounds.highTangent + 1e-4) << what << i;
      ASSERT_GE(hit.range, bounds.nearest - 1e-4) << what << i;
    }
  }
  EXPECT_GT(hits, 20000);
}

TEST(SolidView, GlassLetsTheGivenShareThrough) {
  Solid solid;
  solid.position = V(5, 0, 0);
  solid.size = V(1, 4, 4);
  solid.material.passes = 0.7f;
  const SolidView view(solid, Eigen::Isometry3d::Identity(), 5);
  int stopped = 0;
  for (std::uint64_t draw = 0; draw < 10000; ++draw)
    stopped += std::isfinite(view.intersect({view.offset, Eigen::Vector3f(1, 0, 0)}, draw).range);
  EXPECT_NEAR(stopped, 3000, 150);
}

}  // namespace
}  // namespace polemcl::test_solid_view
