#include "core/mapping/LabelMapBuilder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>

#include "core/common/KdTree2D.h"

namespace polemcl {
namespace {

constexpr std::uint32_t kClassBits = 0xffff;
constexpr double kFarthest = 1e5;     ///< m: cells are numbered with 31 bits
constexpr double kSigma = 0.05;       ///< m, of a pole's place: poses, labels, one side seen
constexpr double kLeastWidth = 0.02;  ///< m, of radii

template <class Value>
[[noreturn]] void refuseLabelOption(const char* field, Value value, const char* allowed) {
  std::ostringstream text;
  text << field << " = " << value << " is not allowed; it must be " << allowed;
  throw Error(text.str());
}

std::uint64_t packed(std::int64_t ix, std::int64_t iy, bool sign) {
  constexpr std::uint64_t bits = (1ull << 31) - 1;
  return (static_cast<std::uint64_t>(ix) & bits) << 32 |
         (static_cast<std::uint64_t>(iy) & bits) << 1 | static_cast<std::uint64_t>(sign);
}

bool isOneOf(const std::vector<std::uint32_t>& classes, std::uint32_t label) {
  return std::find(classes.begin(), classes.end(), label & kClassBits) != classes.end();
}

/// A column, out of the grid.
struct Piece {
  Eigen::Vector2d centre;
  float lowest, highest;
  std::uint32_t points, scans;
  bool sign;
};

/// Numbers of things that hang together, by chains of pieces nearer than `link`.
std::vector<std::uint32_t> linked(const std::vector<Piece>& pieces, double link) {
  std::vector<Eigen::Vector2d> places;
  places.reserve(pieces.size());
  for (const Piece& piece : pieces) places.push_back(piece.centre);
  const KdTree2D tree(places);
  std::vector<std::uint32_t> thing(pieces.size(), PointHit::none), open;
  std::vector<PointHit> near;
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < pieces.size(); ++first) {
    if (thing[first] != PointHit::none) continue;
    thing[first] = count;
    open = {first};
    while (!open.empty()) {
      const Eigen::Vector2d at = places[open.back()];
      open.pop_back();
      tree.within(at.x(), at.y(), link, near);
      for (const PointHit& hit : near) {
        if (thing[hit.index] != PointHit::none) continue;
        thing[hit.index] = count;
        open.push_back(hit.index);
      }
    }
    ++count;
  }
  return thing;
}

bool hasStem(const std::vector<Piece>& pieces) {
  return std::any_of(pieces.begin(), pieces.end(), [](const Piece& piece) { return !piece.sign; });
}

/// Takes the pieces round the strongest one out of `rest`.
std::vector<Piece> takePole(std::vector<Piece>& rest, double maxWidth) {
  const auto strongest =
      std::max_element(rest.begin(), rest.end(), [](const auto& a, const auto& b) {
        return std::tuple(!a.sign, a.points) < std::tuple(!b.sign, b.points);
      });
  const Eigen::Vector2d at = strongest->centre;
  const auto others = std::stable_partition(rest.begin(), rest.end(), [&](const Piece& piece) {
    return (piece.centre - at).norm() <= maxWidth / 2;
  });
  std::vector<Piece> pole(rest.begin(), others);
  rest.erase(rest.begin(), others);
  return pole;
}

MapPole poleOf(std::vector<Piece> pieces) {
  MapPole pole;
  float lowest = pieces.front().lowest, highest = pieces.front().highest;
  for (const Piece& piece : pieces) {
    lowest = std::min(lowest, piece.lowest);
    highest = std::max(highest, piece.highest);
    pole.count = std::max(pole.count, piece.scans);
  }
  pole.top = static_cast<double>(highest) - static_cast<double>(lowest);
  const auto stem = std::stable_partition(pieces.begin(), pieces.end(),
                                          [](const Piece& piece) { return !piece.sign; });
  if (stem != pieces.begin()) pieces.erase(stem, pieces.end());
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Piece& piece : pieces) centre += piece.centre;
  centre /= static_cast<double>(pieces.size());
  double spread = 0;
  for (const Piece& piece : pieces) spread += (piece.centre - centre).squaredNorm();
  // The outline of a disc spreads by its radius squared.
  pole.radius = std::max(kLeastWidth, std::sqrt(spread / static_cast<double>(pieces.size())));
  pole.x = centre.x();
  pole.y = centre.y();
  pole.covariance = kSigma * kSigma * Eigen::Matrix2d::Identity();
  return pole;
}

}  // namespace

