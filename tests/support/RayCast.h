#pragma once
// Exact scans of a few simple solids, as an oracle: the source of every return is known.

#include <algorithm>
#include <optional>

#include "core/sensor/SensorModel.h"
#include "support/Clouds.h"

namespace polemcl::clouds {

/// \brief Vertical cylinder. LiDAR frame, m.
struct Cylinder {
  double x = 0, y = 0, radius = 0.1, bottom = -10, top = 10;
};
/// \brief Vertical rectangle over a line in the plane. LiDAR frame, m.
struct Wall {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0, bottom = -10, top = 10;
};
/// \brief z = height + slopeX x + slopeY y.
struct GroundPlane {
  double height = -1.73, slopeX = 0, slopeY = 0;
  double at(double x, double y) const { return height + slopeX * x + slopeY * y; }
};
struct Scene {
  std::vector<Cylinder> cylinders;
  std::vector<Wall> walls;
  std::optional<GroundPlane> ground;
};
struct Casting {
  double sigma = 0;      ///< of ranges, m
  double footprint = 0;  ///< full width of a beam, rad; a return needs 30 % of it
  std::uint64_t seed = 1;
  /// Azimuths to cast, rad: bearing ± half. A full revolution is not needed to look at one object.
  double bearing = 0, half = 4;
};

constexpr double kNothing = 1e9;

/// \brief Horizontal range of the first hit of a ray from (0, 0, apex).
inline double firstHit(const Scene& scene, double azimuth, double slope, double apex) {
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  double nearest = kNothing;
  const auto offer = [&](double rho, double bottom, double top) {
    const double z = apex + rho * slope;
    if (rho > 0 && rho < nearest && z >= bottom && z <= top) nearest = rho;
  };
  for (const Cylinder& o : scene.cylinders) {
    const double along = o.x * c + o.y * s, across = o.y * c - o.x * s;
    if (along > 0 && std::abs(across) < o.radius)
      offer(along - std::sqrt(o.radius * o.radius - across * across), o.bottom, o.top);
  }
  for (const Wall& w : scene.walls) {
    const double dx = w.x1 - w.x0, dy = w.y1 - w.y0;
    const double determinant = c * -dy + s * dx;
    if (std::abs(determinant) < 1e-12) continue;
    const double share = (c * w.y0 - s * w.x0) / determinant;
    if (share >= 0 && share <= 1) offer((w.x0 * -dy + w.y0 * dx) / determinant, w.bottom, w.top);
  }
  if (scene.ground) {
    const GroundPlane& g = *scene.ground;
    const double fall = g.slopeX * c + g.slopeY * s - slope;
    if (fall > 1e-9) offer((apex - g.height) / fall, -kNothing, kNothing);
  }
  return nearest;
}

/// \brief The return of a beam with a width: the nearest object that fills 30 % of it.
inline double firstEcho(const Scene& scene, double azimuth, const Beam& beam, double footprint) {
  if (footprint == 0) return firstHit(scene, azimuth, beam.slope, beam.offset);
  constexpr int kRays = 10;
  std::vector<double> hits;
  for (int i = 0; i < kRays; ++i)
    hits.push_back(
        firstHit(scene, azimuth + footprint * ((i + 0.5) / kRays - 0.5), beam.slope, beam.offset));
  std::sort(hits.begin(), hits.end());
  for (std::size_t first = 0; first < hits.size();) {
    std::size_t last = first;
    double sum = 0;
    for (; last < hits.size() && hits[last] - hits[first] < 0.5; ++last) sum += hits[last];
    const std::size_t n = last - first;
    if (n >= 3 && hits[first] < kNothing) return sum / static_cast<double>(n);
    first = last;
  }
  return kNothing;
}

/// \brief One revolution. Every beam starts at its own azimuth, as the lasers of real sensors do.
/// Returns beyond 100 m are lost.
inline PointList cast(const Scene& scene, const SensorModel& sensor, const Casting& casting = {}) {
  sim::Random random(casting.seed);
  PointList points;
  for (int row = 0; row < sensor.beamCount(); ++row) {
    const Beam& beam = sensor.beam(row);
    const double phase = random.uniform();
    for (int column = 0; column < sensor.columns(); ++column) {
      const double azimuth = -M_PI + (column + phase) * sensor.columnAngle();
      if (std::abs(std::remainder(azimuth - casting.bearing, 2 * M_PI)) > casting.half) continue;
      double rho = firstEcho(scene, azimuth, beam, casting.footprint);
      if (rho > 100) continue;
      if (casting.sigma > 0) rho += casting.sigma * random.normal() / std::hypot(1.0, beam.slope);
      points.add(rho * std::cos(azimuth), rho * std::sin(azimuth), beam.offset + rho * beam.slope);
    }
  }
  return points;
}

}  // namespace polemcl::clouds
