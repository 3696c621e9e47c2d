#pragma once
/// \file Season.h
/// \brief What the time of the year does to a street of northern mid latitudes.

namespace polemcl::sim {

/// \brief Shares in [0, 1] of what stands or lies at most in a year.
struct Season {
  double foliage = 1;  ///< of the leaves of summer
  double snow = 0;     ///< of the height of midwinter's snow banks
};

/// \brief Buds break in mid April, trees are in full leaf from mid May to the end of September and
/// bare from late November; snow lies in December, banks are full from late December to mid
/// February and gone by mid March. Linear between. \param dayOfYear 1: 1 January. Any number; years
/// have 365 days.
Season seasonOf(double dayOfYear);

}  // namespace polemcl::sim
