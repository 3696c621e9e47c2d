#include "sim/world/Detour.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/common/Random.h"

namespace polemcl::sim {
namespace {
using V2 = Eigen::Vector2d;
constexpr double kBend = 9;     // radius of the bends, m
constexpr double kMouth = 17;   // nothing is placed this near to the main street, m
constexpr double kLeast = 400;  // main street, m: room for two detours and houses

V2 pointOf(const Pose2D& pose) {
  return {pose.x, pose.y};
}

/// \brief A line through corners, each rounded by an arc with a point about every 0.4 m.
std::vector<V2> rounded(const std::vector<V2>& corners) {
  std::vector<V2> points{corners.front()};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const V2 in = (corners[i] - corners[i - 1]).normalized(),
             out = (corners[i + 1] - corners[i]).normalized();
    const double turn = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    const double cut = kBend * std::tan(std::abs(turn) / 2);
    const V2 start = corners[i] - cut * in, left(-in.y(), in.x());
    const double sign = turn > 0 ? 1 : -1;
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn) * kBend / 0.4)));
    for (int k = 0; k <= steps; ++k) {
      const double angle = std::abs(turn) * k / steps;
      points.push_back(start +
                       kBend * (std::sin(angle) * in + sign * (1 - std::cos(angle)) * left));
    }
  }
  points.push_back(corners.back());
  return points;
}

/// \brief Whether a detour keeps its distance from the main street, except at its mouths.
bool hasRoom(const Street& street, const std::vector<V2>& corners) {
  const V2 &a = corners[1], &b = corners[2], &c = corners[3], &e = corners[4];
  const auto clear = [&](const V2& from, const V2& to, double share) {
    for (int i = 4; i <= 20; ++i) {
      const V2 place = from + i / 20.0 * (to - from);
      const double needed = share > 0 ? share * (place - from).norm() : 38;
      if (street.distance(place.x(), place.y(), 60) < needed) return false;
    }
    return true;
  };
  return (c - b).norm() > 50 && (c - b).dot(e - a) > 0 && clear(a, b, 0.75) && clear(e, c, 0.75) &&
         clear(b, c, 0);
}

double alongOf(const Street& street, const V2& place) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < street.points().size(); ++i)
    if ((street.points()[i] - place).norm() < (street.points()[best] - place).norm()) best = i;
  return Street::step() * static_cast<double>(best);
}

Detour make(const Street& street, const std::vector<V2>& corners, double leave, double back,
            int side) {
  // At the exit, keep the heading of the street, so that the drive does not jerk.
  const auto round = rounded(corners);
  std::vector<V2> path, furnished;
  for (double s = 0; s < leave - kBend - 1; s += Street::step())
    path.push_back(pointOf(street.at(s)));
  for (const V2& point : round) path.push_back(point);
  for (double s = back + kBend + 1.5; s < street.length(); s += Street::step())
    path.push_back(pointOf(street.at(s)));
  const Street whole(path);
  const Street line(round);
  for (const V2& point : line.points())
    if (street.distance(point.x(), point.y(), 60) > kMouth) furnished.push_back(point);
  const Street own(furnished);
  const std::vector<double> bends{alongOf(own, corners[2]), alongOf(own, corners[3])};
  return {whole, own, bends, leave, back, side};
}

std::optional<Detour> tryOne(const Street& street, int index, int side, Random& random) {
  const double leave = street.length() * ((index == 0 ? 0.2 : 0.6) + random.uniform(0, 0.08));
  const double back = leave + random.uniform(70, 100), depth = random.uniform(55, 75);
  const auto aside = [&](double s) { return pointOf(street.at(s, side * depth)); };
  const std::vector<V2> corners{pointOf(street.at(leave - kBend - 1)),
                                pointOf(street.at(leave)),
                                aside(leave),
                                aside(back),
                                pointOf(street.at(back)),
                                pointOf(street.at(back + kBend + 1))};
  if (back + 30 > street.length() || !street.fresh(leave) || !street.fresh(back) ||
      !hasRoom(street, corners))
    return std::nullopt;
  return make(street, corners, leave, back, side);
}
}  // namespace

std::vector<Detour> planDetours(const WorldOptions& options, const Street& street) {
  std::vector<Detour> detours;
  if (options.sideStreets > 0 && street.length() < kLeast)
    throw Error("[world] side_streets: the street is " + std::to_string(street.length()) +
                " m long; at least 400 m are needed");
  for (int index = 0; index < options.sideStreets; ++index) {
    Random random(hash(options.seed, 0xde70ull, index));
    const int side = random.chance(0.5) ? 1 : -1;
    std::optional<Detour> found;
    for (int attempt = 0; attempt < 40 && !found; ++attempt)
      found = tryOne(street, index, attempt % 2 == 0 ? side : -side, random);
    if (!found)
      throw Error("[world] side_streets: there is no room beside this street for side street " +
                  std::to_string(index + 1) + "; take fewer, or another seed or track");
    detours.push_back(std::move(*found));
  }
  return detours;
}

}  // namespace polemcl::sim
