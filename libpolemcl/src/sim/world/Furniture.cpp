#include <cmath>

#include "sim/world/StreetObjects.h"

namespace polemcl::sim {
namespace {
using V = Eigen::Vector3d;

constexpr double kPostDepth = 0.4;  // depth of posts below ground, so that slopes leave no gap, m

/// \brief A straight axis with a random tilt: point at a height above ground.
struct Axis {
  V lean;
  Axis(double sigmaDeg, Random& random) {
    const double y = random.normal(), x = random.normal();
    lean = V(std::tan(sigmaDeg * M_PI / 180 * x), std::tan(sigmaDeg * M_PI / 180 * y), 1);
  }
  V at(double height) const { return lean * height; }
};

/// \brief A plate in front of a post, parallel or perpendicular to the street.
void addPlate(ObjectBuilder& builder, const Axis& axis, double height, double postRadius,
              bool acrossStreet, Random& random) {
  const double halfWidth = random.uniform(0.18, 0.4), halfHeight = random.uniform(0.15, 0.4);
  const double yaw = (acrossStreet ? M_PI / 2 : 0) + random.normal(0, 0.15);
  const double gap = postRadius + 0.03, side = random.chance(0.5) ? 1 : -1;
  const V offset(-side * gap * std::sin(yaw), side * gap * std::cos(yaw), 0);
  builder.box(axis.at(height) + offset, V(halfWidth, 0.01, halfHeight), materials::kSignFace, yaw);
}
}  // namespace

TruePole poleAt(const Site& site, std::uint32_t id, Kind kind, const V& local, double radius,
                double top) {
  TruePole pole;
  const double c = std::cos(site.heading), s = std::sin(site.heading);
  pole.id = id;
  pole.x = site.base.x() + c * local.x() - s * local.y();
  pole.y = site.base.y() + s * local.x() + c * local.y();
  pole.radius = radius;
  pole.top = top;
  pole.kind = kind;
  return pole;
}

LampStyle::LampStyle(Random& random)
    : height(random.uniform(4.5, 8)),
      baseRadius(random.uniform(0.06, 0.13)),
      topRadius(random.chance(0.3) ? baseRadius : baseRadius * random.uniform(0.4, 0.8)),
      armLength(random.chance(0.45) ? random.uniform(0.8, 2.2) : 0.0),
      thickFoot(random.chance(0.4)) {}

Piece makeLampPost(const Site& site, std::uint32_t id, const LampStyle& style, Random& random) {
  ObjectBuilder builder(Kind::lampPost, site);
  const Axis axis(0.5, random);
  const double height = style.height * random.uniform(0.97, 1.03);
  const Material paint{static_cast<float>(random.uniform(0.12, 0.45)), 0.001f, 0};
  builder.post(axis.at(-kPostDepth), axis.at(height), style.baseRadius, style.topRadius, paint);
  if (style.thickFoot)
    builder.post(axis.at(-kPostDepth), axis.at(random.uniform(0.8, 1.2)), style.baseRadius * 1.35,
                 style.baseRadius * 1.3, paint);
  if (style.armLength > 0) {  // over the road
    const V top = axis.at(height - 0.1), tip = top + V(0, -style.armLength, 0.35);
    builder.post(top, tip, 0.04, 0.035, paint);
    builder.box(tip + V(0, -0.25, 0), V(0.13, 0.35, 0.07), paint);
  } else {
    builder.ellipsoid(axis.at(height + 0.15), V(0.22, 0.22, 0.2), materials::kPlastic);
  }
  if (random.chance(0.25)) {
    const bool isRound = random.chance(0.8);
    addPlate(builder, axis, random.uniform(2.1, 2.9), style.baseRadius, isRound, random);
  }
  if (random.chance(0.08))
    builder.box(axis.at(1.0) + V(0, style.baseRadius + 0.17, 0), V(0.18, 0.15, 0.3),
                materials::kPlastic);
  const double radius =
      style.baseRadius + (style.topRadius - style.baseRadius) * kTruthHeight / height;
  return {builder.build(id),
          poleAt(site, id, Kind::lampPost, axis.at(kTruthHeight), radius, height)};
}

Piece makeSign(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::sign, site);
  const Axis axis(1.0, random);
  const double radius = random.uniform(0.03, 0.05), height = random.uniform(2.3, 3.2);
  builder.post(axis.at(-kPostDepth), axis.at(height), radius, radius, materials::kMetal);
  const bool across = random.chance(0.75);
  addPlate(builder, axis, height - random.uniform(0.2, 0.35), radius, across, random);
  if (random.chance(0.3)) addPlate(builder, axis, height - 1.0, radius, across, random);
  return {builder.build(id), poleAt(site, id, Kind::sign, axis.at(kTruthHeight), radius, height)};
}

Piece makeTrafficLight(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::trafficLight, site);
  const Axis axis(0.5, random);
  const bool mast = random.chance(0.3);
  const double radius = mast ? random.uniform(0.08, 0.11) : random.uniform(0.045, 0.065);
  const double height = mast ? random.uniform(5, 6) : random.uniform(3, 3.6);
  builder.post(axis.at(-kPostDepth), axis.at(height), radius, radius, materials::kMetal);
  const auto head = [&](const V& centre) {
    builder.box(centre, V(0.14, 0.14, 0.45), materials::kDarkMetal);
  };
  head(axis.at(random.uniform(2.4, 2.7)) + V(0, -radius - 0.16, 0));
  if (mast) {
    const V tip = axis.at(height - 0.15) + V(0, -random.uniform(3, 5), 0);
    builder.post(axis.at(height - 0.15), tip, 0.06, 0.05, materials::kMetal);
    head(tip + V(0, 0, -0.3));
  }
  if (random.chance(0.6))  // push button for pedestrians
    builder.box(axis.at(1.05) + V(0, radius + 0.05, 0), V(0.05, 0.05, 0.1), materials::kPlastic);
  return {builder.build(id),
          poleAt(site, id, Kind::trafficLight, axis.at(kTruthHeight), radius, height)};
}

