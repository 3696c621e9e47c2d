#include "sim/detections/DetectionSampler.h"

#include <algorithm>
#include <cmath>

#include "core/common/Statistics.h"
#include "core/common/Transform.h"
#include "core/extraction/VisibilityRange.h"
#include "sim/common/Random.h"
#include "sim/world/Season.h"

namespace polemcl::sim {
namespace {

/// Number of events of a Poisson process (Knuth 1969), for means of a few.
int poisson(double mean, Random& random) {
  const double limit = std::exp(-mean);
  int count = 0;
  for (double product = random.uniform(); product > limit; product *= random.uniform()) ++count;
  return count;
}

/// Number of copies for a scale factor: its whole part, plus one more with the probability of the
/// rest.
int copies(double factor, Random& random) {
  const double whole = std::floor(factor);
  return static_cast<int>(whole) + random.chance(factor - whole);
}

/// Divides the street into pieces with their own streams, so that a longer street begins like a
/// shorter one.
void placeAlong(const Street& street, const DetectionModel& model, double perMetre,
                std::uint64_t stream, bool today, std::vector<ClutterObject>& objects) {
  constexpr double kPiece = 20;  // m
  for (double start = 0; start < street.length(); start += kPiece) {
    const std::uint64_t seed = hash(stream, static_cast<std::uint64_t>(start));
    Random random(seed);
    const int count = poisson(perMetre * kPiece, random);
    for (int i = 0; i < count; ++i) {
      const double s = start + random.uniform(0, kPiece);
      const double aside = valueAt(model.clutterLateral, random.normal());
      const Pose2D place = street.at(s, random.chance(0.5) ? aside : -aside);
      if (s > street.length() || !street.fresh(s)) continue;
      objects.push_back({hash(seed, i), place.x, place.y, today});
    }
  }
}

/// Places clutter at the fence of a building site, the same on all its days.
void placeAtSite(const BuildingSite& site, const DetectionModel& model, int copy,
                 std::vector<ClutterObject>& objects) {
  const std::uint64_t seed = hash(site.seed, 0xc1dull, copy);
  Random random(seed);
  const Eigen::Vector2d along = (site.kerb.back() - site.kerb.front()).normalized();
  const Eigen::Vector2d toRoad = site.side * Eigen::Vector2d(along.y(), -along.x());
  const int count = poisson(model.season.siteClutter * (site.to - site.from), random);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d out = random.uniform(0.03, 0.2) * toRoad;
    const Eigen::Vector2d place = site.kerb[random.below(static_cast<int>(site.kerb.size()))] + out;
    objects.push_back({hash(seed, i), place.x(), place.y(), false});
  }
}

}  // namespace

std::vector<ClutterObject> placeClutter(const DetectionModel& model, const World& world,
                                        double factor) {
  std::vector<ClutterObject> objects;
  const WorldOptions& options = world.options();
  for (int copy = 0; copy < factor; ++copy) {
    const double part = std::min(1.0, factor - copy);
    std::vector<ClutterObject> more;
    const auto place = [&](const Street& street, std::uint64_t seed) {
      placeAlong(street, model, model.clutterAlways, hash(seed, 0xc1aull, copy), false, more);
      placeAlong(street, model, model.clutterToday, hash(seed, 0xc1bull, copy, options.day), true,
                 more);
    };
    place(world.street(), options.seed);
    for (std::size_t k = 0; k < world.detours().size(); ++k)
      place(world.detours()[k].street, hash(options.seed, 0xc1eull, k));
    for (const BuildingSite& site : world.buildingSites()) placeAtSite(site, model, copy, more);
    for (const ClutterObject& object : more)
      if (Random(hash(object.id, 0xc1cull)).chance(part)) objects.push_back(object);
  }
  return objects;
}

/// One scan: pose, frames, and obstacles around it.
struct DetectionSampler::View {
  std::size_t scan;
  Eigen::Vector2d sensor;  ///< m, map frame
  double height;           ///< height of the sensor, map frame, m
  Eigen::Isometry3d T_cloud_map;
  Eigen::Vector2d lidar_cloud;  ///< optical centre in the cloud frame, m
  std::vector<const SightLines::Block*> blocks, fences;
};

