#pragma once
/// \file Street.h
/// \brief The centre line of a road by arc length, generated or from a track file.

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/common/SimulationOptions.h"

namespace polemcl::sim {

/// \brief A polyline with a vertex every `step()` metres. s runs from 0 to length(); lateral
/// offsets are positive to the left.
class Street {
 public:
  /// \brief A gently curved street, or the track named in the options.
  /// \throws Error when the track cannot be read, has fewer than two places or a line without 12
  ///         numbers.
  static Street make(const WorldOptions& options);
  /// \brief A street along places. Places less than 0.4 m from the previous one are skipped.
  /// \throws Error when fewer than two places remain.
  explicit Street(const std::vector<Eigen::Vector2d>& places);

  static constexpr double step() { return 0.5; }
  double length() const { return step() * static_cast<double>(m_points.size() - 1); }
  /// \brief Point at s (clamped to the street) and lateral offset, with the heading of the street.
  Pose2D at(double s, double lateral = 0) const;
  /// \brief Distance of a point to the street, m, at most `limit` (< 64 m).
  double distance(double x, double y, double limit) const;
  /// \brief False where the street runs along a part of itself with smaller s (a road driven
  /// twice).
  bool fresh(double s) const { return m_fresh[indexOf(s)]; }
  const std::vector<Eigen::Vector2d>& points() const { return m_points; }

 private:
  std::size_t indexOf(double s) const;
  void resample(const std::vector<Eigen::Vector2d>& places);
  void findFreshParts();
  static std::int64_t cellOf(double x, double y);

  std::vector<Eigen::Vector2d> m_points;
  std::vector<double> m_heading;  ///< smoothed, unwrapped
  std::vector<char> m_fresh;
  std::unordered_map<std::int64_t, std::vector<std::int32_t>> m_cells;  ///< 16 m grid of vertices
};

}  // namespace polemcl::sim
