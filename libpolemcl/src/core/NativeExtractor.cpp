#include "NativeExtractor.h"

#include <algorithm>
#include <cmath>

namespace polemcl {

NativeExtractor::NativeExtractor(const SensorOptions& sensor, const NativeOptions& options)
    : m_sensorOptions(sensor),
      m_options(options),
      m_sensor(sensor),
      m_lines(m_sensor),
      m_stacker(m_sensor, options) {}

void NativeExtractor::extract(const PointsView& points, std::vector<PoleDetection>& poles,
                              ExtractionReport& report) {
  const auto& counts = m_lines.build(points, static_cast<float>(m_sensorOptions.minRange),
                                     static_cast<float>(m_sensorOptions.maxRange));
  report.points = points.size;
  report.invalid = counts.invalid;
  report.outOfView = counts.outOfView;
  report.outOfRange = counts.outOfRange;
  m_ground.build(m_lines, static_cast<float>(m_sensorOptions.height));
  report.ground = m_ground.median();
  findSlices(m_lines, m_sensor, m_options, m_slices);
  report.candidates = m_stacker.stack(m_slices);
  for (std::size_t i = 0; i < report.candidates; ++i) {
    PoleDetection pole;
    const Refusal refusal = examine(m_stacker.at(i), pole);
    if (refusal == Refusal::count_)
      poles.push_back(pole);
    else
      ++report.refused[static_cast<int>(refusal)];
  }
}

/// The slices of the bare trunk: those not much wider than the slimmer ones (a sign is wider).
void NativeExtractor::selectForFit(const Stack& stack) {
  m_widths.clear();
  for (auto i : stack.slices)
    m_widths.push_back(m_slices[i].rho * (m_slices[i].azimuthEnd - m_slices[i].azimuthBegin));
  std::vector<float>& sorted = m_widths;
  const std::size_t middle = (sorted.size() - 1) * 4 / 10;
  std::nth_element(sorted.begin(), sorted.begin() + middle, sorted.end());
  const float typical = sorted[middle];
  m_fitSlices.clear();
  for (auto i : stack.slices) {
    const Slice& slice = m_slices[i];
    const float width = slice.rho * (slice.azimuthEnd - slice.azimuthBegin);
    const float column = slice.rho * static_cast<float>(m_sensor.columnAngle());
    if (width <= 1.4f * typical + 1.5f * column) m_fitSlices.push_back(i);
  }
}

Refusal NativeExtractor::examine(const Stack& stack, PoleDetection& pole) {
  const Slice& highest = m_slices[stack.slices.front()];
  const Slice& lowest = m_slices[stack.slices.back()];
  std::uint32_t points = 0;
  for (auto i : stack.slices) points += m_slices[i].count;
  if (points < static_cast<std::uint32_t>(m_options.minPoints)) return Refusal::tooFewPoints;
  if (highest.z - lowest.z < m_options.minHeight) return Refusal::tooShort;

  selectForFit(stack);
  const auto fit =
      fitPole(m_lines, m_slices, m_fitSlices, static_cast<float>(m_sensor.columnAngle()));
  if (!fit || fit->radius < m_options.minRadius || fit->radius > m_options.maxRadius)
    return Refusal::badFit;

  const PoleEvidence e = gatherEvidence(m_lines, m_sensor, m_ground, m_slices, stack, *fit);
  // Between the highest return and the first beam that passed over, the top is anywhere.
  const double top = std::isfinite(e.topBound) ? 0.5 * (e.top + e.topBound) : 1e9;
  if (std::max<double>(top, e.top) < m_options.minTop) return Refusal::tooLow;
  if (e.bottom > m_options.maxBottom) return Refusal::startsTooHigh;
  if (e.tilt > m_options.maxTilt && e.slimHeight > 0.8) return Refusal::tilted;

  pole.confidence = confidence(e, *fit);
  if (pole.confidence < m_options.minConfidence) return Refusal::lowConfidence;
  pole.x = fit->x;
  pole.y = fit->y;
  pole.radius = fit->radius;
  pole.bottom = e.bottom;
  pole.top = e.top;
  pole.covariance = fit->covariance;
  pole.points = points;
  return Refusal::count_;
}

double NativeExtractor::confidence(const PoleEvidence& e, const PoleFit& fit) const {
  const double rows = e.slices + e.rowsPassed + e.rowsWide;
  double score = 0.5;
  score += 1.2 * std::log(e.slices) + 0.3 * std::log(e.points);
  score += 0.6 * std::min(3.f, e.slimHeight);
  score -= 6.0 * e.rowsPassed / rows;
  score -= 2.5 * e.rowsWide / rows;
  score -= 3.0 * e.rowsCluttered / e.slices;
  score -= 1.5 * (1 - static_cast<double>(e.wholeSlices) / e.slices);
  score -= 18 * e.scatter;
  score -= 20 * std::max(0.f, fit.residual - 0.02f);
  score -= 6 * e.widthSpread;
  if (e.top < m_options.minTop) score -= 1.0;
  return 1 / (1 + std::exp(-score));
}

}  // namespace polemcl
