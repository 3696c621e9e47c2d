#include "sim/lidar/Scanner.h"

#include <algorithm>
#include <cmath>

#include "sim/common/Random.h"
#include "sim/lidar/PulseReturn.h"
#include "sim/lidar/SolidView.h"

namespace polemcl::sim {

/// Casting works object by object into a buffer of sub-rays, like a rasterizer. An object touches
/// only the beams and firing steps whose rays can hit it. Several sub-rays sample the width of one
/// pulse; their hits are merged into its return at the end.
struct Scanner::Impl {
  const World& world;
  LidarModel lidar;
  std::vector<BeamView> beams;
  double lowestRise = 0, highestRise = 0;

  Impl(const World& theWorld, const LidarModel& theLidar) : world(theWorld), lidar(theLidar) {
    for (const Beam& beam : lidar.beams) {
      beams.emplace_back(beam, lidar.divergence);
      lowestRise = std::min(lowestRise, beam.rise);
      highestRise = std::max(highestRise, beam.rise);
    }
  }

  double azimuthStep() const { return (lidar.clockwise ? -2 : 2) * M_PI / lidar.columns; }
  std::size_t pixel(std::size_t beam, int column) const { return beam * lidar.columns + column; }

  std::vector<ColumnView> columnViews(const Motion& motion) const;
  void castGround(const Eigen::Isometry3d& T_map_sensor, const std::vector<ColumnView>& columns,
                  std::vector<SubHit>& hits) const;
  std::vector<SolidView> solidsAround(const Eigen::Isometry3d& T_map_sensor, double time) const;
  void castSolid(const SolidView& solid, std::int32_t index, const std::vector<ColumnView>& columns,
                 const SolidBounds& bounds, std::uint64_t seed, std::vector<SubHit>& hits) const;
};

std::vector<ColumnView> Scanner::Impl::columnViews(const Motion& motion) const {
  std::vector<ColumnView> columns(lidar.columns);
  for (int i = 0; i < lidar.columns; ++i) {
    const double time = lidar.period * ((i + 0.5) / lidar.columns - 0.5);
    const double azimuth = lidar.startAzimuth + azimuthStep() * i;
    const double turned = azimuth + motion.yawRate * time;
    ColumnView& column = columns[i];
    column.origin = (motion.velocity * time).cast<float>();
    column.cosine = static_cast<float>(std::cos(turned));
    column.sine = static_cast<float>(std::sin(turned));
    column.reportedCosine = std::cos(azimuth);
    column.reportedSine = std::sin(azimuth);
  }
  return columns;
}

void Scanner::Impl::castGround(const Eigen::Isometry3d& T_map_sensor,
                               const std::vector<ColumnView>& columns,
                               std::vector<SubHit>& hits) const {
  const Eigen::Matrix3d turn = T_map_sensor.linear();
  const Eigen::Vector3f up = turn.transpose().col(2).cast<float>();
  for (std::size_t b = 0; b < beams.size(); ++b)
    for (int c = 0; c < lidar.columns; ++c) {
      const Eigen::Vector3f direction = beams[b].direction(0, columns[c]);
      const Eigen::Vector3f start = columns[c].origin + beams[b].start;
      const auto ground = world.terrain().intersect(
          T_map_sensor * start.cast<double>(), turn * direction.cast<double>(), lidar.maxRange);
      if (!std::isfinite(ground.range)) continue;
      const float fall = -up.dot(direction);
      for (int s = 0; s < kSubRays; ++s) {
        // The other sub-rays hit the same level ground a little nearer or farther.
        const float subFall = -up.dot(beams[b].direction(s, columns[c]));
        if (!ground.kerbFace && subFall < 0.003f && s > 0) continue;
        SubHit& hit = hits[pixel(b, c) * kSubRays + s];
        const float share = ground.kerbFace || s == 0 ? 1.0f : std::abs(fall) / subFall;
        hit.range = static_cast<float>(ground.range) * share;
        hit.cosine = ground.kerbFace ? 0.7f : std::max(std::abs(fall), 0.003f);
        hit.solid = ground.edge <= 0  ? SubHit::kRoad
                    : ground.edge < 3 ? SubHit::kPavement
                                      : SubHit::kGrass;
      }
    }
}

std::vector<SolidView> Scanner::Impl::solidsAround(const Eigen::Isometry3d& T_map_sensor,
                                                   double time) const {
  const Eigen::Isometry3d T_sensor_map = T_map_sensor.inverse();
  const Eigen::Vector3d centre = T_map_sensor.translation();
  std::vector<SolidView> solids;
  for (const std::uint32_t i : world.objectsWithin(centre.x(), centre.y(), lidar.maxRange)) {
    const WorldObject& object = world.objects()[i];
    const Eigen::Vector2d shift = object.displacement(time);
    for (std::size_t k = 0; k < object.solids.size(); ++k)
      solids.emplace_back(object.solids[k], Eigen::Vector3d(shift.x(), shift.y(), 0), T_sensor_map,
                          hash(world.options().seed, world.options().day, object.id, k));
  }
  return solids;
}

void Scanner::Impl::castSolid(const SolidView& solid, std::int32_t index,
                              const std::vector<ColumnView>& columns, const SolidBounds& bounds,
                              std::uint64_t seed, std::vector<SubHit>& hits) const {
  const double step = azimuthStep();
  for (std::size_t b = 0; b < beams.size(); ++b) {
    if (beams[b].lowTangent > bounds.highTangent || beams[b].highTangent < bounds.lowTangent)
      continue;
    const double slack = beams[b].halfAngle + std::abs(step);
    const double from =
        (bounds.azimuth - bounds.halfAzimuth - slack - beams[b].azimuth - lidar.startAzimuth) /
        step;
    const double to =
        (bounds.azimuth + bounds.halfAzimuth + slack - beams[b].azimuth - lidar.startAzimuth) /
        step;
    int first = static_cast<int>(std::floor(std::min(from, to)));
    const int count =
        std::min(static_cast<int>(std::ceil(std::max(from, to))) - first + 1, lidar.columns);
    first = ((first % lidar.columns) + lidar.columns) % lidar.columns;
    for (int i = 0; i < count; ++i) {
      const int c = first + i < lidar.columns ? first + i : first + i - lidar.columns;
      SubHit* const cell = &hits[pixel(b, c) * kSubRays];
      const Eigen::Vector3f origin =
          solid.toLocal * (columns[c].origin + beams[b].start) + solid.offset;
      for (int s = 0; s < kSubRays; ++s) {
        if (bounds.nearest >= cell[s].range) continue;
        const std::uint64_t draw =
            seed ^ ((pixel(b, c) * kSubRays + s) << 32 | static_cast<std::uint32_t>(index));
        const ShapeHit hit =
            solid.intersect({origin, solid.toLocal * beams[b].direction(s, columns[c])}, draw);
        if (hit.range >= cell[s].range) continue;
        cell[s] = {hit.range, hit.cosine, index};
      }
    }
  }
}

Scanner::Scanner(const World& world, const LidarModel& lidar)
    : m_impl(std::make_unique<Impl>(world, lidar)) {}
Scanner::~Scanner() = default;

SimulatedScan Scanner::scan(const Eigen::Isometry3d& T_map_sensor, std::uint64_t seed, double time,
                            const Motion& motion) const {
  const LidarModel& lidar = m_impl->lidar;
  const auto columns = m_impl->columnViews(motion);
  std::vector<SubHit> hits(m_impl->beams.size() * lidar.columns * kSubRays,
                           SubHit{static_cast<float>(lidar.maxRange), 1, SubHit::kNothing});
  m_impl->castGround(T_map_sensor, columns, hits);

  const auto solids = m_impl->solidsAround(T_map_sensor, time);
  BoundsMargin margin;
  margin.translation = 0.5 * lidar.period * motion.velocity.norm();
  margin.azimuth = 0.5 * lidar.period * std::abs(motion.yawRate);
  margin.lowestRise = m_impl->lowestRise;
  margin.highestRise = m_impl->highestRise;
  std::vector<SolidBounds> bounds;
  std::vector<std::int32_t> order;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    bounds.push_back(solids[i].bounds(margin));
    if (bounds[i].nearest < lidar.maxRange) order.push_back(static_cast<std::int32_t>(i));
  }
  // Front to back, so that hidden solids are rejected early.
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return bounds[a].nearest != bounds[b].nearest ? bounds[a].nearest < bounds[b].nearest : a < b;
  });
  const std::uint64_t passSeed = hash(seed, 0xbeull);
  for (const std::int32_t i : order)
    m_impl->castSolid(solids[i], i, columns, bounds[i], passSeed, hits);

  SimulatedScan scan;
  const PulseReturnModel echoes(lidar, solids);
  for (int c = 0; c < lidar.columns; ++c)
    for (std::size_t b = 0; b < m_impl->beams.size(); ++b) {
      const std::size_t pixel = m_impl->pixel(b, c);
      const auto echo = echoes.make(&hits[pixel * kSubRays], lidar.beams[b], hash(seed, pixel));
      if (!echo) continue;
      const Eigen::Vector3d point = m_impl->beams[b].reported(columns[c], echo->range);
      scan.x.push_back(static_cast<float>(point.x()));
      scan.y.push_back(static_cast<float>(point.y()));
      scan.z.push_back(static_cast<float>(point.z()));
      scan.intensity.push_back(echo->intensity);
      scan.label.push_back(echo->label);
    }
  return scan;
}

SimulatedScan scan(const World& world, const Eigen::Isometry3d& T_map_sensor,
                   const LidarModel& lidar, std::uint64_t seed) {
  return Scanner(world, lidar).scan(T_map_sensor, seed);
}

}  // namespace polemcl::sim
