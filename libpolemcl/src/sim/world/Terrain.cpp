#include "sim/world/Terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/common/Random.h"

namespace polemcl::sim {
namespace {
constexpr double kNode = 0.5;  // m between nodes
constexpr int kNodes = 64;     // intervals of a tile
constexpr double kTile = kNode * kNodes;
constexpr double kReach = 64;   // distance from the street up to which tiles exist, m
constexpr double kFarEdge = 6;  // limit of the signed distance, m
}  // namespace

Terrain::Terrain(const WorldOptions& options, const Street& street,
                 const std::vector<SideRoad>& sideRoads, const std::vector<Detour>& detours)
    : m_seed(hash(options.seed, 0x7e44ull)), m_relief(options.relief) {
  Random random(m_seed);
  // Long waves make slopes of up to a few per cent; short waves make bumps.
  for (const double length : {900.0, 420.0, 230.0, 95.0, 41.0, 17.0}) {
    const double wave = length * random.uniform(0.85, 1.2), turn = random.uniform(0, 2 * M_PI);
    const double steepest = random.uniform(0.006, 0.017) * (length < 60 ? 0.5 : 1.0);
    m_waves.push_back({options.relief * steepest * wave / (2 * M_PI),
                       2 * M_PI / wave * std::cos(turn), 2 * M_PI / wave * std::sin(turn),
                       random.uniform(0, 2 * M_PI)});
  }
  std::vector<const Street*> streets{&street};
  for (const Detour& detour : detours) streets.push_back(&detour.path);
  allocate(streets);
  for (const Street* each : streets)
    for (std::size_t i = 0; i + 1 < each->points().size(); ++i)
      paintRoad(each->points()[i], each->points()[i + 1], options.roadWidth / 2);
  for (const SideRoad& road : sideRoads) paintRoad(road.a, road.b, road.halfWidth);
  fillHeights();
}

double Terrain::smooth(double x, double y) const {
  double height = 0;
  for (const Wave& wave : m_waves)
    height += wave.amplitude * std::sin(wave.kx * x + wave.ky * y + wave.phase);
  return height;
}

void Terrain::allocate(const std::vector<const Street*>& streets) {
  Eigen::Vector2d low = streets.front()->points().front(), high = low;
  for (const Street* street : streets)
    for (const auto& point : street->points()) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  m_origin = low.array() - kReach - kTile;
  m_tilesX = static_cast<int>(std::ceil((high.x() - m_origin.x() + kReach) / kTile)) + 1;
  m_tilesY = static_cast<int>(std::ceil((high.y() - m_origin.y() + kReach) / kTile)) + 1;
  m_tileOf.assign(static_cast<std::size_t>(m_tilesX) * m_tilesY, -1);
  for (const Street* street : streets)
    for (std::size_t i = 0; i < street->points().size(); i += 20) allocate(street->points()[i]);
}

void Terrain::allocate(const Eigen::Vector2d& place) {
  const int reach = static_cast<int>(std::ceil(kReach / kTile));
  const Eigen::Vector2d cell = (place - m_origin) / kTile;
  for (int tx = static_cast<int>(cell.x()) - reach; tx <= static_cast<int>(cell.x()) + reach; ++tx)
    for (int ty = static_cast<int>(cell.y()) - reach; ty <= static_cast<int>(cell.y()) + reach;
         ++ty) {
      if (tx < 0 || ty < 0 || tx >= m_tilesX || ty >= m_tilesY) continue;
      auto& tile = m_tileOf[static_cast<std::size_t>(ty) * m_tilesX + tx];
      if (tile >= 0) continue;
      tile = static_cast<std::int32_t>(m_tiles.size());
      m_tiles.emplace_back();
      m_tiles.back().edge.assign((kNodes + 1) * (kNodes + 1), static_cast<float>(kFarEdge));
    }
}

void Terrain::paintRoad(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double halfWidth) {
  const double reach = halfWidth + kFarEdge;
  const Eigen::Vector2d low = (from.cwiseMin(to).array() - reach - m_origin.array()) / kNode;
  const Eigen::Vector2d high = (from.cwiseMax(to).array() + reach - m_origin.array()) / kNode;
  const Eigen::Vector2d along = to - from;
  const double square = std::max(along.squaredNorm(), 1e-12);
  // Nodes on a seam belong to two tiles, so each tile is painted separately.
  for (int ty = std::max(0, static_cast<int>(low.y()) / kNodes - 1);
       ty <= static_cast<int>(high.y()) / kNodes && ty < m_tilesY; ++ty)
    for (int tx = std::max(0, static_cast<int>(low.x()) / kNodes - 1);
         tx <= static_cast<int>(high.x()) / kNodes && tx < m_tilesX; ++tx) {
      const auto tile = m_tileOf[static_cast<std::size_t>(ty) * m_tilesX + tx];
      if (tile < 0) continue;
      auto& edge = m_tiles[tile].edge;
      const int j0 = std::max(0, static_cast<int>(std::floor(low.y())) - ty * kNodes);
      const int j1 = std::min(kNodes, static_cast<int>(std::ceil(high.y())) - ty * kNodes);
      const int i0 = std::max(0, static_cast<int>(std::floor(low.x())) - tx * kNodes);
      const int i1 = std::min(kNodes, static_cast<int>(std::ceil(high.x())) - tx * kNodes);
      for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
          const Eigen::Vector2d node =
              m_origin + kNode * Eigen::Vector2d(tx * kNodes + i, ty * kNodes + j);
          const double share = std::clamp((node - from).dot(along) / square, 0.0, 1.0);
          const double distance = (node - from - share * along).norm() - halfWidth;
          float& value = edge[j * (kNodes + 1) + i];
          value = std::min(value, static_cast<float>(distance));
        }
    }
}

