#pragma once
// Clouds for the tests of core: growing, shuffled, rotated.

#include <cmath>
#include <utility>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/common/Random.h"

namespace polemcl::clouds {

constexpr double kDegree = M_PI / 180;

/// \brief Owner of the data for a PointsView.
struct PointList {
  std::vector<float> x, y, z;
  void add(double px, double py, double pz) {
    x.push_back(static_cast<float>(px));
    y.push_back(static_cast<float>(py));
    z.push_back(static_cast<float>(pz));
  }
  /// \brief Adds a point by direction and distance: azimuth and elevation in rad, range in m.
  void addPolar(double azimuth, double elevation, double range) {
    add(range * std::cos(elevation) * std::cos(azimuth),
        range * std::cos(elevation) * std::sin(azimuth), range * std::sin(elevation));
  }
  void append(const PointsView& more) {
    x.insert(x.end(), more.x, more.x + more.size);
    y.insert(y.end(), more.y, more.y + more.size);
    z.insert(z.end(), more.z, more.z + more.size);
  }
  std::size_t size() const { return x.size(); }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// \brief The same points in another order.
inline PointList shuffled(const PointsView& points, std::uint64_t seed) {
  PointList out;
  out.append(points);
  sim::Random random(seed);
  for (std::size_t i = out.size(); i > 1; --i) {
    const std::size_t j = random.next() % i;
    std::swap(out.x[i - 1], out.x[j]);
    std::swap(out.y[i - 1], out.y[j]);
    std::swap(out.z[i - 1], out.z[j]);
  }
  return out;
}

/// \brief The same points rotated about z by `yaw` (rad, counter-clockwise).
inline PointList turned(const PointsView& points, double yaw) {
  PointList out;
  const double c = std::cos(yaw), s = std::sin(yaw);
  for (std::size_t i = 0; i < points.size; ++i)
    out.add(c * points.x[i] - s * points.y[i], s * points.x[i] + c * points.y[i], points.z[i]);
  return out;
}

}  // namespace polemcl::clouds
