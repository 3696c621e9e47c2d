#pragma once
/// \file SensorModel.h
/// \brief The beams of a spinning LiDAR: which row a point belongs to.

#include <polemcl/core/ExtractionOptions.h>
#include <polemcl/core/Types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace polemcl {

/// \brief One laser: its returns lie on z = rho · slope + offset in the lidar frame, rho = hypot(x,
/// y).
struct Beam {
  double slope = 0;  ///< tangent of the elevation
  double offset =
      0;  ///< height of the cone's apex above the origin, m (HDL-64E: two blocks, 0.2 and 0.12 m)
};

/// \brief Beams of one sensor, topmost first, and the lookup from a point to its row.
///
/// All lasers of a block share one offset for the lookup; the HDL-64E has two blocks, the upper one
/// above `splitSlope`/`splitOffset`, other sensors have one.
class SensorModel {
 public:
  /// \throws Error for an unknown model or a table that makes no sense.
  explicit SensorModel(const SensorOptions& options);

  int rows() const { return static_cast<int>(m_beams.size()); }
  int columns() const { return m_columns; }             ///< firing steps in a full turn
  double columnAngle() const { return m_columnAngle; }  ///< rad between firing steps
  const Beam& beam(int row) const { return m_beams[row]; }
  /// \brief Angle between the beam of this row and the one above it, rad; the topmost row repeats
  /// its lower gap.
  double spacingAbove(int row) const { return m_spacingAbove[row]; }

  /// \brief Row of the nearest beam, or -1 when the point lies outside the fan.
  int row(float rho, float z) const {
    const Block& block = m_blocks[z < rho * m_splitSlope + m_splitOffset ? m_blocks.size() - 1 : 0];
    const float cell = ((z - block.offset) / rho - block.minSlope) * block.cellsPerSlope;
    if (!(cell >= 0.f && cell < static_cast<float>(block.row.size()))) return -1;
    return block.row[static_cast<std::size_t>(cell)];
  }

  /// \brief Names `model =` accepts, for error messages.
  static std::vector<std::string> modelNames();

 private:
  struct Block {
    float offset = 0, minSlope = 0, cellsPerSlope = 0;
    std::vector<std::int16_t> row;
  };
  void buildBlock(int firstRow, int lastRow);

  std::vector<Beam> m_beams;
  std::vector<double> m_spacingAbove;
  std::vector<Block> m_blocks;  ///< one, or upper and lower
  float m_splitSlope = 0, m_splitOffset = 0;
  int m_columns = 0;
  double m_columnAngle = 0;
};

}  // namespace polemcl