void Terrain::fillHeights() {
  for (int ty = 0; ty < m_tilesY; ++ty)
    for (int tx = 0; tx < m_tilesX; ++tx) {
      const auto index = m_tileOf[static_cast<std::size_t>(ty) * m_tilesX + tx];
      if (index < 0) continue;
      Tile& tile = m_tiles[index];
      tile.base.resize((kNodes + 1) * (kNodes + 1));
      for (int j = 0; j <= kNodes; ++j)
        for (int i = 0; i <= kNodes; ++i) {
          const int column = tx * kNodes + i, row = ty * kNodes + j;
          const double x = m_origin.x() + kNode * column, y = m_origin.y() + kNode * row;
          const double edge = tile.edge[j * (kNodes + 1) + i];
          // Surface roughness: centimetres beside the road, millimetres on it.
          const double bump = unitFloat(hash(m_seed, column, row)) - 0.5;
          const double wear = edge > 2.5 ? 0.05 : 0.012;
          // Roads are cambered, and the ground beside them falls towards them.
          const double camber = 0.02 * std::abs(edge);
          tile.base[j * (kNodes + 1) + i] =
              static_cast<float>(smooth(x, y) + m_relief * (wear * bump + camber));
        }
    }
}

Terrain::Sample Terrain::sample(double x, double y) const {
  const double cx = (x - m_origin.x()) / kTile, cy = (y - m_origin.y()) / kTile;
  if (cx < 0 || cy < 0 || cx >= m_tilesX || cy >= m_tilesY) return {smooth(x, y), kFarEdge};
  const int tx = static_cast<int>(cx), ty = static_cast<int>(cy);
  const auto index = m_tileOf[static_cast<std::size_t>(ty) * m_tilesX + tx];
  if (index < 0) return {smooth(x, y), kFarEdge};
  const double u = (cx - tx) * kNodes, v = (cy - ty) * kNodes;
  const int i = std::min(static_cast<int>(u), kNodes - 1),
            j = std::min(static_cast<int>(v), kNodes - 1);
  const double a = u - i, b = v - j;
  const Tile& tile = m_tiles[index];
  const std::size_t at = static_cast<std::size_t>(j) * (kNodes + 1) + i;
  const auto blend = [&](const std::vector<float>& grid) {
    return (1 - b) * ((1 - a) * grid[at] + a * grid[at + 1]) +
           b * ((1 - a) * grid[at + kNodes + 1] + a * grid[at + kNodes + 2]);
  };
  return {blend(tile.base), blend(tile.edge)};
}

double Terrain::solve(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double lift,
                      double start, double maxRange) const {
  // The slope of the ground is small, so the slope of the ray alone gives a good first step; secant
  // steps follow. Nearly level rays get a minimum slope, so that the steps do not diverge.
  constexpr double kLeastFall = 0.02;
  double range = start, fall = std::max(-direction.z(), kLeastFall);
  double rangeBefore = 0, aboveBefore = 0;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d point = origin + range * direction;
    const double above = point.z() - sample(point.x(), point.y()).base - lift;
    if (std::abs(above) < 0.002) return range;
    if (i > 0 && range != rangeBefore) {
      const double secant = (aboveBefore - above) / (range - rangeBefore);
      if (secant > 0.5 * fall && secant < 4 * fall) fall = secant;
    }
    rangeBefore = range;
    aboveBefore = above;
    range += above / fall;
    if (!(range < 2 * maxRange) || range < 0) break;
  }
  return std::max(range, 0.0);
}

Terrain::Hit Terrain::intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                double maxRange) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (direction.z() > 0.08) return {kNone, false, 0};  // steeper than any slope here
  const double above = origin.z() - sample(origin.x(), origin.y()).base;
  const double first = std::min(above / std::max(-direction.z(), 0.02), maxRange);
  const double low = solve(origin, direction, 0, first, maxRange);
  const double high = solve(origin, direction, kerbHeight(), low, maxRange);
  const auto edgeAt = [&](double range) {
    return sample(origin.x() + range * direction.x(), origin.y() + range * direction.y()).edge;
  };
  if (high > maxRange) return {kNone, false, 0};
  const double highEdge = edgeAt(high);
  if (highEdge > 0) return {high, false, highEdge};
  const double lowEdge = edgeAt(low);
  if (lowEdge <= 0) return low <= maxRange ? Hit{low, false, lowEdge} : Hit{kNone, false, 0};
  double before = high, behind = low;  // the kerb is between them
  for (int i = 0; i < 7; ++i) {
    const double middle = 0.5 * (before + behind);
    (edgeAt(middle) > 0 ? behind : before) = middle;
  }
  return {behind, true, 0};
}

}  // namespace polemcl::sim
