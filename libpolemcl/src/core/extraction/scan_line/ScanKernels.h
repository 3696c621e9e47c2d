#pragma once
/// \file ScanKernels.h
/// \brief The loops over all points, vectorised and chosen at run time. Private to the library.
///
/// Only IEEE-exact operations (no fused multiply-add, no reciprocal estimates), so that every
/// instruction set gives the same bits.

#include <cmath>

#include "core/extraction/scan_line/GroundGrid.h"
#include "core/extraction/scan_line/ScanLines.h"

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

/// \brief Returns not yet in rows.
struct UnsortedReturns {
  Return* returns;
  std::int32_t* bucket;  ///< row * buckets + column; rows * buckets when out of view
};

/// \brief Returns of the points that lie above a limit.
/// \param limit Per cell of the ground: least z, m.
/// \param rows,bucketsPerRow Beams, and columns of equal azimuth from -pi to pi.
/// \return How many were written.
std::size_t classifyPoints(const PointsView& points, const std::uint16_t* cell, const float* limit,
                           const RingLookup& lookup, int rows, int bucketsPerRow,
                           const UnsortedReturns& out);

/// \brief Widest gap, m, that neighbours up to two `gap`s apart may have between them.
constexpr float kBridge = 0.15f;

/// \brief True when returns a and b, `turn` rad apart, are neighbours on one surface: ranges differ
/// by less than `step`, and the azimuth by less than `gap` (twice that where it is < kBridge).
inline bool joined(const Return& a, const Return& b, float turn, float step, float gap) {
  return std::abs(b.rho - a.rho) < step &&
         (turn < gap || (turn < 2 * gap && turn * a.rho < kBridge));
}

/// \brief Positions i in [0, count - 1) where returns i and i + 1 are not joined().
/// \param breaks Room for count + kKernelPadding. \return How many were written, ascending.
std::size_t findBreaks(const Return* returns, std::size_t count, float step, float gap,
                       std::uint32_t* breaks);

}  // namespace polemcl
