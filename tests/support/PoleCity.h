#pragma once
// A city of poles, its imperfect map, and drives through it with simulated detections.
// Deterministic by seed. For tests and benchmarks.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/common/Random.h"

namespace polemcl::tests {

using Way = std::vector<Eigen::Vector2d>;

struct CityOptions {
  std::uint64_t seed = 1;
  int streets = 9;           ///< in each direction
  double block = 120;        ///< mean distance between parallel streets, m
  double density = 1;        ///< factor on the density of lamps and other objects
  bool regular = false;      ///< one lamp spacing everywhere, no trees, signs or clutter
  double regularJitter = 0;  ///< jitter of the lamps of a regular city, along an axis, m
  double missing = 0.1;      ///< share of standing poles that are not on the map
  double vanished = 0.05;    ///< share of map poles that no longer stand
  double mapNoise = 0.03;    ///< noise of a map pole, along an axis, m
  double radiusSpread = 0;   ///< radii lie between 0.1 m and 0.1 m more than this
};

/// \brief A polyline sampled every `step` metres.
inline Way resample(const Way& way, double step) {
  Way out{way.front()};
  double left = step;
  for (std::size_t i = 1; i < way.size(); ++i) {
    Eigen::Vector2d from = way[i - 1];
    double length = (way[i] - from).norm();
    while (length >= left) {
      from += (way[i] - from) / length * left;
      out.push_back(from);
      length -= left;
      left = step;
    }
    left -= length;
  }
  return out;
}

/// \brief Corners rounded as driven by a car; a point every metre.
inline Way drivable(const Way& way) {
  const Way fine = resample(way, 0.5);
  const int reach = 12;
  Way smooth;
  for (int i = 0; i < static_cast<int>(fine.size()); ++i) {
    const int r = std::min({reach, i, static_cast<int>(fine.size()) - 1 - i});
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int k = i - r; k <= i + r; ++k) sum += fine[k];
    smooth.push_back(sum / (2 * r + 1));
  }
  return resample(smooth, 1);
}

/// \brief Objects around the drive.
struct Surroundings {
  std::vector<Eigen::Vector2d> poles;    ///< map frame, m
  std::vector<Eigen::Vector2d> clutter;  ///< detected as poles, not on any map
  double radiusSpread = 0;               ///< CityOptions::radiusSpread, m
};

/// \brief Radius of the pole at this place, m: no two are alike, nor is there a pattern.
inline double radiusAt(const Eigen::Vector2d& place, double spread) {
  const auto bits = [](double value) {
    return static_cast<std::uint64_t>(std::llround(value * 100));
  };
  sim::Random random(bits(place.x()) * 1000003 + bits(place.y()));
  return 0.1 + spread * random.uniform();
}

class PoleCity {
 public:
  /// \brief Streets on an irregular grid.
  explicit PoleCity(const CityOptions& options) : m_options(options), m_random(options.seed) {
    for (int axis = 0; axis < 2; ++axis) {
      double at = 0;
      for (int i = 0; i < options.streets; ++i) {
        m_lines[axis].push_back(at);
        at += options.regular ? options.block : options.block * m_random.uniform(0.6, 1.4);
      }
    }
    for (int axis = 0; axis < 2; ++axis)
      for (double line : m_lines[axis]) furnish(street(axis, line));
    makeMap();
  }
  /// \brief Poles along a given road.
  PoleCity(const CityOptions& options, const Way& road)
      : m_options(options), m_random(options.seed) {
    furnish(resample(road, 1));
    makeMap();
  }

  /// \brief Given poles, such as those of a real city.
  static PoleCity ofPoles(const CityOptions& options, std::vector<Eigen::Vector2d> poles) {
    PoleCity city(options, Way{Eigen::Vector2d::Zero()});  // a road without anything beside it
    city.m_things.poles = std::move(poles);
    city.makeMap();
    return city;
  }

  const Surroundings& surroundings() const { return m_things; }
  const std::vector<MapPole>& map() const { return m_map; }

