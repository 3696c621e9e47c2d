#pragma once
/// \file ElevationHistogram.h
/// \brief How sharply elevations gather, for a given origin. Private to the library.

#include <cstdint>
#include <vector>

#include "core/sensor/BeamTableEstimator.h"

namespace polemcl {

/// \brief A return as the search sees it, m.
struct BeamPoint {
  float x, y, z;
};

/// \brief Histogram of slopes z / rho and its contrast: the share of returns that stands out
/// against the running mean of their surroundings. Keeps its buffers.
class ElevationHistogram {
 public:
  explicit ElevationHistogram(std::vector<BeamPoint> points) : m_points(std::move(points)) {}

  /// \brief Contrast in [0, 1]; the greater, the better the origin.
  double contrast(const BeamOrigin& origin);
  /// \brief How much of the contrast is due to the returns that lie, seen from `reference`, below
  /// each cell of slopes, in returns; the last entry is due to all.
  std::vector<double> cumulative(const BeamOrigin& origin, const BeamOrigin& reference);
  static double slopeOf(std::size_t cell);
  std::size_t size() const { return m_points.size(); }

 private:
  void fill(const BeamOrigin& origin);
  double mean(std::size_t cell) const;

  std::vector<BeamPoint> m_points;
  std::vector<float> m_counts, m_smooth;
  std::vector<double> m_sums;
};

/// \brief Horizontal range and height over the origin.
struct BeamCoordinates {
  double rho, z;
};
BeamCoordinates beamCoordinates(const BeamPoint& point, const BeamOrigin& origin);

}  // namespace polemcl
