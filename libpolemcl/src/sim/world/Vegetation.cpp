#include <algorithm>
#include <cmath>

#include "sim/world/StreetObjects.h"

namespace polemcl::sim {
namespace {
using V = Eigen::Vector3d;
}  // namespace

TreeStyle::TreeStyle(Random& random)
    : trunkRadius(random.uniform(0.09, 0.27)),
      crownBase(random.uniform(2.1, 3.2)),
      height(crownBase + 2.5 + 16 * trunkRadius * random.uniform(0.7, 1.3)),
      crownRadius(1.0 + 8 * trunkRadius * random.uniform(0.8, 1.2)) {}

Piece makeTree(const Site& site, std::uint32_t id, const TreeStyle& style, double foliage,
               Random& random) {
  ObjectBuilder builder(Kind::tree, site);
  const double radius = std::clamp(style.trunkRadius * random.uniform(0.8, 1.2), 0.06, 0.35);
  const double crownBase = std::max(2.1, style.crownBase + random.normal(0, 0.25));
  const double height = style.height * random.uniform(0.9, 1.1);
  const double trunkTop = crownBase + 0.35 * (height - crownBase);
  const double leanX = random.normal(0, 0.02), leanY = random.normal(0, 0.02);
  // The trunk: tapered pieces, shifted by a centimetre or two.
  V place(0, 0, -0.3), truth(0, 0, 0);
  double width = radius * random.uniform(1.2, 1.6);  // roots
  const double levels[] = {0.25, 1.0, 1.9, crownBase, trunkTop};
  double truthRadius = radius;
  for (const double level : levels) {
    const double y = leanY * level + random.normal(0, 0.012);
    const V next(leanX * level + random.normal(0, 0.012), y, level);
    const double nextWidth = radius * (1.05 - 0.35 * level / trunkTop) * random.uniform(0.96, 1.04);
    builder.post(place, next, width, nextWidth, materials::kBark);
    if (place.z() < kTruthHeight && level >= kTruthHeight) {
      const double share = (kTruthHeight - place.z()) / (level - place.z());
      truth = place + share * (next - place);
      truthRadius = width + share * (nextWidth - width);
    }
    place = next;
    width = nextWidth;
  }
  const V fork = place;
  builder.startCrown();
  const int branches = 4 + random.below(4);
  for (int i = 0; i < branches; ++i) {
    const double turn = 2 * M_PI * (i + random.uniform(0, 0.7)) / branches;
    const V from(fork.x(), fork.y(), random.uniform(crownBase, trunkTop));
    const double reach = style.crownRadius * random.uniform(0.4, 0.85);
    builder.post(
        from,
        from + V(reach * std::cos(turn), reach * std::sin(turn), random.uniform(0.5, 1.2) * reach),
        radius * 0.4, 0.015, materials::kBark);
  }
  const int tufts = foliage > 0 ? 3 + random.below(4) : 0;
  for (int i = 0; i < tufts; ++i) {
    const double turn = random.uniform(0, 2 * M_PI),
                 out = style.crownRadius * random.uniform(0, 0.5);
    const double half = 0.5 * (height - crownBase) * random.uniform(0.55, 1.0);
    const double wide = style.crownRadius * random.uniform(0.5, 0.8);
    const double low = crownBase + half * random.uniform(0.75, 1.3);
    builder.ellipsoid(V(out * std::cos(turn), out * std::sin(turn), low), V(wide, wide, half),
                      materials::kLeaves, std::min(0.5, foliage * random.uniform(0.03, 0.09)));
  }
  return {builder.build(id), poleAt(site, id, Kind::tree, truth, truthRadius, trunkTop)};
}

WorldObject makeBush(const Site& site, std::uint32_t id, double foliage, Random& random) {
  ObjectBuilder builder(Kind::bush, site);
  const double size = random.uniform(0.3, 1.1);
  const int blobs = 2 + random.below(3);
  for (int i = 0; i < blobs; ++i) {
    const double tall = size * random.uniform(0.6, 1.2), deep = size * random.uniform(0.6, 1.1);
    const V half(size * random.uniform(0.6, 1.1), deep, tall);
    const double opaque = std::max(0.06, 0.8 * foliage * random.uniform(0.15, 0.4));
    const double y = random.normal(0, 0.4) * size, x = random.normal(0, 0.4) * size;
    builder.ellipsoid(V(x, y, half.z() * 0.8), half, materials::kLeaves, opaque);
  }
  return builder.build(id);
}

WorldObject makeHedge(const Site& site, std::uint32_t id, double length, double foliage,
                      Random& random) {
  ObjectBuilder builder(Kind::hedge, site);
  const double height = random.uniform(0.45, 1.0), half = random.uniform(0.25, 0.45);
  for (double x = -length / 2; x < length / 2 - 0.5;) {
    const double piece = std::min(random.uniform(1.5, 4), length / 2 - x);
    const double tall = height * random.uniform(0.9, 1.1);
    const double opaque = std::max(0.15, foliage * random.uniform(0.35, 0.6));
    const double deep = half * random.uniform(0.9, 1.1);
    builder.thicket(V(x + piece / 2, random.normal(0, 0.04), tall - 0.1),
                    V(piece / 2, deep, tall + 0.1), materials::kLeaves, opaque);
    x += piece;
  }
  return builder.build(id);
}

}  // namespace polemcl::sim