  /// \brief A path of `length` metres from a random place, turning at some crossings.
  Way randomWay(sim::Random& random, double length) const {
    const int last = m_options.streets - 1;
    int at[2] = {random.below(last + 1), random.below(last + 1)};
    int axis = random.below(2), step = random.chance(0.5) ? 1 : -1;
    Way corners{crossing(at)};
    double sum = 0;
    const double lead = random.uniform(0, 60);  // starts between two crossings
    while (sum < length + lead + 20) {
      if (at[axis] + step < 0 || at[axis] + step > last) step = -step;
      at[axis] += step;
      corners.push_back(crossing(at));
      sum += (corners.back() - corners[corners.size() - 2]).norm();
      if (!random.chance(0.4)) continue;
      axis = 1 - axis;
      step = random.chance(0.5) ? 1 : -1;
      if (at[axis] + step < 0 || at[axis] + step > last) step = -step;
    }
    const Way way = drivable(corners);
    const auto first = static_cast<std::ptrdiff_t>(lead);
    const auto count = static_cast<std::ptrdiff_t>(length) + 1;
    return Way(way.begin() + first, way.begin() + first + count);
  }

 private:
  Eigen::Vector2d crossing(const int at[2]) const { return {m_lines[0][at[0]], m_lines[1][at[1]]}; }

  Way street(int axis, double line) const {
    const double end = m_lines[1 - axis].back();
    const Eigen::Vector2d from = axis == 0 ? Eigen::Vector2d(line, 0) : Eigen::Vector2d(0, line);
    const Eigen::Vector2d to = axis == 0 ? Eigen::Vector2d(line, end) : Eigen::Vector2d(end, line);
    return resample({from, to}, 1);
  }

  /// Lamps on both sides, rows of trees, signs, and clutter that looks like poles.
  void furnish(const Way& road) {
    const bool regular = m_options.regular;
    for (double side : {1.0, -1.0}) {
      double spacing = 25, beside = 6, along = 0;
      for (double until = 0; along < static_cast<double>(road.size()) - 2;) {
        if (along >= until) {  // another stretch, another style
          until = along + m_random.uniform(80, 300);
          spacing = m_random.uniform(15, 40);
          beside = m_random.uniform(4.5, 9);
        }
        if (regular) spacing = 25, beside = 6;
        put(m_things.poles, road, along, side * beside, regular ? m_options.regularJitter : 0.4);
        if (!regular && m_random.chance(0.12)) {  // a row of trees
          const int trees = 3 + m_random.below(6);
          const double step = m_random.uniform(5, 9);
          for (int k = 1; k <= trees; ++k)
            put(m_things.poles, road, along + k * step, side * (beside + m_random.uniform(1, 4)),
                0.3);
        }
        if (!regular && m_random.chance(0.25)) {
          const double out = side * m_random.uniform(4, 6);
          put(m_things.poles, road, along + m_random.uniform(3, 12), out, 0.5);
        }
        if (!regular && m_random.chance(0.3)) {
          const double out = side * m_random.uniform(5, 14);
          put(m_things.clutter, road, along + m_random.uniform(0, 20), out, 0.5);
        }
        along += regular
                     ? spacing
                     : std::max(10.0, m_random.normal(spacing, 0.06 * spacing)) / m_options.density;
      }
    }
  }

  void put(std::vector<Eigen::Vector2d>& list, const Way& road, double along, double beside,
           double jitter) {
    const auto i = static_cast<std::size_t>(along);
    if (i + 1 >= road.size()) return;
    const Eigen::Vector2d ahead = (road[i + 1] - road[i]).normalized();
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const double farther = along - static_cast<double>(i) + jitter * m_random.normal();
    const double aside = beside + jitter * m_random.normal();
    const Eigen::Vector2d place = road[i] + farther * ahead + aside * left;
    const auto near = [&](const Eigen::Vector2d& p) { return (p - place).squaredNorm() < 4; };
    if (std::none_of(list.begin(), list.end(), near)) list.push_back(place);
  }

  void makeMap() {
    m_things.radiusSpread = m_options.radiusSpread;
    std::vector<Eigen::Vector2d> standing;
    for (const Eigen::Vector2d& pole : m_things.poles) {
      if (!m_random.chance(m_options.vanished)) standing.push_back(pole);
      if (m_random.chance(m_options.missing)) continue;
      MapPole mapped;
      mapped.x = pole.x() + m_random.normal(0, m_options.mapNoise);
      mapped.y = pole.y() + m_random.normal(0, m_options.mapNoise);
      mapped.radius = radiusAt(pole, m_options.radiusSpread);
      mapped.covariance = m_options.mapNoise * m_options.mapNoise * Eigen::Matrix2d::Identity();
      m_map.push_back(mapped);
    }
    m_things.poles = standing;
  }

