#include "core/extraction/VisibilityRange.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// m: beams that leave pole heights before are not worth their time; the others pass there, too.
constexpr float kSteep = 5;
constexpr std::size_t kEnoughBeams = 16;  ///< of more, every second, third … is looked at
constexpr int kFewestBeams = 2;           ///< fewer do not make a pole

double middleOf(int sector) {
  return (sector + 0.5) * 2 * M_PI / VisibilityRangeFinder::kSectors - M_PI;
}

}  // namespace

std::size_t visibilityRangeSector(double azimuth, std::size_t sectors) {
  const double turns = (azimuth + M_PI) / (2 * M_PI);
  const double within = turns - std::floor(turns);
  return std::min(static_cast<std::size_t>(within * static_cast<double>(sectors)), sectors - 1);
}

double visibilityRangeTowards(const std::vector<float>& visibilityRange, double x, double y,
                              double halfWidth) {
  if (visibilityRange.empty()) return 0;
  const double range = std::hypot(x, y), bearing = std::atan2(y, x);
  const double half = range > halfWidth ? std::asin(halfWidth / range) : M_PI / 2;
  const std::size_t last = visibilityRangeSector(bearing + half, visibilityRange.size());
  std::size_t i = visibilityRangeSector(bearing - half, visibilityRange.size());
  float least = visibilityRange[i];
  while (i != last) {
    i = (i + 1) % visibilityRange.size();
    least = std::min(least, visibilityRange[i]);
  }
  return least;
}

bool isInView(const std::vector<float>& visibilityRange, const Pose2D& pose_map_sensor,
              const MapPole& pole) {
  constexpr double kBeside = 0.15;    // m beside a pole: objects there may hide it
  constexpr double kOwnFront = 0.75;  // m: it ends the range itself, in steps of 0.5 m; maps err
  const Pose2D seen = relative(pose_map_sensor, {pole.x, pole.y, 0});
  const double front = std::hypot(seen.x, seen.y) - pole.radius - kOwnFront;
  return visibilityRangeTowards(visibilityRange, seen.x, seen.y, pole.radius + kBeside) >=
         std::max(front, 1e-3);
}

VisibilityRangeFinder::VisibilityRangeFinder(const SensorModel& sensor, double sensorHeight,
                                             double maxRange)
    : m_sensor(sensor), m_sensorHeight(static_cast<float>(sensorHeight)) {
  if (sensor.lookup().planes) return;
  m_steps = static_cast<int>(maxRange / kStep) + 1;  // 0 to m_steps - 1
  m_mostBlocked.resize(static_cast<std::size_t>(kSectors) * m_steps);
  m_change.resize(static_cast<std::size_t>(kSectors) * (m_steps + 1));
  for (int sector = 0; sector < kSectors; ++sector) {
    const double azimuth = middleOf(sector);
    const int cell = GroundGrid::cell(static_cast<float>(std::cos(azimuth)),
                                      static_cast<float>(std::sin(azimuth)));
    m_groundSector[sector] = static_cast<std::uint16_t>(cell / GroundGrid::kRings);
  }
}

/// Notes how many beams pass at pole heights, and how many of these may be blocked.
void VisibilityRangeFinder::setUpright(const Eigen::Vector2f& upright) {
  m_upright = upright;
  chooseBeams();
  for (int sector = 0; sector < kSectors; ++sector) {
    std::vector<int> beams(m_steps);
    for (const Beam& beam : m_beams)
      for (int step = beam.span[sector].first; step <= beam.span[sector].last; ++step)
        ++beams[step];
    // A lidar high up passes over all poles beside it.
    int first = 0;
    while (first < m_steps && beams[first] < kFewestBeams) ++first;
    m_firstJudged[sector] = static_cast<std::int16_t>(first);
    for (int step = 0; step < m_steps; ++step)
      m_mostBlocked[static_cast<std::size_t>(step) * kSectors + sector] =
          step < first
              ? std::numeric_limits<std::int16_t>::max()
              : static_cast<std::int16_t>(std::min(beams[step] - kFewestBeams, beams[step] / 2));
  }
}

