#include "NativeExtractor.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace polemcl {
namespace {

/// Log odds lost per metre of the fit's residual beyond 2 cm; from the same regression as score().
constexpr double kResidualOdds = 68;
/// Log odds lost when all rows have other returns in the ring around.
constexpr double kClutterOdds = 5.36;

double confidence(double logOdds) {
  return 1 / (1 + std::exp(-logOdds));
}

}  // namespace

NativeExtractor::NativeExtractor(const SensorOptions& sensor, const NativeOptions& options)
    : m_sensorOptions(sensor),
      m_options(options),
      m_sensor(sensor),
      m_lines(m_sensor),
      m_finder(m_sensor, options),
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
  m_finder.find(m_lines, m_slices);
  const std::vector<Stack>& stacks = m_stacker.stack(m_slices);
  report.candidates = stacks.size();
  for (const Stack& stack : stacks) {
    PoleDetection pole;
    const Refusal refusal = examine(stack, pole);
    if (refusal == Refusal::count_)
      poles.push_back(pole);
    else
      ++report.refused[static_cast<int>(refusal)];
  }
  report.refused[static_cast<int>(Refusal::duplicate)] = dropDuplicates(poles);
}

/// Two stacks can stand on one thing (a sign's edge beside its post): the more confident one stays.
std::size_t NativeExtractor::dropDuplicates(std::vector<PoleDetection>& poles) const {
  std::sort(poles.begin(), poles.end(), [](const PoleDetection& a, const PoleDetection& b) {
    return a.confidence != b.confidence ? a.confidence > b.confidence
                                        : std::tie(a.x, a.y) < std::tie(b.x, b.y);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const bool taken =
        std::any_of(poles.begin(), poles.begin() + kept, [&](const PoleDetection& better) {
          return std::hypot(better.x - poles[i].x, better.y - poles[i].y) < m_options.minSpacing;
        });
    if (!taken) poles[kept++] = poles[i];
  }
  const std::size_t dropped = poles.size() - kept;
  poles.resize(kept);
  return dropped;
}

/// The slices of the bare trunk: those not much wider than the slimmer ones (a sign is wider).
void NativeExtractor::selectForFit(const Stack& stack) {
  m_widths.clear();
  for (auto i : stack) m_widths.push_back(m_slices[i].width());
  const std::size_t middle = (m_widths.size() - 1) * 4 / 10;
  std::nth_element(m_widths.begin(), m_widths.begin() + middle, m_widths.end());
  const float typical = m_widths[middle];
  m_fitSlices.clear();
  for (auto i : stack) {
    const float column = m_slices[i].rho * static_cast<float>(m_sensor.columnAngle());
    if (m_slices[i].width() <= 1.4f * typical + 1.5f * column) m_fitSlices.push_back(i);
  }
}

/// Cheap tests first; the fit, which costs most, comes last.
Refusal NativeExtractor::examine(const Stack& stack, PoleDetection& pole) {
  const StackShape shape = measureShape(m_slices, stack);
  if (shape.points < m_options.minPoints) return Refusal::tooFewPoints;
  if (shape.high - shape.low < m_options.minHeight) return Refusal::tooShort;
  const Slice& lowest = m_slices[stack.bottom()];
  const float ground = m_ground.at(0.5f * (lowest.azimuthBegin + lowest.azimuthEnd), lowest.rho);
  if (lowest.z - ground > m_options.maxBottom) return Refusal::startsTooHigh;
  if (shape.tilt > m_options.maxTilt && shape.high - shape.low > 0.8) return Refusal::tilted;
  if (shape.scatter > m_options.maxScatter) return Refusal::notStraight;

  selectForFit(stack);
  const float column = static_cast<float>(m_sensor.columnAngle());
  const PoleAxis axis = roughAxis(m_slices, m_fitSlices, column);
  const PoleEvidence evidence =
      gatherEvidence(m_lines, m_sensor, m_ground, m_slices, stack, shape, axis);
  // Between the highest return and the first beam that passed over, the top is anywhere.
  const double top =
      std::isfinite(evidence.topBound) ? 0.5 * (evidence.top + evidence.topBound) : 1e9;
  if (std::max<double>(top, evidence.top) < m_options.minTop) return Refusal::tooLow;
  // Clutter and a bad fit can only lower the odds, and cost more to find out.
  double odds = score(stack, shape, evidence, axis);
  if (confidence(odds) < m_options.minConfidence) return Refusal::lowConfidence;
  odds -= kClutterOdds * clutteredShare(m_lines, m_sensor, m_slices, stack, axis);
  if (confidence(odds) < m_options.minConfidence) return Refusal::notFree;
  const auto fit = fitPole(m_lines, m_slices, m_fitSlices, column);
  if (!fit || fit->radius < m_options.minRadius || fit->radius > m_options.maxRadius)
    return Refusal::badFit;
  const double excess = std::max(0.f, fit->residual - 0.02f);
  odds -= kResidualOdds * excess;
  pole.confidence = confidence(odds);
  if (pole.confidence < m_options.minConfidence) return Refusal::lowConfidence;
  pole.x = fit->x;
  pole.y = fit->y;
  pole.radius = fit->radius;
  pole.bottom = evidence.bottom;
  pole.top = evidence.top;
  // What the fit's own covariance does not know: crooked, leaning, half hidden and doubtful things
  // lie farther off. Maximum likelihood on the same worlds as score(); mean normalised squared
  // error 2.0.
  pole.covariance = fit->covariance *
                    std::exp(0.48 - 0.25 * std::clamp(odds, 0.0, 7.0) +
                             34 * std::min(excess, 0.05) + 7.6 * shape.tilt + 0.022 * lowest.rho);
  pole.points = static_cast<std::uint32_t>(shape.points);
  return Refusal::count_;
}

/// Log odds of a pole, by logistic regression on simulated streets of four sensors (worlds 101 to
/// 104; area under the ROC on worlds 105 and 106: 0.99). Evidence that the fit adds comes later.
double NativeExtractor::score(const Stack& stack, const StackShape& shape, const PoleEvidence& e,
                              const PoleAxis& axis) const {
  const double slices = static_cast<double>(stack.count), points = shape.points;
  const double rows = slices + e.rowsPassed + e.rowsWide;
  double odds = 3.1;
  odds += -1.38 * std::log(slices) + 1.23 * std::log(points);
  odds += 1.97 * std::min(3.f, shape.high - shape.low);
  odds += -3.94 * e.rowsPassed / rows - 3.51 * e.rowsWide / rows;
  odds += -3.62 * (1 - shape.wholeSlices / slices);
  odds += -3.2 * shape.scatter + 5.7 * shape.widthSpread;
  odds += -1.71 * std::max(0.0, m_options.minTop - e.top);
  odds += -7.93 * axis.radius - 0.89 * std::min(6.f, e.top) + 0.32 * e.bottom;
  return odds;
}

}  // namespace polemcl