void LabelMapOptions::validate() const {
  const auto positive = [](const char* field, double value) {
    if (!(std::isfinite(value) && value > 0)) refuseLabelOption(field, value, "above 0 m");
  };
  if (stems.empty() && signs.empty()) throw Error("no class of labels is given; poles are 80");
  if (!(cell >= 0.01 && cell <= 1)) refuseLabelOption("cell", cell, "in [0.01, 1] m");
  positive("link", link);
  positive("max_width", maxWidth);
  positive("max_range", maxRange);
  if (!(std::isfinite(minHeight) && minHeight >= 0))
    refuseLabelOption("min_height", minHeight, "at least 0 m");
  if (minScans < 1) refuseLabelOption("min_scans", minScans, "at least 1");
  if (minPoints < 1) refuseLabelOption("min_points", minPoints, "at least 1");
}

LabelMapBuilder::LabelMapBuilder(const LabelMapOptions& options) : m_options(options) {
  m_options.validate();
}

void LabelMapBuilder::put(const Eigen::Vector3d& point, bool sign) {
  const auto ix = static_cast<std::int64_t>(std::floor(point.x() / m_options.cell));
  const auto iy = static_cast<std::int64_t>(std::floor(point.y() / m_options.cell));
  Column& column = m_columns[packed(ix, iy, sign)];
  const auto z = static_cast<float>(point.z());
  column.lowest = column.points == 0 ? z : std::min(column.lowest, z);
  column.highest = column.points == 0 ? z : std::max(column.highest, z);
  column.x += point.x();
  column.y += point.y();
  ++column.points;
  const auto scan = static_cast<std::uint32_t>(m_scans) + 1;  // 0: none yet
  column.scans += column.lastScan != scan;
  column.lastScan = scan;
  ++m_points;
}

void LabelMapBuilder::add(const Eigen::Isometry3d& T_map_lidar, const PointsView& points,
                          const std::vector<std::uint32_t>& labels) {
  const std::string where = "scan " + std::to_string(m_scans) + ": ";
  if (!(T_map_lidar.matrix().allFinite() && T_map_lidar.translation().norm() < kFarthest))
    throw Error(where + "its pose is not finite, or farther than 100 km from the origin");
  if (labels.size() != points.size)
    throw Error(where + std::to_string(labels.size()) + " labels for " +
                std::to_string(points.size) + " points");
  for (std::size_t i = 0; i < points.size; ++i) {
    const bool sign = isOneOf(m_options.signs, labels[i]);
    if (!sign && !isOneOf(m_options.stems, labels[i])) continue;
    const Eigen::Vector3d point(points.x[i], points.y[i], points.z[i]);
    if (point.norm() <= m_options.maxRange) put(T_map_lidar * point, sign);
  }
  ++m_scans;
}

std::vector<MapPole> LabelMapBuilder::poles() const {
  std::vector<std::uint64_t> keys;  // sorted, as the order of a hash table is anybody's
  for (const auto& [key, column] : m_columns) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  std::vector<Piece> pieces;
  for (const std::uint64_t key : keys) {
    const Column& c = m_columns.at(key);
    pieces.push_back({Eigen::Vector2d(c.x, c.y) / c.points, c.lowest, c.highest, c.points, c.scans,
                      (key & 1) != 0});
  }
  const auto thing = linked(pieces, m_options.link);
  std::vector<std::vector<Piece>> things(
      thing.empty() ? 0 : *std::max_element(thing.begin(), thing.end()) + 1);
  for (std::size_t i = 0; i < pieces.size(); ++i) things[thing[i]].push_back(pieces[i]);

  std::vector<MapPole> poles;
  for (std::vector<Piece>& rest : things) {
    const bool hung = hasStem(rest);
    while (!rest.empty() && (!hung || hasStem(rest))) {
      const std::vector<Piece> taken = takePole(rest, m_options.maxWidth);
      const std::size_t count =
          std::accumulate(taken.begin(), taken.end(), std::size_t{0},
                          [](std::size_t sum, const Piece& piece) { return sum + piece.points; });
      const MapPole pole = poleOf(taken);
      if (count >= static_cast<std::size_t>(m_options.minPoints) &&
          pole.count >= static_cast<std::uint32_t>(m_options.minScans) &&
          pole.top >= m_options.minHeight)
        poles.push_back(pole);
    }
  }
  std::sort(poles.begin(), poles.end(), [](const MapPole& a, const MapPole& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  });
  return poles;
}

}  // namespace polemcl
