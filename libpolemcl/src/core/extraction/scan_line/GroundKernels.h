#pragma once
/// \file GroundKernels.h
/// \brief The loops over all points that find the ground, vectorised and chosen at run time. Every
/// instruction set gives the same bits. Private to the library.

#include "core/extraction/scan_line/GroundGrid.h"

namespace polemcl {

/// \brief Lanes to allow beyond the number of points in the outputs of the kernels.
constexpr std::size_t kKernelPadding = 64;

/// \brief Where the lowest points of a ground grid are collected.
struct LowestPoints {
  std::uint16_t* cell;  ///< out, per point; GroundGrid::kNoCell for dropped points
  float* lowest;        ///< in and out, per cell; infinity at first
  /// In and out, per cell and one more: the second lowest. At first the height from which on
  /// points are no ground; that of kNoCell must be -infinity.
  float* second;
};

/// \brief Cell of every point of a ground grid, and the two lowest points of every cell.
GroundGrid::Counts collectLowest(const PointsView& points, float minRange, float maxRange,
                                 const LowestPoints& out);

}  // namespace polemcl
