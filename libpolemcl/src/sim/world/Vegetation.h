#pragma once
/// \file Vegetation.h
/// \brief Trees, bushes, hedges.

#include "sim/world/Furniture.h"

namespace polemcl::sim {

/// \brief Trees of one planting: an avenue has one sort and age.
struct TreeStyle {
  double trunkRadius, crownBase, height, crownRadius;  ///< m
  explicit TreeStyle(Random& random);
};

/// \param foliage Scales the density of leaves; 0 gives bare branches.
Piece makeTree(const Site& site, std::uint32_t id, const TreeStyle& style, double foliage,
               Random& random);
WorldObject makeBush(const Site& site, std::uint32_t id, double foliage, Random& random);
/// \brief Hedge along local x, centred on the site.
WorldObject makeHedge(const Site& site, std::uint32_t id, double length, double foliage,
                      Random& random);

}  // namespace polemcl::sim
