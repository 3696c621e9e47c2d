#pragma once
/// \file BeamTableEstimator.h
/// \brief The beams of an unknown spinning LiDAR, found in its clouds.
///
/// Returns of one laser lie on a cone z = rho · tan(elevation) + apex around the sensor's axis.
/// Seen from the right origin their elevations gather in narrow peaks; from any other place they
/// smear.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Lasers that start from one height. HDL-64E: two such blocks, all others: one.
struct BeamBlock {
  double apex = 0;                 ///< height above the cloud's origin, m
  std::vector<double> elevations;  ///< rad, topmost first
};

/// \brief Where a cloud must be looked at from to see its beams.
struct BeamOrigin {
  double x = 0, y = 0, z = 0;  ///< m, in the frame of the cloud
  /// Clouds whose points were moved to where the sensor was in the middle of the turn: the way
  /// along x of one whole turn, m, + when azimuth and time grow together; 0 for clouds as measured.
  double slide = 0;
};

/// \brief What estimateBeamTable() found.
struct BeamTableEstimate {
  BeamOrigin origin;              ///< z: of the upper block, or the only one
  std::vector<BeamBlock> blocks;  ///< one or two, the upper one first; apex includes origin.z
  double spread = 0;              ///< median deviation of a return from its beam, rad
  /// Share of returns within the middle third of their beam's cell (half-way to both neighbours);
  /// a cloud without beams has about a third.
  double sharpness = 0;
  std::size_t points = 0;  ///< that were looked at

  int beams() const;
  /// \brief All elevations, topmost first, rad.
  std::vector<double> elevations() const;
};

/// \brief Finds the beams. The order of the points does not matter, down to the last bit.
/// \param scans Clouds of one sensor in its own axes, z up or down; NaN and zeros are passed over.
/// \throws Error when there are too few points, or no beams in them: clouds that were merged,
///         thinned by voxels, or tilted.
BeamTableEstimate estimateBeamTable(const std::vector<PointsView>& scans);

}  // namespace polemcl
