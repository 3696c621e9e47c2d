#pragma once
/// \file ScanKernels.h
/// \brief The two loops over all points, vectorised and chosen at run time. Private to the library.
///
/// Only IEEE-exact operations (no fused multiply-add, no reciprocal estimates), so that every
/// instruction set gives the same bits.

#include <polemcl/core/ScanLines.h>

#include <cmath>

namespace polemcl {

struct PointKeys {
  std::int32_t* bucket;  ///< row * buckets + column, -1 when dropped
  float* azimuth;        ///< rad
  float* rho;            ///< m
};

/// \brief Lanes to allow beyond the number of points in the outputs of the kernels.
constexpr std::size_t kKernelPadding = 64;

/// \brief Row, azimuth column, azimuth and horizontal range of every point.
/// \param bucketsPerRow Columns of equal azimuth from -pi to pi.
ScanLines::Counts classifyPoints(const PointsView& points, const RowLookup& lookup,
                                 int bucketsPerRow, float minRange, float maxRange,
                                 const PointKeys& keys);

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
