#pragma once
/// \file TipBlocks.h
/// \brief The lower ends of growing clusters, compared several at once. Private to the library.

#include <cstddef>
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
  float gap;             ///< greatest height of the tip above it, m
  std::uint32_t corner;  ///< of the four cells that are searched: the one of least x and y
};

constexpr std::uint32_t kNoCluster = ~0u;

/// \brief Tips by the cells of a square grid.
struct TipGrid {
  const TipBlock* blocks;      ///< number 0 is empty, and of kNoCluster
  const std::uint32_t* first;  ///< per cell: its first block; 0: none
  std::uint32_t cells;         ///< per side
  float squaredReach;          ///< greatest squared distance in the plane, m²
};

/// \brief For each query the cluster with the nearest tip in four cells, from another row and
/// within reach; of two tips at the same distance the one of the lower number. kNoCluster: none.
void findNearestTips(const TipGrid& grid, const TipQuery* queries, std::size_t count,
                     std::uint32_t* clusters);

}  // namespace polemcl
