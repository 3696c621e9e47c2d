#pragma once
/// \file GroundGrid.h
/// \brief Height of the local ground around one scan, so that poles are measured from where they
/// stand.

#include <cmath>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Ground heights on a polar grid: sectors of azimuth times rings of range.
///
/// All heights are levels: heights over a level plane through the sensor, along z. Of an upright
/// lidar, levels are z.
/// Each cell keeps its lowest point that a slope of at most `kMaxSlope` can reach from the cell
/// inside it; cells without one inherit. Outliers below the ground (reflections) fail the slope
/// test. Sectors are of equal width in y / (|x| + |y|), which needs no arc tangent: 4.5° to 8.1°.
class GroundGrid {
 public:
  static constexpr int kSectors = 64, kRings = 16;
  static constexpr float kRingWidth = 2.5f;  ///< m; the last ring has no outer end
  static constexpr int kCells = kSectors * kRings;
  static constexpr std::uint16_t kNoCell = kCells;  ///< of a point that was dropped

  struct Counts {
    std::size_t invalid = 0;     ///< NaN, infinite, or at the sensor
    std::size_t outOfRange = 0;  ///< nearer or farther than wanted
  };

  /// \param points Lidar frame, m.
  /// \param minRange,maxRange Bounds of the horizontal range, m; points outside are dropped.
  /// \param sensorHeight Nominal height of the lidar above ground, m: where the ground is looked
  /// for first. \param upright Shift of an upright pole along x and y per unit of height.
  const Counts& build(const PointsView& points, float minRange, float maxRange, float sensorHeight,
                      const Eigen::Vector2f& upright = Eigen::Vector2f::Zero());
  const Counts& counts() const { return m_counts; }
  /// \brief z of the ground (lidar frame, m; negative below the sensor) at a place, interpolated
  /// between the middles of the cells.
  float at(float x, float y) const;
  /// \brief Median level of a ring near the sensor, m.
  float median() const { return m_median; }

  /// \brief Cell of each of the points last built from; kNoCell for dropped ones.
  const std::uint16_t* cells() const { return m_cell.data(); }
  /// \brief Level of each of these points, m.
  const float* levels() const { return m_levels; }
  /// \brief Level of a cell, 0 to kCells - 1.
  float height(int cell) const { return m_height[cell]; }
  /// \brief Whether a point fell into a cell.
  bool hasPoints(int cell) const { return std::isfinite(m_lowest[cell]); }
  /// \brief The cell of a place.
  static int cell(float x, float y);

 private:
  /// Sectors and rings from the grid's corner.
  struct Place {
    float sector, ring;
  };
  static Place place(float x, float y);
  PointsView levelled(const PointsView& points);
  void climb(float sensorHeight);
  void smooth();

  Counts m_counts;
  float m_rough[kCells], m_height[kCells];
  float m_lowest[kCells + 1], m_second[kCells + 1];
  float m_median = 0;
  std::vector<std::uint16_t> m_cell;
  Eigen::Vector2f m_upright = Eigen::Vector2f::Zero();
  const float* m_levels = nullptr;  ///< z of the points, or m_tilted
  std::vector<float> m_tilted;
};

}  // namespace polemcl
