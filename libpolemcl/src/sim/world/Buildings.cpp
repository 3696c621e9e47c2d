#include <algorithm>
#include <cmath>

#include "sim/world/StreetObjects.h"

namespace polemcl::sim {
namespace {
using V = Eigen::Vector3d;
constexpr double kBuried = 1.0;  // depth of walls below ground, so that slopes leave no gap, m

/// \brief The front under construction.
struct Front {
  ObjectBuilder& builder;
  Random& random;
  double length, depth, height;
  Material material;

  /// Wall from x0 to x1 with its face at y = face.
  void wall(double x0, double x1, double face, double low, double high) {
    builder.box(V(0.5 * (x0 + x1), 0.5 * (face + depth), 0.5 * (low + high)),
                V(0.5 * (x1 - x0), 0.5 * (depth - face), 0.5 * (high - low)), material);
  }
  /// The ground floor with its doors, and the floors above.
  void body(double storey) {
    double x = -length / 2;
    while (x < length / 2) {
      const double plain = std::min(random.uniform(3, 8), length / 2 - x);
      wall(x, x + plain, 0, -kBuried, storey);
      x += plain;
      const double door = std::min(random.uniform(1.0, 2.6), length / 2 - x);
      if (door > 0.5) {
        wall(x, x + door, random.uniform(0.15, 0.6), -kBuried, 2.3);
        wall(x, x + door, 0, 2.3, storey);
        if (random.chance(0.4))
          builder.box(V(x + door / 2, -0.25, 0), V(door / 2 + 0.2, 0.3, 0.17),
                      materials::kConcrete);
        x += door;
      }
    }
    wall(-length / 2, length / 2, 0, storey, height);
  }
  void windows(double storey) {
    const double spacing = random.uniform(2.0, 3.5), half = random.uniform(0.4, 0.8);
    const bool sills = random.chance(0.5);
    const double sillOut = random.uniform(0.05, 0.15);
    for (double x = -length / 2 + spacing / 2; x < length / 2 - half; x += spacing)
      for (double low = 1.0; low + 1.5 < height; low += storey) {
        builder.box(V(x, 0, low + 0.75), V(half, 0.012, 0.7), materials::kHouseGlass);
        if (sills) builder.box(V(x, 0, low), V(half + 0.06, sillOut, 0.04), materials::kConcrete);
      }
  }
  void ledges(double storey) {
    const double out = random.uniform(0.03, 0.12);
    for (double level = storey; level < height; level += storey)
      builder.box(V(0, 0, level), V(length / 2, out, random.uniform(0.06, 0.15)), material);
    builder.box(V(0, 0, 0.2), V(length / 2, 0.5 * out, 0.5), materials::kConcrete);  // plinth
  }
  void pilasters() {
    const double spacing = random.uniform(2.5, 5), half = random.uniform(0.12, 0.35);
    const double out = random.uniform(0.05, 0.3), top = random.chance(0.5) ? height : 3.4;
    for (double x = -length / 2 + half; x <= length / 2 - half; x += spacing)
      builder.box(V(x, -out / 2, 0.5 * (top - kBuried)),
                  V(half, out / 2 + 0.05, 0.5 * (top + kBuried)), material);
  }
  void drainPipe(double x) {
    const double radius = random.uniform(0.04, 0.055);
    builder.post(V(x, -radius - random.uniform(0.02, 0.06), 0.1), V(x, -radius - 0.04, height),
                 radius, radius, materials::kMetal);
  }
  void bay() {
    const double half = random.uniform(0.8, 1.6), out = random.uniform(0.4, 1.0);
    const double low = random.chance(0.5) ? -kBuried : 2.8;
    builder.box(V(random.uniform(-0.3, 0.3) * length, -out / 2, 0.5 * (low + height)),
                V(half, out / 2, 0.5 * (height - low)), material);
  }
  void balconies(double storey) {
    const double x = random.uniform(-0.3, 0.3) * length, half = random.uniform(1, 2);
    for (double level = storey; level + 2 < height; level += storey) {
      builder.box(V(x, -0.6, level), V(half, 0.6, 0.09), materials::kConcrete);
      builder.thicket(V(x, -1.17, level + 0.55), V(half, 0.02, 0.45), materials::kMetal, 0.3);
    }
  }
};
}  // namespace

WorldObject makeHouse(const Site& site, std::uint32_t id, double length, double depth,
                      Random& random) {
  ObjectBuilder builder(Kind::house, site);
  const double storey = random.uniform(2.8, 3.6);
  Front front{builder,
              random,
              length,
              depth,
              storey * (1 + random.below(4)) + random.uniform(0.5, 2),
              random.chance(0.4) ? materials::kBrick : materials::kPlaster};
  front.body(storey);
  front.windows(storey);
  if (random.chance(0.5)) front.ledges(storey);
  if (random.chance(0.35)) front.pilasters();
  if (random.chance(0.5)) front.drainPipe(-length / 2 + random.uniform(0.1, 0.4));
  if (random.chance(0.25)) front.drainPipe(random.uniform(-0.4, 0.4) * length);
  if (random.chance(0.2)) front.bay();
  if (random.chance(0.3)) front.balconies(storey);
  return builder.build(id);
}

WorldObject makeWall(const Site& site, std::uint32_t id, double length, Random& random) {
  ObjectBuilder builder(Kind::wall, site);
  const double height = random.uniform(0.8, 2.4), half = random.uniform(0.1, 0.2);
  const Material material = random.chance(0.5) ? materials::kBrick : materials::kConcrete;
  builder.box(V(0, 0, 0.5 * (height - kBuried)), V(length / 2, half, 0.5 * (height + kBuried)),
              material);
  if (random.chance(0.7)) {
    const double spacing = random.uniform(2.5, 5), wide = random.uniform(0.18, 0.3);
    for (double x = -length / 2; x <= length / 2; x += spacing)
      builder.box(V(x, 0, 0.5 * (height + 0.15 - kBuried)),
                  V(wide, half + 0.08, 0.5 * (height + 0.15 + kBuried)), material);
  }
  return builder.build(id);
}

}  // namespace polemcl::sim
