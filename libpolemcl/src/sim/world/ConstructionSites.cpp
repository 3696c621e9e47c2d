#include <cmath>

#include "sim/world/StreetObjects.h"

namespace polemcl::sim {
namespace {
using V = Eigen::Vector3d;
}  // namespace

WorldObject makeSnowBank(const Site& site, std::uint32_t id, double length, double height,
                         Random& random) {
  ObjectBuilder builder(Kind::snowBank, site);
  constexpr double kHeap = 1.5, kLong = 2.2, kWide = 1.15;  // distance and half axes of heaps, m
  // Relative height of the ellipsoids midway between two heaps, at the lateral offset of poles.
  const double lower = std::sqrt(1 - std::pow(0.5 * kHeap / kLong, 2) - std::pow(0.35 / kWide, 2));
  for (double x = -length / 2 + kHeap / 2; x < length / 2; x += kHeap)
    builder.ellipsoid(V(x, 0, 0), V(kLong, kWide, height / lower * random.uniform(1.0, 1.12)),
                      materials::kSnow);
  return builder.build(id);
}

WorldObject makeHoarding(const Site& site, std::uint32_t id, double length, Random& random) {
  ObjectBuilder builder(Kind::hoarding, site);
  const double height = random.uniform(2.05, 2.4);
  builder.box(V(0, 0, 0.5 * height), V(length / 2, 0.02, 0.5 * height), materials::kWood);
  for (double x = -length / 2; x <= length / 2; x += 2)
    builder.box(V(x, 0.07, 0.5 * height - 0.1), V(0.04, 0.05, 0.5 * height), materials::kWood);
  return builder.build(id);
}

WorldObject makeSiteFence(const Site& site, std::uint32_t id, double length, Random& random) {
  ObjectBuilder builder(Kind::siteFence, site);
  constexpr double kPanel = 3.5, kHeight = 2.0, kPost = 0.021;  // m
  const int panels = std::max(1, static_cast<int>(std::round(length / kPanel)));
  const double wide = length / panels;
  for (int i = 0; i <= panels; ++i) {
    const double x = -length / 2 + i * wide;
    builder.post(V(x, 0, 0), V(x, 0, kHeight), kPost, kPost, materials::kMetal);
    builder.box(V(x, 0, 0.07), V(0.12, 0.35, 0.07), materials::kConcrete);
    if (i == panels) break;
    builder.thicket(V(x + wide / 2, 0, kHeight / 2 + 0.05), V(wide / 2, 0.01, kHeight / 2 - 0.1),
                    materials::kMetal, random.uniform(0.1, 0.2));
    for (const double z : {0.15, kHeight - 0.02})
      builder.post(V(x, 0, z), V(x + wide, 0, z), kPost, kPost, materials::kMetal);
  }
  return builder.build(id);
}

WorldObject makeContainer(const Site& site, std::uint32_t id) {
  ObjectBuilder builder(Kind::container, site);
  builder.box(V(0, 0, 1.35), V(3.03, 1.22, 1.3), materials::kMetal);
  return builder.build(id);
}

WorldObject makeBeacon(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::beacon, site);
  const double yaw = M_PI / 2 + random.normal(0, 0.15);
  builder.box(V(0, 0, 0.06), V(0.4, 0.2, 0.06), materials::kRubber);
  builder.box(V(0, 0, 0.62), V(0.125, 0.02, 0.5), materials::kSignFace, yaw);
  if (random.chance(0.5)) builder.ellipsoid(V(0, 0, 1.22), V(0.09, 0.09, 0.1), materials::kPlastic);
  return builder.build(id);
}

}  // namespace polemcl::sim
