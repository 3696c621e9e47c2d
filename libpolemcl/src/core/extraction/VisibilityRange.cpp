#include "core/extraction/VisibilityRange.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl {
namespace {

/// m: beams that leave pole heights before are not worth their time; the others pass there, too.
constexpr float kSteep = 5;
constexpr std::size_t kEnoughBeams = 16;  ///< of more, every second, third … is looked at
constexpr int kFewestBeams = 2;           ///< fewer do not make a pole

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

VisibilityRangeFinder::VisibilityRangeFinder(const SensorModel& sensor, double sensorHeight,
                                             double maxRange) {
  if (sensor.lookup().planes) return;
  m_steps = static_cast<int>(maxRange / kStep) + 1;  // 0 to m_steps - 1
  chooseBeams(sensor, static_cast<float>(sensorHeight));
  std::vector<int> beams(m_steps);
  for (const Span& span : m_spans)
    for (int step = span.first; step <= span.last; ++step) ++beams[step];
  for (const int n : beams)
    m_mostBlocked.push_back(static_cast<std::int16_t>(std::min(n - kFewestBeams, n / 2)));
  // A lidar high up passes over all poles beside it.
  while (m_firstJudged < m_steps && beams[m_firstJudged] < kFewestBeams) ++m_firstJudged;
  m_change.resize(static_cast<std::size_t>(kSectors) * (m_steps + 1));
  for (int sector = 0; sector < kSectors; ++sector) {
    const double azimuth = (sector + 0.5) * 2 * M_PI / kSectors - M_PI;
    const int cell = GroundGrid::cell(static_cast<float>(std::cos(azimuth)),
                                      static_cast<float>(std::sin(azimuth)));
    m_groundSector[sector] = static_cast<std::uint16_t>(cell / GroundGrid::kRings);
  }
}

void VisibilityRangeFinder::chooseBeams(const SensorModel& sensor, float sensorHeight) {
  std::vector<Span> all;
  for (int row = 0; row < sensor.beamCount(); ++row) {
    Span span{row, m_steps, -1};
    for (int step = 0; step < m_steps; ++step) {
      const float range = kStep * static_cast<float>(step);
      const float height = sensor.heightOver(row, range, 0, range) + sensorHeight;
      if (height < kLowest || height > kHighest) continue;
      span.first = std::min(span.first, step);
      span.last = step;
    }
    if (kStep * static_cast<float>(span.last) >= kSteep) all.push_back(span);
  }
  const std::size_t stride = std::max<std::size_t>(1, all.size() / kEnoughBeams);
  for (std::size_t i = 0; i < all.size(); i += stride) m_spans.push_back(all[i]);
}

/// Counts the blocked steps of one beam in all sectors: it sees nothing beyond what it met.
void VisibilityRangeFinder::countBlocked(const ScanLines& lines, const Span& span) {
  const float farthest = kStep * static_cast<float>(span.last);
  float nearest[kSectors];
  std::fill(nearest, nearest + kSectors, std::numeric_limits<float>::infinity());
  for (const Return* r = lines.begin(span.row); r < lines.end(span.row); ++r) {
    float& least = nearest[ScanLines::part(r->azimuth, kSectors)];
    least = std::min(least, r->rho);
  }
  for (int sector = 0; sector < kSectors; ++sector) {
    if (!(nearest[sector] < farthest)) continue;
    const int from = std::max(span.first, static_cast<int>(nearest[sector] / kStep) + 1);
    ++m_change[static_cast<std::size_t>(from) * kSectors + sector];
    --m_change[static_cast<std::size_t>(span.last + 1) * kSectors + sector];
  }
}

/// Steps that are free, from the nearest on, in all sectors at once.
void VisibilityRangeFinder::countFree(std::int16_t* reached) const {
  std::int16_t blocked[kSectors] = {}, open[kSectors];
  std::fill(open, open + kSectors, std::int16_t{1});
  std::fill(reached, reached + kSectors, std::int16_t{0});
  const std::int16_t* change = m_change.data();
  for (int step = 0; step < m_steps; ++step, change += kSectors) {
    const std::int16_t most =
        step < m_firstJudged ? std::numeric_limits<std::int16_t>::max() : m_mostBlocked[step];
    for (int sector = 0; sector < kSectors; ++sector) {
      blocked[sector] = static_cast<std::int16_t>(blocked[sector] + change[sector]);
      open[sector] = static_cast<std::int16_t>(open[sector] & (blocked[sector] <= most));
      reached[sector] = static_cast<std::int16_t>(reached[sector] + open[sector]);
    }
  }
}

void VisibilityRangeFinder::find(const ScanLines& lines, const GroundGrid& ground,
                                 std::vector<float>& visibilityRange) {
  visibilityRange.clear();
  if (m_steps == 0) return;
  std::fill(m_change.begin(), m_change.end(), std::int16_t{0});
  for (const Span& span : m_spans) countBlocked(lines, span);
  std::int16_t reached[kSectors];
  countFree(reached);
  bool known[GroundGrid::kSectors] = {};
  for (int cell = 0; cell < GroundGrid::kCells; ++cell)
    known[cell / GroundGrid::kRings] |= ground.hasPoints(cell);
  visibilityRange.resize(kSectors);
  for (int sector = 0; sector < kSectors; ++sector) {
    const bool some = known[m_groundSector[sector]] && reached[sector] > m_firstJudged;
    visibilityRange[sector] = some ? kStep * static_cast<float>(reached[sector] - 1) : 0.f;
  }
}

}  // namespace polemcl
