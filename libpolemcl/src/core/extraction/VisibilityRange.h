#pragma once
/// \file VisibilityRange.h
/// \brief How far a pole could have been seen in each direction: what tells "not there" from "not
/// to be seen from here".

#include <cstdint>
#include <limits>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/extraction/scan_line/GroundGrid.h"
#include "core/extraction/scan_line/ScanLines.h"
#include "core/sensor/SensorModel.h"

namespace polemcl {

/// \brief The sector of n that an azimuth falls into: sector i spans -pi + i·2pi/n to
/// -pi + (i + 1)·2pi/n. \param azimuth rad, any turn; must be finite. \param sectors At least 1.
std::size_t visibilityRangeSector(double azimuth, std::size_t sectors);

/// \brief Visibility range towards a thing so wide: the least of the sectors it reaches into, so
/// that an edge beside it is not seen through.
/// \param visibilityRange As VisibilityRangeFinder gives it; may be empty.
/// \param halfWidth Half the width of the thing across the line of sight, m.
/// \return m; 0 where one of the sectors, or all, are unknown.
double visibilityRangeTowards(const std::vector<float>& visibilityRange, double x, double y,
                              double halfWidth);

/// \brief Whether a scan could have found a pole: nothing stands before it.
/// \param visibilityRange As VisibilityRangeFinder gives it; empty: nothing is in view.
/// \param pose_map_sensor Of the frame of visibilityRange.
bool isInView(const std::vector<float>& visibilityRange, const Pose2D& pose_map_sensor,
              const MapPole& pole);

/// \brief Judges the visibility range from the beams at pole heights (0.5 to 3 m above the
/// ground).
///
/// At a range, the beams that pass there at pole heights are counted (ground taken as level at the
/// lidar's nominal height, also under a tilted one; those that reach the ground within 5 m or so
/// are left out, of 32 and more every second, third … is taken). A beam that met something nearer
/// in the sector is blocked. The visibility range is the last of steps of 0.5 m before which at
/// least half of the beams, and two, are free; it ends where fewer than two beams pass at pole
/// heights at all, and at the extractor's greatest range. A pole ends the visibility range of its
/// own direction at its front. Beams without a return count as free; a direction in which not a
/// single point was seen is unknown.
class VisibilityRangeFinder {
 public:
  static constexpr int kSectors = 256;     ///< 1.4° each
  static constexpr float kStep = 0.5f;     ///< m
  static constexpr float kLowest = 0.5f;   ///< of pole heights, m above ground
  static constexpr float kHighest = 3.0f;  ///< m above ground
  /// \param sensorHeight Height of the lidar above ground, m.
  /// \param maxRange Maximum range of poles, m.
  VisibilityRangeFinder(const SensorModel& sensor, double sensorHeight, double maxRange);
  /// \param visibilityRange Becomes kSectors ranges, m, horizontal, lidar frame; sector i as
  /// visibilityRangeSector(). 0: unknown. Empty for depth cameras.
  /// \param upright Shift of an upright pole along x and y per unit of height, lidar frame.
  void find(const ScanLines& lines, const GroundGrid& ground, const Eigen::Vector2f& upright,
            std::vector<float>& visibilityRange);

 private:
  /// \brief Steps of range at which a beam passes at pole heights: first to last, or last is -1.
  struct Span {
    std::int16_t first, last;
  };
  struct Beam {
    int row;
    Span span[kSectors];
  };
  void setUpright(const Eigen::Vector2f& upright);
  void chooseBeams();
  Span spanAtPoleHeights(const std::vector<float>& heights, float rise) const;
  void countBlocked(const ScanLines& lines, const Beam& beam);
  void countFree(std::int16_t* reached) const;

  const SensorModel& m_sensor;
  float m_sensorHeight;
  /// Up, of the scan before. NaN as long as there was none.
  Eigen::Vector2f m_upright = Eigen::Vector2f::Constant(std::numeric_limits<float>::quiet_NaN());
  std::vector<Beam> m_beams;
  /// step * kSectors + sector: beams that may be blocked.
  std::vector<std::int16_t> m_mostBlocked;
  /// step * kSectors + sector: blocked beams more than at the step before.
  std::vector<std::int16_t> m_change;
  std::uint16_t m_groundSector[kSectors] = {};  ///< of GroundGrid, by sector
  std::int16_t m_firstJudged[kSectors] = {};    ///< step, by sector
  int m_steps = 0;
};

}  // namespace polemcl
