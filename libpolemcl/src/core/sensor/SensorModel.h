#pragma once
/// \file SensorModel.h
/// \brief The beams of a spinning LiDAR, or the rows of a depth image: which row a point belongs
/// to.

#include <cstdint>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include "core/sensor/PinholeCamera.h"

namespace polemcl {

/// \brief One laser: its returns lie on z = rho · slope + offset in the lidar frame, rho = hypot(x,
/// y).
struct Beam {
  double slope = 0;  ///< tangent of the elevation; of a camera: up / ahead in the camera's axes
  double offset =
      0;  ///< height of the cone's apex above the origin, m (HDL-64E: two blocks, 0.2 and 0.12 m)
};

/// \brief From a point's slope to its row: cells of equal slope for each of at most two blocks of
/// lasers. Block 0 is the upper one; a point belongs to block 1 when z < rho · splitSlope +
/// splitOffset.
struct RingLookup {
  float splitSlope = -1e9f, splitOffset = 0;
  float offset[2] = {0, 0};       ///< height of the block's apex, m
  float minSlope[2] = {0, 0};     ///< of its first cell
  float cells[2] = {0, 0};        ///< number of cells
  std::int32_t base[2] = {0, 0};  ///< index of its first cell in `row`
  float cellsPerSlope = 0;
  std::vector<std::int32_t> row;
  /// Depth cameras: rows are planes through the origin. The slope is (up · p) / (ahead · p), one
  /// cell is one row, and only block 0 is used; `row` is empty.
  bool planes = false;
  float ahead[3] = {1, 0, 0}, up[3] = {0, 0, 1};
};

/// \brief Beams of one sensor, topmost first, and the lookup from a point to its row.
///
/// All lasers of a block share one offset for the lookup; the HDL-64E has two blocks, the upper one
/// above `splitSlope`/`splitOffset`, other sensors have one.
class SensorModel {
 public:
  /// \throws Error for an unknown model or a table that makes no sense.
  explicit SensorModel(const SensorOptions& options);
  /// \brief Rows of a depth image: those lines of pixels, rows or columns, that lie more level.
  /// \throws Error as PinholeCamera::validate().
  explicit SensorModel(const PinholeCamera& camera);

  int beamCount() const { return static_cast<int>(m_beams.size()); }
  int columns() const { return m_columns; }             ///< firing steps in a full turn
  double columnAngle() const { return m_columnAngle; }  ///< rad between firing steps
  const Beam& beam(int row) const { return m_beams[row]; }
  /// \brief Angle between the beam of this row and the one above it, rad; the topmost row repeats
  /// its lower gap.
  double spacingAbove(int row) const { return m_spacingAbove[row]; }

  /// \brief Height, lidar frame, at which the beam of a row passes over the place (x, y), rho =
  /// hypot(x, y), m; infinity when a camera's row never does.
  float heightOver(int row, float x, float y, float rho) const;

  /// \brief Row of the nearest beam of a LiDAR, or -1 when the point lies outside the fan.
  int row(float rho, float z) const {
    const int block = z < rho * m_lookup.splitSlope + m_lookup.splitOffset ? 1 : 0;
    const float slope = (z - m_lookup.offset[block]) / rho;
    const float cell = (slope - m_lookup.minSlope[block]) * m_lookup.cellsPerSlope;
    if (!(cell >= 0.f && cell < m_lookup.cells[block])) return -1;
    return m_lookup.row[m_lookup.base[block] + static_cast<int>(cell)];
  }
  const RingLookup& lookup() const { return m_lookup; }

  /// \brief Names `model =` accepts, for error messages.
  static std::vector<std::string> modelNames();

 private:
  void buildBlock(int block, int firstRow, int lastRow);

  std::vector<Beam> m_beams;
  std::vector<double> m_spacingAbove;
  RingLookup m_lookup;
  int m_columns = 0;
  double m_columnAngle = 0;
};

}  // namespace polemcl
