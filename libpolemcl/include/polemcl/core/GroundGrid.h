#pragma once
/// \file GroundGrid.h
/// \brief Height of the local ground around one scan, so that poles are measured from where they
/// stand.

#include <polemcl/core/ScanLines.h>

#include <vector>

namespace polemcl {

/// \brief Ground heights on a polar grid: sectors of azimuth times rings of range.
///
/// Each cell keeps its lowest return that a slope of at most `kMaxSlope` can reach from the cell
/// inside it; cells without one inherit. Outliers below the ground (reflections) fail the slope
/// test.
class GroundGrid {
 public:
  /// \param sensorHeight Nominal height of the lidar above ground, m: where the ground is looked
  /// for first.
  void build(const ScanLines& lines, float sensorHeight);
  /// \brief Ground height (lidar frame, m; negative below the sensor) under a place.
  float at(float azimuth, float rho) const;
  /// \brief Median of the innermost known heights, m.
  float median() const { return m_median; }

 private:
  static constexpr int kSectors = 64, kRings = 20;
  static constexpr float kRingWidth = 2.5f;  ///< m
  static constexpr float kMaxSlope = 0.15f;  ///< rise over run between neighbouring cells
  static constexpr float kSlack = 0.25f;     ///< m, kerbs and noise
  void collectLowest(const ScanLines& lines, float sensorHeight);
  static int sector(float azimuth);
  static int ring(float rho);
  float m_height[kSectors * kRings];
  float m_median = 0;
  std::vector<float> m_lowest, m_sorted;
};

}  // namespace polemcl