DetectionSampler::DetectionSampler(DetectionModel model, const World& world,
                                   const SimulationOptions& options)
    : m_model(std::move(model)),
      m_options(options),
      m_sight(world),
      m_fences(world, Obstacle::mesh) {
  m_model.validate();
  constexpr double kHeights = 0.3;
  if (m_model.sensor != options.sensor)
    throw Error("the model is for a " + m_model.sensor + ", and [sensor] model is " +
                options.sensor + "; fit one for it (share/experiments/fit_detections.py)");
  if (std::abs(m_model.height - options.height) > kHeights)
    throw Error("the model is for a LiDAR " + std::to_string(m_model.height) +
                " m above ground, and [sensor] height_m is " + std::to_string(options.height) +
                "; fit one for that height (share/experiments/fit_detections.py)");
  addPoles(world);
  m_clutter = placeClutter(m_model, world, options.falseFactor);
  for (const ClutterObject& object : m_clutter)
    m_targets.push_back(
        targetOf(DetectionClass::clutter, object.x, object.y, 0, object.id, object.today));
}

void DetectionSampler::addPoles(const World& world) {
  const WorldOptions& options = world.options();
  const double bare =
      options.dayOfYear > 0 ? 1 - seasonOf(options.dayOfYear + options.day).foliage : 0;
  for (const TruePole& pole : world.poles()) {
    Target target =
        targetOf(classOf(pole.kind), pole.x, pole.y, pole.radius, pole.id, ofOneDay(pole.id));
    const auto c = static_cast<std::size_t>(target.kind);
    target.snow = world.snowAt(pole.x, pole.y);
    target.shift = m_model.season.snow[c] * target.snow / 0.5 + m_model.season.bare[c] * bare;
    m_targets.push_back(target);
  }
}

DetectionSampler::Target DetectionSampler::targetOf(DetectionClass kind, double x, double y,
                                                    double radius, std::uint64_t id,
                                                    bool todayOnly) const {
  const WorldOptions& world = m_options.world;
  const std::uint64_t own = hash(world.seed, id, static_cast<int>(kind), 0xde7ull);
  const std::uint64_t today = hash(own, 0x70da1ull, world.day);
  return {kind, {x, y}, radius, todayOnly ? hash(today) : own, today};
}

PoleDetection DetectionSampler::report(const Target& target, const View& view,
                                       const Eigen::Vector2d& place, std::uint64_t scanSeed) const {
  const Eigen::Vector2d toPlace = place - view.lidar_cloud;
  const double range = toPlace.norm();
  const auto value = [&](Reported r) {
    const std::uint64_t key = 1 + static_cast<std::uint64_t>(r);
    const double z = persistentNoise(
        m_model.noiseOf(r), {target.always + key * 16, target.today + key * 16, scanSeed + key},
        view.sensor.x(), view.sensor.y());
    return m_model.value(target.kind, r, range, z);
  };
  Eigen::Matrix2d ray;  // columns: along, across
  ray.col(0) = toPlace / std::max(range, 1e-6);
  ray.col(1) = Eigen::Vector2d(-ray(1, 0), ray(0, 0));
  const Eigen::Vector2d sigma(value(Reported::sigmaAlong), value(Reported::sigmaAcross));
  const auto scale = [&](Reported which, double reported) {
    return m_model.errorScale(target.kind, which, range, reported);
  };
  const Eigen::Vector2d error(
      scale(Reported::sigmaAlong, sigma.x()) * value(Reported::errorAlong),
      scale(Reported::sigmaAcross, sigma.y()) * value(Reported::errorAcross));
  const Eigen::Vector2d centre = place + ray * error;
  PoleDetection pole;
  pole.x = centre.x();
  pole.y = centre.y();
  pole.covariance = symmetrized<2>(ray * sigma.cwiseAbs2().asDiagonal() * ray.transpose());
  pole.confidence = std::clamp(value(Reported::confidence), 0.0, 1.0);
  pole.radius = std::max(0.01, target.radius + value(Reported::radius));
  pole.bottom = value(Reported::bottom);
  if (target.snow > 0) pole.bottom = std::max(pole.bottom, target.snow);
  pole.top = std::max(pole.bottom, value(Reported::top));
  pole.points = static_cast<std::uint32_t>(std::max(1.0, std::round(value(Reported::points))));
  return pole;
}

double DetectionSampler::threshold(const Target& target, const View& view) const {
  const double range = (target.place - view.sensor).norm();
  double score = m_model.detectionScore(target.kind, range) + target.shift;
  if (!view.fences.empty() && SightLines::blocked(view.fences, view.sensor, target.place))
    score += m_model.season.fence;
  const bool hidden = SightLines::blocked(view.blocks, view.sensor, target.place);
  return hidden ? std::min(normalQuantile(m_model.behindHouses), score) : score;
}

