#include <gtest/gtest.h>

#include <functional>

#include "sim/common/Random.h"
#include "sim/lidar/Intersection.h"

namespace polemcl::test_intersection {
namespace {

using namespace polemcl::sim;
using V = Eigen::Vector3f;

/// First range at which `inside` becomes true, by small steps and bisection; infinity if never.
float march(const LocalRay& ray, const std::function<bool(const V&)>& inside) {
  constexpr float kStep = 0.004f, kEnd = 30;
  for (float range = kStep; range < kEnd; range += kStep) {
    if (!inside(ray.origin + range * ray.direction)) continue;
    float before = range - kStep, behind = range;
    for (int i = 0; i < 20; ++i) {
      const float middle = 0.5f * (before + behind);
      (inside(ray.origin + middle * ray.direction) ? behind : before) = middle;
    }
    return behind;
  }
  return std::numeric_limits<float>::infinity();
}

LocalRay randomRay(Random& random) {
  const auto vector = [&](double size) {
    return Eigen::Vector3d(random.uniform(-size, size), random.uniform(-size, size),
                           random.uniform(-size, size));
  };
  const Eigen::Vector3d origin = 9 * vector(1).normalized();
  return {origin.cast<float>(), (vector(1.6) - origin).normalized().cast<float>()};
}

/// Compares a kernel with marching; rays that only touch the shape may differ.
void compare(const std::function<ShapeHit(const LocalRay&)>& kernel,
             const std::function<bool(const V&)>& inside) {
  Random random(11);
  int hits = 0, wrong = 0;
  for (int i = 0; i < 1500; ++i) {
    const LocalRay ray = randomRay(random);
    const float expected = march(ray, inside), found = kernel(ray).range;
    if (std::isfinite(expected) != std::isfinite(found)) {
      ++wrong;
      continue;
    }
    if (!std::isfinite(expected)) continue;
    ++hits;
    wrong += std::abs(found - expected) > 0.002f;
  }
  EXPECT_GT(hits, 150);
  EXPECT_LE(wrong, hits / 100);
}
TEST(Intersection, ByHand) {
  const LocalRay along{V(-5, 0, 1), V(1, 0, 0)};
  EXPECT_NEAR(hitFrustum(along, 0.5f, 0.5f, 2).range, 4.5, 1e-5);
  EXPECT_NEAR(hitFrustum(along, 0.5f, 0.3f, 2).range, 4.6, 1e-5) << "0.4 m half way up";
  EXPECT_NEAR(hitBox(along, V(1, 1, 2)).range, 4, 1e-5);
  EXPECT_NEAR(hitEllipsoid(along, V(1, 1, 2)).range, 5 - std::sqrt(0.75), 1e-5);
  const LocalRay down{V(0.1f, 0, 5), V(0, 0, -1)};
  EXPECT_NEAR(hitFrustum(down, 0.5f, 0.3f, 2).range, 3, 1e-5) << "the upper cap";
  EXPECT_NEAR(hitFrustum(down, 0.5f, 0.3f, 2).cosine, 1, 1e-5);
  EXPECT_FALSE(std::isfinite(hitBox({V(-5, 3, 0), V(1, 0, 0)}, V(1, 1, 2)).range));
  EXPECT_FALSE(std::isfinite(hitBox({V(-5, 0, 0), V(-1, 0, 0)}, V(1, 1, 2)).range)) << "behind";
}

TEST(Intersection, FrustumEqualsMarching) {
  for (const auto& [r0, r1] : {std::pair{0.8f, 0.8f}, {1.0f, 0.3f}, {0.2f, 0.9f}})
    compare([&, a = r0, b = r1](const LocalRay& ray) { return hitFrustum(ray, a, b, 1.5f); },
            [&, a = r0, b = r1](const V& p) {
              const float radius = a + (b - a) * p.z() / 1.5f;
              return p.z() >= 0 && p.z() <= 1.5f && p.head<2>().norm() <= radius;
            });
}

TEST(Intersection, BoxEqualsMarching) {
  const V half(1, 0.3f, 0.6f);
  compare([&](const LocalRay& ray) { return hitBox(ray, half); },
          [&](const V& p) { return (p.cwiseAbs().array() <= half.array()).all(); });
}

TEST(Intersection, EllipsoidEqualsMarching) {
  const V half(1, 0.5f, 0.8f);
  compare([&](const LocalRay& ray) { return hitEllipsoid(ray, half); },
          [&](const V& p) { return p.cwiseQuotient(half).squaredNorm() <= 1; });
}

TEST(Intersection, ThinPostsFarAwayKeepTheirPrecision) {
  // 4 cm thick, 90 m away: the range must not suffer from single precision.
  for (int i = -9; i <= 9; ++i) {
    const float aside = 0.002f * static_cast<float>(i);
    const V aim = V(0, aside, 1) - V(-90, 0, 1);
    const ShapeHit hit = hitFrustum({V(-90, 0, 1), aim.normalized()}, 0.02f, 0.02f, 2);
    ASSERT_TRUE(std::isfinite(hit.range)) << aside;
    EXPECT_NEAR(hit.range, 90 - std::sqrt(0.0004 - aside * aside), 2e-3) << aside;
  }
}

TEST(Intersection, LeavesFillTheirShareAndAreTheSameFromEverySide) {
  // Straight through one row of cells, from both sides: the same cells stop the ray.
  Random random(2);
  int hits = 0;
  double depth = 0;
  constexpr int kCount = 4000;
  constexpr float kDensity = 0.05f, kCell = 0.1f, kHalf = 2;
  for (int i = 0; i < kCount; ++i) {
    const float y = static_cast<float>(random.uniform(-30, 30)),
                z = static_cast<float>(random.uniform(-30, 30));
    const ShapeHit there =
        hitLeaves({V(-5, y, z), V(1, 0, 0)}, 5 - kHalf, 5 + kHalf, kDensity, kCell, 9, 0.5f);
    const ShapeHit back =
        hitLeaves({V(5, y, z), V(-1, 0, 0)}, 5 - kHalf, 5 + kHalf, kDensity, kCell, 9, 0.5f);
    ASSERT_EQ(std::isfinite(there.range), std::isfinite(back.range)) << i;
    if (!std::isfinite(there.range)) continue;
    ++hits;
    depth += there.range - (5 - kHalf);
    EXPECT_GE(there.range, 5 - kHalf);
    EXPECT_LE(there.range, 5 + kHalf);
    EXPECT_LE(there.range, 10 - back.range + 1e-3f) << "the nearer side is met first";
  }
  // 40 cells, each filled with probability 0.05: 87 % are stopped; clumps leave more gaps.
  EXPECT_GT(hits, 0.65 * kCount);
  EXPECT_LT(hits, 0.88 * kCount);
  EXPECT_GT(depth / hits, 0.5);
}

}  // namespace
}  // namespace polemcl::test_intersection