  CityOptions m_options;
  sim::Random m_random;
  std::vector<double> m_lines[2];
  Surroundings m_things;
  std::vector<MapPole> m_map;
};

struct DriveOptions {
  double range = 40;            ///< of the detections, m
  double nearChance = 0.9;      ///< probability of detecting a pole beside the robot
  double farChance = 0.3;       ///< at the end of the range
  double falsePerFrame = 1.5;   ///< false detections that do not repeat in other frames
  double odometryNoise = 0.02;  ///< σ of each component of a step, relative to it
  double scaleError = 0;        ///< of the odometry, common to all steps
  double radiusNoise = 0.02;    ///< of a detection, where radii differ, m
};

/// \brief One frame of a drive.
struct Frame {
  Pose2D truth;   ///< robot in the map
  Pose2D motion;  ///< odometry since the previous frame; zero in the first
  std::vector<PoleDetection> poles_robot;
};

inline Pose2D poseOn(const Way& way, std::size_t i) {
  const std::size_t from = std::min(i, way.size() - 2);
  const Eigen::Vector2d ahead = way[from + 1] - way[from];
  return {way[i].x(), way[i].y(), std::atan2(ahead.y(), ahead.x())};
}

inline void detect(const std::vector<Eigen::Vector2d>& things, double radiusSpread,
                   const Pose2D& truth, const DriveOptions& options, sim::Random& random,
                   std::vector<PoleDetection>& out) {
  for (const Eigen::Vector2d& thing : things) {
    const double range = std::hypot(thing.x() - truth.x, thing.y() - truth.y);
    if (range > options.range) continue;
    const double chance =
        options.nearChance + (options.farChance - options.nearChance) * range / options.range;
    if (!random.chance(chance)) continue;
    const Pose2D seen = relative(truth, {thing.x(), thing.y(), 0});
    const double sigma = 0.03 + 0.02 * range / options.range;
    PoleDetection detection;
    detection.x = seen.x + random.normal(0, sigma);
    detection.y = seen.y + random.normal(0, sigma);
    detection.radius = radiusAt(thing, radiusSpread);
    if (radiusSpread > 0) detection.radius += random.normal(0, options.radiusNoise);
    detection.covariance = sigma * sigma * Eigen::Matrix2d::Identity();
    out.push_back(detection);
  }
}

/// \brief Adds false detections that do not repeat in other frames.
inline void addFalse(const DriveOptions& options, sim::Random& random,
                     std::vector<PoleDetection>& out) {
  for (double left = options.falsePerFrame; random.chance(std::min(1.0, left)); left -= 1) {
    const double range = options.range * std::sqrt(random.uniform());
    const double bearing = random.uniform(-M_PI, M_PI);
    PoleDetection detection;
    detection.x = range * std::cos(bearing);
    detection.y = range * std::sin(bearing);
    detection.radius = 0.1;
    detection.covariance *= 0.2;
    out.push_back(detection);
  }
}

/// \brief One frame per metre of the path.
inline std::vector<Frame> drive(const Surroundings& things, const Way& way,
                                const DriveOptions& options, sim::Random& random) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < way.size(); ++i) {
    Frame frame;
    frame.truth = poseOn(way, i);
    if (i > 0) {
      const Pose2D step = relative(frames.back().truth, frame.truth);
      const auto noisy = [&](double value) {
        return value * (1 + options.scaleError) + random.normal() * options.odometryNoise * value;
      };
      frame.motion = {noisy(step.x), noisy(step.y),
                      step.yaw + random.normal() * options.odometryNoise * step.yaw};
    }
    detect(things.poles, things.radiusSpread, frame.truth, options, random, frame.poles_robot);
    detect(things.clutter, things.radiusSpread, frame.truth, options, random, frame.poles_robot);
    addFalse(options, random, frame.poles_robot);
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace polemcl::tests
