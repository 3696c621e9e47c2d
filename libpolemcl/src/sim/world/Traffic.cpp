#include <algorithm>
#include <cmath>

#include "sim/world/StreetObjects.h"

namespace polemcl::sim {
namespace {
using V = Eigen::Vector3d;

void addWheels(ObjectBuilder& builder, double axle, double halfWidth, double radius) {
  for (const double x : {-axle, axle})
    for (const double side : {-1.0, 1.0})
      builder.post(V(x, side * (halfWidth - 0.24), radius), V(x, side * (halfWidth - 0.02), radius),
                   radius, radius, materials::kRubber);
}

/// \brief Roof on slim pillars with glass between, as on cars.
void addCabin(ObjectBuilder& builder, double rear, double front, double halfWidth, double sill,
              double roof, const Material& paint) {
  const double middle = 0.5 * (rear + front), top = roof - 0.04;
  const double inset = 0.18;  // windows are tilted inwards
  builder.box(V(middle - 0.1, 0, top), V(0.5 * (front - rear) - 0.45, halfWidth - inset, 0.05),
              paint);
  for (const double side : {-1.0, 1.0}) {
    const double low = side * (halfWidth - 0.06), high = side * (halfWidth - inset);
    builder.post(V(front, low, sill), V(front - 0.6, high, top), 0.04, 0.04, paint);
    builder.post(V(middle, low, sill), V(middle - 0.05, high, top), 0.05, 0.05, paint);
    builder.post(V(rear, low, sill), V(rear + 0.35, high, top), 0.07, 0.07, paint);
  }
  builder.box(V(middle - 0.05, 0, 0.5 * (sill + top)),
              V(0.5 * (front - rear) - 0.3, halfWidth - 0.12, 0.5 * (top - sill) - 0.02),
              materials::kCarGlass);
  for (const double seat : {middle + 0.35, middle - 0.6})
    builder.box(V(seat, 0, sill), V(0.12, halfWidth - 0.3, 0.25), materials::kCloth);
}
}  // namespace

WorldObject makeVehicle(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::car, site);
  // Black paint reflects little, and mostly in other directions.
  const Material paint{static_cast<float>(random.chance(0.35) ? random.uniform(0.03, 0.1)
                                                              : random.uniform(0.2, 0.7)),
                       0.001f, 0};
  const double kind = random.uniform();
  if (kind < 0.82) {
    const double half = random.uniform(1.8, 2.4), wide = random.uniform(0.82, 0.95);
    const double sill = random.uniform(0.85, 1.05), roof = sill + random.uniform(0.5, 0.65);
    builder.box(V(0, 0, 0.5 * (0.25 + sill * 0.75)), V(half, wide, 0.5 * (sill * 0.75 - 0.25)),
                paint);
    builder.box(V(-0.15, 0, sill * 0.86), V(half - 0.25, wide - 0.04, sill * 0.14), paint);
    const bool hatch = random.chance(0.6);
    addCabin(builder, hatch ? -half + 0.15 : -half + 0.9, half - random.uniform(0.9, 1.2), wide,
             sill, roof, paint);
    for (const double side : {-1.0, 1.0})
      builder.box(V(half - 1.4, side * (wide + 0.09), sill + 0.05), V(0.06, 0.09, 0.07), paint);
    addWheels(builder, half - 0.8, wide, random.uniform(0.29, 0.34));
  } else {
    const bool lorry = kind > 0.96;
    const double half = lorry ? random.uniform(3, 4) : random.uniform(2.3, 2.9);
    const double wide = lorry ? 1.2 : 0.98,
                 top = lorry ? random.uniform(2.8, 3.5) : random.uniform(1.9, 2.6);
    builder.box(V(-0.5, 0, 0.5 * (0.35 + top)), V(half - 0.5, wide, 0.5 * (top - 0.35)), paint);
    builder.box(V(half - 0.5, 0, 0.75), V(0.5, wide, 0.4), paint);
    builder.box(V(half - 0.85, 0, 1.5), V(0.35, wide - 0.1, 0.4), materials::kCarGlass);
    addWheels(builder, half - 0.9, wide, lorry ? 0.45 : 0.34);
  }
  return builder.build(id);
}

WorldObject makePerson(const Site& site, std::uint32_t id, Random& random) {
  ObjectBuilder builder(Kind::person, site);
  const double height = random.uniform(1.15, 1.92), wide = height * random.uniform(0.1, 0.13);
  const double yaw = random.uniform(-M_PI, M_PI),
               stride = random.chance(0.7) ? height * random.uniform(0.1, 0.2) : 0.0;
  const V ahead(std::cos(yaw), std::sin(yaw), 0), aside(-std::sin(yaw), std::cos(yaw), 0);
  const V hip(0, 0, 0.5 * height), shoulder(0, 0, 0.83 * height);
  for (const double side : {-1.0, 1.0}) {
    builder.post(side * (0.09 * aside + stride * ahead), hip + 0.08 * side * aside, 0.05, 0.085,
                 materials::kCloth);
    builder.post(shoulder + side * wide * 1.1 * aside,
                 hip + side * (wide * 1.35 * aside - 0.8 * stride * ahead), 0.05, 0.035,
                 materials::kCloth);
  }
  builder.ellipsoid(V(0, 0, 0.66 * height), V(wide * 0.7, wide * 1.15, 0.2 * height),
                    materials::kCloth, 0, yaw);
  builder.ellipsoid(V(0, 0, 0.93 * height), V(0.085, 0.075, 0.07 * height), materials::kSkin);
  if (random.chance(0.3))  // bag or rucksack
    builder.box(shoulder - 0.2 * ahead - V(0, 0, 0.2), V(0.1, 0.14, 0.22), materials::kCloth, yaw);
  return builder.build(id);
}

}  // namespace polemcl::sim
