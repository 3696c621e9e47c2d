#pragma once
/// \file MapDiff.h
/// \brief What changed between two maps of one place.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

struct MapDiffOptions {
  double same = 0.25;     ///< poles nearer than this are the same, m
  double moved = 1.5;     ///< a vanished and a new pole nearer than this are one that moved, m
  void validate() const;  ///< \throws Error
};

struct MapDiff {
  struct Pair {
    MapPole before, after;
    double distance = 0;  ///< m
  };
  std::vector<Pair> same, moved;
  std::vector<MapPole> appeared;  ///< only on the later map
  std::vector<MapPole> vanished;  ///< only on the earlier map
};

/// \brief One to one, nearest pairs first: those within `same`, then of the rest those within
/// `moved`. All lists by x then y (pairs by the later place).
/// \throws Error on options out of range or a place that is not finite.
MapDiff diffMaps(const std::vector<MapPole>& before, const std::vector<MapPole>& after,
                 const MapDiffOptions& options = {});

}  // namespace polemcl