WorldObject makeBollard(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::bollard, site);
  const Axis axis(1.5, random);
  const double radius = random.uniform(0.04, 0.1), height = random.uniform(0.7, 1.1);
  builder.post(axis.at(-kPostDepth), axis.at(height), radius, radius, materials::kMetal);
  return builder.build(id);
}

WorldObject makeBin(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::bin, site);
  if (random.chance(0.5)) {
    builder.post(V(0, 0, 0.05), V(0, 0, random.uniform(0.8, 1.0)), 0.2, 0.24, materials::kPlastic);
  } else {
    const double yaw = random.uniform(0, M_PI), height = random.uniform(0.5, 0.6);
    builder.box(V(0, 0, height), V(0.29, 0.35, height - 0.06), materials::kPlastic, yaw);
  }
  return builder.build(id);
}

WorldObject makeBillboard(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::billboard, site);
  const double half = random.uniform(0.6, 1.9), aside = random.normal(0, 0.2),
               yaw = aside + (random.chance(0.5) ? M_PI / 2 : 0);
  const double foot = random.uniform(0.3, 0.7), height = random.uniform(2.0, 3.2);
  builder.box(V(0, 0, 0.5 * (foot + height)), V(half, 0.06, 0.5 * (height - foot)),
              materials::kPlaster, yaw);
  const V along(std::cos(yaw), std::sin(yaw), 0);
  for (const double side : {-0.7, 0.7})
    builder.box(side * half * along + V(0, 0, foot / 2 - 0.2), V(0.06, 0.06, foot / 2 + 0.2),
                materials::kMetal, yaw);
  return builder.build(id);
}

WorldObject makeCabinet(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::cabinet, site);
  const double height = random.uniform(0.4, 0.75);
  const double yaw = random.normal(0, 0.05), half = random.uniform(0.25, 0.7);
  builder.box(V(0, 0, height - 0.1), V(half, 0.17, height + 0.1), materials::kPlastic, yaw);
  return builder.build(id);
}

WorldObject makeAdvertColumn(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::column, site);
  const double radius = random.uniform(0.55, 0.7), height = random.uniform(2.5, 3.2);
  builder.post(V(0, 0, -kPostDepth), V(0, 0, height), radius, radius, materials::kPlaster);
  builder.post(V(0, 0, height), V(0, 0, height + 0.3), radius + 0.1, 0.2, materials::kDarkMetal);
  return builder.build(id);
}

WorldObject makeBicycle(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::bicycle, site);
  const double yaw = random.uniform(-M_PI, M_PI), lean = random.normal(0, 0.12);
  const V along(std::cos(yaw), std::sin(yaw), 0);
  const V up(-std::sin(yaw) * std::tan(lean), std::cos(yaw) * std::tan(lean), 1);
  const auto place = [&](double forward, double height) {
    return V(forward * along + height * up);
  };
  for (const double wheel : {-0.52, 0.52}) {  // spokes let most pulses pass
    builder.thicket(place(wheel, 0.34), V(0.3, 0.02, 0.3), materials::kRubber, 0.12, yaw);
    builder.post(place(wheel - 0.2, 0.6), place(wheel + 0.2, 0.6), 0.02, 0.02, materials::kRubber);
  }
  builder.post(place(-0.52, 0.34), place(-0.1, 0.9), 0.015, 0.015, materials::kMetal);
  builder.post(place(-0.1, 0.3), place(0.42, 0.75), 0.018, 0.018, materials::kMetal);
  builder.post(place(0.52, 0.34), place(0.38, 1.02), 0.018, 0.018, materials::kMetal);
  builder.ellipsoid(place(-0.12, 0.95), V(0.13, 0.1, 0.05), materials::kRubber);
  return builder.build(id);
}

WorldObject makeFence(const Site& site, std::uint32_t id, double length, Random& random) {
  ObjectBuilder builder(Kind::fence, site);
  const double height = random.uniform(0.9, 1.8), spacing = random.uniform(1.8, 2.8);
  const double radius = random.uniform(0.025, 0.06);
  const Material material = random.chance(0.5) ? materials::kWood : materials::kMetal;
  for (double x = -length / 2; x <= length / 2; x += spacing)
    builder.post(V(x, 0, -kPostDepth), V(x, 0, height), radius, radius, material);
  if (random.chance(0.35)) {
    builder.thicket(V(0, 0, height / 2 + 0.05), V(length / 2, 0.015, height / 2 - 0.08), material,
                    random.uniform(0.1, 0.35));
  } else {
    const int rails = 2 + random.below(3);
    for (int i = 0; i < rails; ++i) {
      const double level = height * (0.25 + 0.7 * i / (rails - 1.0));
      builder.post(V(-length / 2, 0, level), V(length / 2, 0, level), 0.03, 0.03, material);
    }
  }
  return builder.build(id);
}

}  // namespace polemcl::sim
