#include "sim/world/Street.h"

#include <algorithm>
#include <cmath>

#include "io/data/Trajectory.h"
#include "sim/common/Random.h"

namespace polemcl::sim {
namespace {
constexpr double kCell = 16;  // m

/// \brief Two overlaid bends of different length: radii above about 150 m, never turning back.
std::vector<Eigen::Vector2d> generate(const WorldOptions& options) {
  Random random(hash(options.seed, 0x57ull));
  const double wide = random.uniform(500, 900), narrow = random.uniform(220, 340);
  const double wideTurn = options.curviness * random.uniform(0.15, 0.35);
  const double narrowTurn = options.curviness * random.uniform(0.06, 0.14);
  const double widePhase = random.uniform(0, 2 * M_PI), narrowPhase = random.uniform(0, 2 * M_PI);
  const double start = random.uniform(-M_PI, M_PI);
  std::vector<Eigen::Vector2d> places{Eigen::Vector2d::Zero()};
  for (double s = 0; s < options.length; s += Street::step()) {
    const double heading = start + wideTurn * std::sin(2 * M_PI * s / wide + widePhase) +
                           narrowTurn * std::sin(2 * M_PI * s / narrow + narrowPhase);
    places.push_back(places.back() +
                     Street::step() * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
  }
  return places;
}

std::vector<Eigen::Vector2d> readTrack(const std::string& path) {
  std::vector<Eigen::Vector2d> places;
  for (const Eigen::Isometry3d& pose : io::readKittiPoses(path))
    places.emplace_back(pose.translation().head<2>());
  return places;
}
}  // namespace

Street Street::make(const WorldOptions& options) {
  return Street(options.track.empty() ? generate(options) : readTrack(options.track));
}

Street::Street(const std::vector<Eigen::Vector2d>& places) {
  std::vector<Eigen::Vector2d> apart;
  for (const auto& place : places)
    if (apart.empty() || (place - apart.back()).norm() >= 0.4) apart.push_back(place);
  if (apart.size() < 2) throw Error("a street needs at least two places 0.4 m apart");
  resample(apart);
  for (std::size_t i = 0; i < m_points.size(); ++i)
    m_cells[cellOf(m_points[i].x(), m_points[i].y())].push_back(static_cast<std::int32_t>(i));
  findFreshParts();
}

void Street::resample(const std::vector<Eigen::Vector2d>& places) {
  m_points.push_back(places.front());
  for (std::size_t i = 1; i < places.size(); ++i) {
    for (double left = (places[i] - m_points.back()).norm(); left >= step() - 1e-6; left -= step())
      m_points.push_back(m_points.back() + step() * (places[i] - m_points.back()).normalized());
  }
  if (m_points.size() < 2) throw Error("a street must be longer than half a metre");
  const int count = static_cast<int>(m_points.size());
  for (int i = 0; i < count; ++i) {  // chords over 3 m, so that a noisy track has no kinks
    const auto chord = m_points[std::min(i + 3, count - 1)] - m_points[std::max(i - 3, 0)];
    const double heading = std::atan2(chord.y(), chord.x());
    m_heading.push_back(
        m_heading.empty() ? heading : m_heading.back() + wrapAngle(heading - m_heading.back()));
  }
}

std::int64_t Street::cellOf(double x, double y) {
  const auto column = static_cast<std::int64_t>(std::floor(x / kCell));
  const auto row = static_cast<std::int64_t>(std::floor(y / kCell));
  return column * 0x100000000ll + row;
}

std::size_t Street::indexOf(double s) const {
  const double index = std::clamp(s / step(), 0.0, static_cast<double>(m_points.size() - 1));
  return static_cast<std::size_t>(index);
}

Pose2D Street::at(double s, double lateral) const {
  const std::size_t i = std::min(indexOf(s), m_points.size() - 2);
  const double share = std::clamp(s / step() - static_cast<double>(i), 0.0, 1.0);
  const Eigen::Vector2d point = m_points[i] + share * (m_points[i + 1] - m_points[i]);
  const double heading = m_heading[i] + share * (m_heading[i + 1] - m_heading[i]);
  return {point.x() - lateral * std::sin(heading), point.y() + lateral * std::cos(heading),
          wrapAngle(heading)};
}

double Street::distance(double x, double y, double limit) const {
  double best = limit * limit;
  const int reach = static_cast<int>(std::ceil(limit / kCell));
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy) {
      const auto cell = m_cells.find(cellOf(x + dx * kCell, y + dy * kCell));
      if (cell == m_cells.end()) continue;
      for (const std::int32_t i : cell->second)
        best = std::min(best, (m_points[i] - Eigen::Vector2d(x, y)).squaredNorm());
    }
  return std::sqrt(best);
}

void Street::findFreshParts() {
  m_fresh.assign(m_points.size(), 1);
  constexpr int kApart = 120;  // vertices: from 60 m on it is another visit
  for (std::size_t i = 0; i < m_points.size(); ++i) {
    for (int dx = -1; dx <= 1 && m_fresh[i]; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell =
            m_cells.find(cellOf(m_points[i].x() + dx * kCell, m_points[i].y() + dy * kCell));
        if (cell == m_cells.end()) continue;
        for (const std::int32_t j : cell->second)
          if (j + kApart < static_cast<int>(i) && (m_points[j] - m_points[i]).norm() < 14)
            m_fresh[i] = 0;
      }
  }
}

}  // namespace polemcl::sim
