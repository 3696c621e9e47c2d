#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/world/StreetObjects.h"

namespace polemcl::sim {
namespace {
using V = Eigen::Vector3d;

constexpr double kPiece = 0.6;               ///< length of the straight pieces of a bent post, m
constexpr std::uint32_t kNextPost = 200000;  ///< between the ids of posts that stand together

double heightOn(const Site& site, const V& point) {
  return point.z() - site.base.z();
}

/// Bends and tapers the posts of an object; what hangs on them moves along.
/// \param shift Displacement at a height, m. \param thickness Factor of the radius at a height.
template <class Shift, class Thickness>
void deform(WorldObject& object, const Site& site, Shift shift, Thickness thickness) {
  std::vector<Solid> solids;
  for (const Solid& solid : object.solids) {
    const V along = solid.axes.col(2), start = solid.position;
    const int pieces = solid.shape == Shape::frustum
                           ? std::max(1, static_cast<int>(std::ceil(solid.size.z() / kPiece)))
                           : 1;
    if (solid.shape != Shape::frustum) {
      solids.push_back(solid);
      solids.back().position += shift(heightOn(site, start));
      continue;
    }
    const auto radius = [&](double share) {
      const double height = heightOn(site, start + share * solid.size.z() * along);
      return (solid.size.x() + share * (solid.size.y() - solid.size.x())) * thickness(height);
    };
    const auto at = [&](double share) {
      const V point = start + share * solid.size.z() * along;
      return V(point + shift(heightOn(site, point)));
    };
    for (int i = 0; i < pieces; ++i) {
      const double from = static_cast<double>(i) / pieces, to = (i + 1.0) / pieces;
      const V a = at(from), b = at(to);
      Solid piece = solid;
      piece.position = a;
      piece.size = V(radius(from), radius(to), (b - a).norm());
      piece.axes = axesAlong(b - a);
      solids.push_back(piece);
    }
  }
  object.solids = std::move(solids);
}

void bend(Piece& piece, const Site& site, Random& random) {
  const double turn = random.uniform(0, 2 * M_PI), bow = random.uniform(0.04, 0.15),
               wave = random.uniform(0.01, 0.04), phase = random.uniform(0, 2 * M_PI);
  const V aside(std::cos(turn), std::sin(turn), 0), other(-aside.y(), aside.x(), 0);
  const double length = piece.pole->top;
  const auto shift = [&](double height) {
    const double h = std::max(0.0, height);
    return V(bow * std::sin(M_PI * std::min(1.0, h / length)) * aside +
             wave * (std::sin(2.5 * h + phase) - std::sin(phase)) * other);
  };
  deform(piece.object, site, shift, [](double) { return 1.0; });
  piece.pole->x += shift(kTruthHeight).x();
  piece.pole->y += shift(kTruthHeight).y();
}

void taper(Piece& piece, const Site& site, Random& random) {
  const double strength = random.uniform(0.2, 0.5), length = piece.pole->top;
  const auto thickness = [&](double height) {
    return 1 + strength * (1 - 2 * std::clamp(height / length, 0.0, 1.0));
  };
  deform(
      piece.object, site, [](double) { return V(V::Zero()); }, thickness);
  piece.pole->radius *= thickness(kTruthHeight);
}

void lean(Piece& piece, const Site& site, Random& random) {
  const double turn = random.uniform(0, 2 * M_PI), angle = random.uniform(1.5, 6) * M_PI / 180;
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(angle, V(std::cos(turn), std::sin(turn), 0)).toRotationMatrix();
  for (Solid& solid : piece.object.solids) {
    solid.position = site.base + tilt * (solid.position - site.base);
    solid.axes = tilt * solid.axes;
  }
  // Where the axis is at this height now.
  const V axis =
      tilt * V(piece.pole->x - site.base.x(), piece.pole->y - site.base.y(), kTruthHeight);
  const V up = tilt.col(2);
  const V place = axis + (kTruthHeight - axis.z()) / up.z() * up;
  piece.pole->x = site.base.x() + place.x();
  piece.pole->y = site.base.y() + place.y();
}

/// One more post beside, without what hangs on the first one.
Piece nextPost(const Piece& first, const Site& site, double along, std::uint32_t id) {
  Piece piece = first;
  const V shift(along * std::cos(site.heading), along * std::sin(site.heading), 0);
  piece.object.solids = {first.object.solids.front()};
  piece.object.solids.front().position += shift;
  piece.object.solids.front().object = id;
  piece.object.id = id;
  piece.object.centre += shift.head<2>();
  piece.pole->id = id;
  piece.pole->x += shift.x();
  piece.pole->y += shift.y();
  return piece;
}

/// Solids in the frame of the pole, which stands at the local origin.
void attach(Piece& piece, const WorldObject& addition) {
  for (Solid solid : addition.solids) {
    solid.object = (solid.object & kFoliageBit) | piece.object.id;
    piece.object.solids.push_back(solid);
  }
  const double reach = (addition.centre - piece.object.centre).norm() + addition.radius;
  piece.object.radius = std::max(piece.object.radius, reach);
}

Site atPole(const Piece& piece, const Site& site) {
  return {V(piece.pole->x, piece.pole->y, site.base.z()), site.heading};
}

void addBox(Piece& piece, const Site& site, Random& random) {
  Site turned = atPole(piece, site);
  turned.heading = random.uniform(-M_PI, M_PI);
  ObjectBuilder builder(piece.object.kind, turned);
  const double tall = random.uniform(0.15, 0.4), deep = random.uniform(0.06, 0.15);
  const V half(random.uniform(0.1, 0.25), deep, tall);
  builder.box(V(0, piece.pole->radius + half.y(), random.uniform(0.7, 2.2)), half,
              materials::kPlastic);
  attach(piece, builder.build(0));
}

void addIvy(Piece& piece, const Site& site, Random& random) {
  ObjectBuilder builder(piece.object.kind, atPole(piece, site));
  builder.startCrown();
  const double half = random.uniform(0.6, 1.4),
               radius = piece.pole->radius + random.uniform(0.08, 0.25);
  builder.ellipsoid(V(0, 0, half * 0.9), V(radius, radius, half), materials::kLeaves,
                    random.uniform(0.2, 0.5));
  attach(piece, builder.build(0));
}

Piece hedgeAt(const Piece& piece, const Site& site, Random& random) {
  Site beside = atPole(piece, site);
  const double out = random.uniform(0.05, 0.6);
  beside.base += V(-out * std::sin(site.heading), out * std::cos(site.heading), 0);
  const double length = random.uniform(2, 6);
  return {makeHedge(beside, piece.object.id + 3 * kNextPost, length, 1, random), std::nullopt};
}

}  // namespace

std::vector<Piece> deviating(Piece piece, const Site& site, const RealismOptions& realism,
                             Random random) {
  std::vector<Piece> pieces;
  const bool post = piece.pole && piece.object.kind != Kind::tree;
  const auto draws = [&](double rate) { return random.chance(realism.share(rate)); };
  if (post && draws(realism.multiple)) {
    const double along = random.uniform(0.3, 0.6);
    const std::uint32_t more = random.chance(0.5) ? 2 : 1;
    for (std::uint32_t i = 1; i <= more; ++i)
      pieces.push_back(nextPost(piece, site, i * along, piece.object.id + i * kNextPost));
  }
  if (piece.pole) {
    if (draws(realism.crooked)) bend(piece, site, random);
    if (post && draws(realism.tapered)) taper(piece, site, random);
    if (draws(realism.leaning)) lean(piece, site, random);
    if (post && draws(realism.boxes)) addBox(piece, site, random);
    if (draws(realism.ivy)) addIvy(piece, site, random);
    if (draws(realism.hedges)) pieces.push_back(hedgeAt(piece, site, random));
    piece.object.radius += 1;  // bends and leans, m
  }
  pieces.insert(pieces.begin(), std::move(piece));
  return pieces;
}

}  // namespace polemcl::sim