void VisibilityRangeFinder::chooseBeams() {
  std::vector<Beam> all;
  std::vector<float> heights(m_steps);
  float rise[kSectors];  // of a beam over the ground, because of the tilt, m per m
  for (int sector = 0; sector < kSectors; ++sector) {
    const double azimuth = middleOf(sector);
    rise[sector] = m_upright.x() * static_cast<float>(std::cos(azimuth)) +
                   m_upright.y() * static_cast<float>(std::sin(azimuth));
  }
  for (int row = 0; row < m_sensor.beamCount(); ++row) {
    for (int step = 0; step < m_steps; ++step) {
      const float range = kStep * static_cast<float>(step);
      heights[step] = m_sensor.heightOver(row, range, 0, range) + m_sensorHeight;
    }
    Beam beam{row, {}};
    int last = -1;
    for (int sector = 0; sector < kSectors; ++sector) {
      beam.span[sector] = spanAtPoleHeights(heights, rise[sector]);
      last = std::max<int>(last, beam.span[sector].last);
    }
    if (kStep * static_cast<float>(last) >= kSteep) all.push_back(beam);
  }
  const std::size_t stride = std::max<std::size_t>(1, all.size() / kEnoughBeams);
  m_beams.clear();
  for (std::size_t i = 0; i < all.size(); i += stride) m_beams.push_back(all[i]);
}

/// \param heights Of a beam above the ground under an upright lidar, by step, m. \param rise What
/// the tilt adds, m per m.
VisibilityRangeFinder::Span VisibilityRangeFinder::spanAtPoleHeights(
    const std::vector<float>& heights, float rise) const {
  Span span{static_cast<std::int16_t>(m_steps), -1};
  for (int step = 0; step < m_steps; ++step) {
    const float height = heights[step] + rise * kStep * static_cast<float>(step);
    if (height < kLowest || height > kHighest) continue;
    span.first = std::min(span.first, static_cast<std::int16_t>(step));
    span.last = static_cast<std::int16_t>(step);
  }
  return span;
}

/// Counts the blocked steps of one beam in all sectors: it sees nothing beyond what it met.
void VisibilityRangeFinder::countBlocked(const ScanLines& lines, const Beam& beam) {
  float nearest[kSectors];
  std::fill(nearest, nearest + kSectors, kStep * static_cast<float>(m_steps));
  for (const Return* r = lines.begin(beam.row); r < lines.end(beam.row); ++r) {
    float& least = nearest[ScanLines::part(r->azimuth, kSectors)];
    least = std::min(least, r->rho);
  }
  for (int sector = 0; sector < kSectors; ++sector) {
    const Span span = beam.span[sector];
    const int end = span.last + 1, beyond = static_cast<int>(nearest[sector] / kStep) + 1;
    const int from = std::min(std::max<int>(span.first, beyond), end);  // end: none is blocked
    ++m_change[static_cast<std::size_t>(from) * kSectors + sector];
    --m_change[static_cast<std::size_t>(end) * kSectors + sector];
  }
}

/// Steps that are free, from the nearest on, in all sectors at once.
void VisibilityRangeFinder::countFree(std::int16_t* reached) const {
  std::int16_t blocked[kSectors] = {}, open[kSectors];
  std::fill(open, open + kSectors, std::int16_t{1});
  std::fill(reached, reached + kSectors, std::int16_t{0});
  const std::int16_t *change = m_change.data(), *most = m_mostBlocked.data();
  for (int step = 0; step < m_steps; ++step, change += kSectors, most += kSectors) {
    for (int sector = 0; sector < kSectors; ++sector) {
      blocked[sector] = static_cast<std::int16_t>(blocked[sector] + change[sector]);
      open[sector] = static_cast<std::int16_t>(open[sector] & (blocked[sector] <= most[sector]));
      reached[sector] = static_cast<std::int16_t>(reached[sector] + open[sector]);
    }
  }
}

void VisibilityRangeFinder::find(const ScanLines& lines, const GroundGrid& ground,
                                 const Eigen::Vector2f& upright,
                                 std::vector<float>& visibilityRange) {
  visibilityRange.clear();
  if (m_steps == 0) return;
  if (upright != m_upright) setUpright(upright);
  std::fill(m_change.begin(), m_change.end(), std::int16_t{0});
  for (const Beam& beam : m_beams) countBlocked(lines, beam);
  std::int16_t reached[kSectors];
  countFree(reached);
  bool known[GroundGrid::kSectors] = {};
  for (int cell = 0; cell < GroundGrid::kCells; ++cell)
    known[cell / GroundGrid::kRings] |= ground.hasPoints(cell);
  visibilityRange.resize(kSectors);
  for (int sector = 0; sector < kSectors; ++sector) {
    const bool some = known[m_groundSector[sector]] && reached[sector] > m_firstJudged[sector];
    visibilityRange[sector] = some ? kStep * static_cast<float>(reached[sector] - 1) : 0.f;
  }
}

}  // namespace polemcl
