#pragma once
/// \file TipBlocks.h
/// \brief The lower ends of growing clusters, compared several at once. Private to the library.

#include <cstdint>

namespace polemcl {

/// \brief Tips of clusters in one cell of the plane.
struct TipBlock {
  static constexpr int kSlots = 4;
  float x[kSlots], y[kSlots], z[kSlots];  ///< m; z is infinite where the slot is free
  std::int32_t row[kSlots];
  std::uint32_t cluster[kSlots];
  std::uint32_t cell, next;  ///< another block of the same cell; 0: none
};

/// \brief A segment that looks for a tip above it.
struct TipQuery {
  float x, y, z;  ///< m
  std::int32_t row;
  float gap;           ///< greatest height of the tip above it, m
  float squaredReach;  ///< greatest squared distance in the plane, m²
};

constexpr std::uint32_t kNoCluster = ~0u;

/// \brief The cluster with the nearest tip in four cells, from another row and within reach; of two
/// tips at the same distance the one of the lower number. kNoCluster: none.
/// \param blocks Number 0 is empty.
/// \param lower,upper First blocks of two neighbouring cells each; 0: none.
using NearestTip = std::uint32_t (*)(const TipBlock* blocks, const std::uint32_t* lower,
                                     const std::uint32_t* upper, const TipQuery& query);
/// \brief The function for this processor's instructions; all give the same result.
NearestTip nearestTip();

}  // namespace polemcl
