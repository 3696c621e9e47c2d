#pragma once
// Scan lines of all points of a cloud, those on the ground included.

#include "core/extraction/scan_line/ScanLines.h"

namespace polemcl::clouds {

/// \brief Counts of the points in both steps.
struct WholeScanCounts {
  ScanLines::Counts lines;
  GroundGrid::Counts dropped;
};

inline WholeScanCounts buildWhole(ScanLines& lines, const PointsView& points, float minRange,
                                  float maxRange) {
  constexpr float kAbyss = 1e6f;  // m: a ground so low that no point is on it
  GroundGrid ground;
  ground.build(points, minRange, maxRange, kAbyss);
  return {lines.build(points, ground, 0), ground.counts()};
}

}  // namespace polemcl::clouds
