#pragma once
/// \file Season.h
/// \brief Effects of the season on a street in northern mid latitudes.

namespace polemcl::sim {

/// \brief Shares in [0, 1] of the maximum within a year.
struct Season {
  double foliage = 1;  ///< share of the leaves of summer
  double snow = 0;     ///< share of the height of midwinter's snow banks
};

/// \brief Season of a day. Leaves: they start in mid April, are complete from mid May to the end of
/// September, and are gone in late November. Snow: it starts in December, is complete from late
/// December to mid February, and is gone by mid March. Linear in between.
/// \param dayOfYear 1: 1 January. Any number; years have 365 days.
Season seasonOf(double dayOfYear);

}  // namespace polemcl::sim