void DetectionSampler::addTarget(const Target& target, const View& view,
                                 std::vector<PoleDetection>& found) const {
  const double range = (target.place - view.sensor).norm();
  const bool isClutter = target.kind == DetectionClass::clutter;
  if (m_model.detectionScore(target.kind, range) < -5) return;
  const std::uint64_t scanSeed = driveSeed(m_options, hash(target.today, 0x5ca4ull, view.scan));
  const double z =
      persistentNoise(isClutter ? m_model.clutterVisibility : m_model.poleVisibility,
                      {target.always, target.today, scanSeed}, view.sensor.x(), view.sensor.y());
  if (z >= threshold(target, view)) return;
  // Position for a perfect extractor: vertical in the map, at the height of the LiDAR.
  const Eigen::Vector3d place =
      view.T_cloud_map * Eigen::Vector3d(target.place.x(), target.place.y(), view.height);
  found.push_back(report(target, view, place.head<2>(), scanSeed));
}

void DetectionSampler::addPassing(const View& view, std::vector<PoleDetection>& found) const {
  const WorldOptions& world = m_options.world;
  const std::uint64_t seed =
      driveSeed(m_options, hash(world.seed, 0x9a55ull, world.day, view.scan));
  Random random(seed);
  double passing = 0;
  for (int k = poisson(m_model.passing, random); k > 0; --k)
    passing += copies(m_options.falseFactor, random);
  for (int k = 0; k < passing; ++k) {
    const double range = valueAt(m_model.passingRange, random.normal());
    const double azimuth = random.uniform(-M_PI, M_PI);
    const std::uint64_t own = random.next();
    const Target target{DetectionClass::passing, {0, 0}, 0, own, own};
    const Eigen::Vector2d place =
        view.lidar_cloud + range * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth));
    found.push_back(report(target, view, place, own));
  }
}

std::vector<PoleDetection> DetectionSampler::sample(std::size_t i,
                                                    const Eigen::Isometry3d& T_map_sensor) const {
  const Eigen::Vector3d sensor = T_map_sensor.translation();
  View view{i,
            sensor.head<2>(),
            sensor.z(),
            cloudFrame(T_map_sensor, m_options).inverse(),
            Eigen::Vector2d(m_options.originX, m_options.originY),
            {},
            {}};
  view.blocks = m_sight.around(view.sensor, m_model.maxRange);
  view.fences = m_fences.around(view.sensor, m_model.maxRange);
  std::vector<PoleDetection> found;
  const double limit = m_model.maxRange * m_model.maxRange;
  for (const Target& target : m_targets)
    if ((target.place - view.sensor).squaredNorm() < limit) addTarget(target, view, found);
  addPassing(view, found);
  const auto polar = [](const PoleDetection& pole) {
    return std::make_pair(std::atan2(pole.y, pole.x), std::hypot(pole.x, pole.y));
  };
  std::sort(found.begin(), found.end(),
            [&](const PoleDetection& a, const PoleDetection& b) { return polar(a) < polar(b); });
  return found;
}

std::vector<float> DetectionSampler::visibilityRange(const Eigen::Isometry3d& T_map_sensor) const {
  constexpr int kSectors = VisibilityRangeFinder::kSectors;
  const Eigen::Vector2d sensor = T_map_sensor.translation().head<2>();
  const Eigen::Vector3d ahead = cloudFrame(T_map_sensor, m_options).linear().col(0);
  const double yaw = std::atan2(ahead.y(), ahead.x());
  const auto blocks = m_sight.around(sensor, m_model.maxRange);
  std::vector<float> border(kSectors);  // borders between the sectors, from -pi on
  for (int i = 0; i < kSectors; ++i) {
    const double azimuth = yaw - M_PI + i * 2 * M_PI / kSectors;
    const Eigen::Vector2d way(std::cos(azimuth), std::sin(azimuth));
    border[i] =
        static_cast<float>(SightLines::freeWay(blocks, sensor, sensor + m_model.maxRange * way));
  }
  std::vector<float> ranges(kSectors);
  for (int i = 0; i < kSectors; ++i) {
    const float least = std::min(border[i], border[(i + 1) % kSectors]);
    ranges[i] = VisibilityRangeFinder::kStep * std::floor(least / VisibilityRangeFinder::kStep);
  }
  return ranges;
}

}  // namespace polemcl::sim
