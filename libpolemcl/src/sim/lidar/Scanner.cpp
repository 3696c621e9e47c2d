#include "sim/lidar/Scanner.h"

#include <algorithm>
#include <cmath>

#include "sim/common/Random.h"

namespace polemcl::sim {

Scanner::Scanner(const World& world, const LidarModel& lidar) : m_world(world), m_lidar(lidar) {
  for (const Beam& beam : m_lidar.beams) {
    m_beams.emplace_back(beam, m_lidar.divergence);
    m_lowestRise = std::min(m_lowestRise, beam.rise);
    m_highestRise = std::max(m_highestRise, beam.rise);
  }
}

double Scanner::azimuthStep() const {
  return (m_lidar.clockwise ? -2 : 2) * M_PI / m_lidar.columns;
}

std::vector<ColumnView> Scanner::columnViews(const Motion& motion) const {
  std::vector<ColumnView> columns(m_lidar.columns);
  for (int i = 0; i < m_lidar.columns; ++i) {
    const double time = m_lidar.period * ((i + 0.5) / m_lidar.columns - 0.5);
    const double azimuth = m_lidar.startAzimuth + azimuthStep() * i;
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

void Scanner::castGround(const Eigen::Isometry3d& T_map_sensor,
                         const std::vector<ColumnView>& columns, std::vector<SubHit>& hits) const {
  const Eigen::Matrix3d turn = T_map_sensor.linear();
  const Eigen::Vector3f up = turn.transpose().col(2).cast<float>();
  for (std::size_t b = 0; b < m_beams.size(); ++b)
    for (int c = 0; c < m_lidar.columns; ++c) {
      const Eigen::Vector3f direction = m_beams[b].direction(0, columns[c]);
      const Eigen::Vector3f start = columns[c].origin + m_beams[b].start;
      const auto ground = m_world.terrain().intersect(
          T_map_sensor * start.cast<double>(), turn * direction.cast<double>(), m_lidar.maxRange);
      if (!std::isfinite(ground.range)) continue;
      const float fall = -up.dot(direction);
      for (int s = 0; s < kSubRays; ++s) {
        // The other sub-rays hit the same level ground a little nearer or farther.
        const float subFall = -up.dot(m_beams[b].direction(s, columns[c]));
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

std::vector<SolidView> Scanner::solidsAround(const Eigen::Isometry3d& T_map_sensor) const {
  const Eigen::Isometry3d T_sensor_map = T_map_sensor.inverse();
  const Eigen::Vector3d centre = T_map_sensor.translation();
  std::vector<SolidView> solids;
  for (const std::uint32_t i : m_world.objectsWithin(centre.x(), centre.y(), m_lidar.maxRange)) {
    const WorldObject& object = m_world.objects()[i];
    for (std::size_t k = 0; k < object.solids.size(); ++k)
      solids.emplace_back(object.solids[k], T_sensor_map,
                          hash(m_world.options().seed, m_world.options().day, object.id, k));
  }
  return solids;
}

void Scanner::castSolid(const SolidView& solid, std::int32_t index,
                        const std::vector<ColumnView>& columns, const SolidBounds& bounds,
                        std::uint64_t seed, std::vector<SubHit>& hits) const {
  const double step = azimuthStep();
  for (std::size_t b = 0; b < m_beams.size(); ++b) {
    if (m_beams[b].lowTangent > bounds.highTangent || m_beams[b].highTangent < bounds.lowTangent)
      continue;
    const double slack = m_beams[b].halfAngle + std::abs(step);
    const double from =
        (bounds.azimuth - bounds.halfAzimuth - slack - m_beams[b].azimuth - m_lidar.startAzimuth) /
        step;
    const double to =
        (bounds.azimuth + bounds.halfAzimuth + slack - m_beams[b].azimuth - m_lidar.startAzimuth) /
        step;
    int first = static_cast<int>(std::floor(std::min(from, to)));
    const int count =
        std::min(static_cast<int>(std::ceil(std::max(from, to))) - first + 1, m_lidar.columns);
    first = ((first % m_lidar.columns) + m_lidar.columns) % m_lidar.columns;
    for (int i = 0; i < count; ++i) {
      const int c = first + i < m_lidar.columns ? first + i : first + i - m_lidar.columns;
      SubHit* const cell = &hits[pixel(b, c) * kSubRays];
      const Eigen::Vector3f origin =
          solid.toLocal * (columns[c].origin + m_beams[b].start) + solid.offset;
      for (int s = 0; s < kSubRays; ++s) {
        if (bounds.nearest >= cell[s].range) continue;
        const std::uint64_t draw =
            seed ^ ((pixel(b, c) * kSubRays + s) << 32 | static_cast<std::uint32_t>(index));
        const ShapeHit hit =
            solid.intersect({origin, solid.toLocal * m_beams[b].direction(s, columns[c])}, draw);
        if (hit.range >= cell[s].range) continue;
        cell[s] = {hit.range, hit.cosine, index};
      }
    }
  }
}

SimulatedScan Scanner::scan(const Eigen::Isometry3d& T_map_sensor, std::uint64_t seed,
                            const Motion& motion) const {
  const auto columns = columnViews(motion);
  std::vector<SubHit> hits(m_beams.size() * m_lidar.columns * kSubRays,
                           SubHit{static_cast<float>(m_lidar.maxRange), 1, SubHit::kNothing});
  castGround(T_map_sensor, columns, hits);

  const auto solids = solidsAround(T_map_sensor);
  BoundsMargin margin;
  margin.translation = 0.5 * m_lidar.period * motion.velocity.norm();
  margin.azimuth = 0.5 * m_lidar.period * std::abs(motion.yawRate);
  margin.lowestRise = m_lowestRise;
  margin.highestRise = m_highestRise;
  std::vector<SolidBounds> bounds;
  std::vector<std::int32_t> order;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    bounds.push_back(solids[i].bounds(margin));
    if (bounds[i].nearest < m_lidar.maxRange) order.push_back(static_cast<std::int32_t>(i));
  }
  // Front to back, so that hidden solids are rejected early.
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return bounds[a].nearest != bounds[b].nearest ? bounds[a].nearest < bounds[b].nearest : a < b;
  });
  const std::uint64_t passSeed = hash(seed, 0xbeull);
  for (const std::int32_t i : order) castSolid(solids[i], i, columns, bounds[i], passSeed, hits);

  SimulatedScan scan;
  const PulseReturnModel returns(m_lidar, solids, m_world.options().realism);
  for (int c = 0; c < m_lidar.columns; ++c)
    for (std::size_t b = 0; b < m_beams.size(); ++b) {
      const std::size_t at = pixel(b, c);
      const Beam& beam = m_lidar.beams[b];
      const double azimuth = m_lidar.startAzimuth + azimuthStep() * c + beam.azimuth;
      const auto pulse = returns.make(&hits[at * kSubRays], beam, azimuth, hash(seed, at));
      if (!pulse) continue;
      const Eigen::Vector3d point = m_beams[b].reported(columns[c], pulse->range);
      scan.x.push_back(static_cast<float>(point.x()));
      scan.y.push_back(static_cast<float>(point.y()));
      scan.z.push_back(static_cast<float>(point.z()));
      scan.intensity.push_back(pulse->intensity);
      scan.label.push_back(pulse->label);
    }
  return scan;
}

}  // namespace polemcl::sim
