#include "core/mapping/IncrementalMerge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/common/GreedyAssignment.h"

namespace polemcl {
namespace {

void absorb(MapPole& pole, const PoleDetection& seen) {
  const double n = pole.count, all = n + 1;
  pole.x += (seen.x - pole.x) / all;
  pole.y += (seen.y - pole.y) / all;
  pole.radius += (seen.radius - pole.radius) / all;
  pole.confidence += (seen.confidence - pole.confidence) / all;
  pole.bottom = std::min(pole.bottom, seen.bottom);
  pole.top = std::max(pole.top, seen.top);
  // Covariance of the mean of n + 1 independent detections; the pole's covariance sums up n of
  // them.
  pole.covariance = (n * n * pole.covariance + seen.covariance) / (all * all);
  if (pole.count < std::numeric_limits<std::uint32_t>::max()) ++pole.count;
}

MapPole newPole(const PoleDetection& seen) {
  MapPole pole;
  pole.x = seen.x;
  pole.y = seen.y;
  pole.radius = seen.radius;
  pole.bottom = seen.bottom;
  pole.top = seen.top;
  pole.confidence = seen.confidence;
  pole.covariance = seen.covariance;
  pole.count = 1;
  return pole;
}

}  // namespace

IncrementalMerge::IncrementalMerge(const std::vector<MapPole>& poles, double mergeDistance)
    : m_mergeDistance(mergeDistance) {
  for (std::size_t i = 0; i < poles.size(); ++i) m_cells[cellOf(poles[i])].push_back(i);
}

/// Cells far apart may share a number: distances tell their poles apart.
template <class Place>
std::uint64_t IncrementalMerge::cellOf(const Place& place, int columns, int rows) const {
  constexpr double kMostCells = 1e18;
  const auto number = [&](double coordinate, int steps) {
    const double cell = std::clamp(coordinate / m_mergeDistance, -kMostCells, kMostCells);
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(cell)) + steps);
  };
  return number(place.x, columns) * 0x9E3779B97F4A7C15u ^ number(place.y, rows);
}

void IncrementalMerge::insertScan(std::vector<MapPole>& poles,
                                  const std::vector<PoleDetection>& detections_map) {
  std::vector<AssignedPair> pairs;  // detection, pole
  for (std::size_t i = 0; i < detections_map.size(); ++i) {
    const PoleDetection& seen = detections_map[i];
    for (int cell = 0; cell < 9; ++cell) {
      const auto near = m_cells.find(cellOf(seen, cell / 3 - 1, cell % 3 - 1));
      if (near == m_cells.end()) continue;
      for (const std::size_t pole : near->second) {
        const double distance = std::hypot(poles[pole].x - seen.x, poles[pole].y - seen.y);
        if (distance < m_mergeDistance) pairs.push_back({i, pole, distance});
      }
    }
  }
  std::vector<bool> merged(detections_map.size());
  for (const AssignedPair& pair : chooseClosest(std::move(pairs))) {
    merged[pair.first] = true;
    MapPole& pole = poles[pair.second];
    auto& before = m_cells[cellOf(pole)];
    before.erase(std::find(before.begin(), before.end(), pair.second));
    absorb(pole, detections_map[pair.first]);
    m_cells[cellOf(pole)].push_back(pair.second);
  }
  for (std::size_t i = 0; i < detections_map.size(); ++i) {
    if (merged[i]) continue;
    m_cells[cellOf(detections_map[i])].push_back(poles.size());
    poles.push_back(newPole(detections_map[i]));
  }
}

}  // namespace polemcl
