#pragma once
/// \file ScanKernels.h
/// \brief The two loops over all points, vectorised and chosen at run time. Private to the library.
///
/// Only IEEE-exact operations (no fused multiply-add, no reciprocal estimates), so that every
/// instruction set gives the same bits.

#include <polemcl/core/ScanLines.h>

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

/// \brief Positions i in [0, count - 1) where returns i and i + 1 are not neighbours on one
/// surface: ranges differ by `step` or more, or the azimuth by `gap` or more (twice that where it
/// is < 0.15 m). \param breaks Room for count + kKernelPadding. \return How many were written,
/// ascending.
std::size_t findBreaks(const Return* returns, std::size_t count, float step, float gap,
                       std::uint32_t* breaks);

}  // namespace polemcl
