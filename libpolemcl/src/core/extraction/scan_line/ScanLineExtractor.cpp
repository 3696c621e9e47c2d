#include "core/extraction/scan_line/ScanLineExtractor.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/common/Statistics.h"

namespace polemcl {
namespace {

/// m: points less than this above the ground say little about poles, and are most of a scan.
constexpr float kClearance = 0.1f;
/// m above ground: below, a pole's foot is seldom free.
constexpr float kFirmHeight = 0.6f;
/// Candidates whose odds are lower before the fit are not fitted: 0.2 % of the poles found.
constexpr double kHopelessOdds = -3;

double confidence(double logOdds) {
  return 1 / (1 + std::exp(-logOdds));
}

}  // namespace

ScanLineExtractor::ScanLineExtractor(SensorModel model, const SensorOptions& sensor,
                                     const ScanLineOptions& options)
    : m_sensorOptions(sensor),
      m_options(options),
      // What stands well behind the farthest pole is as good as nothing.
      m_farthest(static_cast<float>(std::min(sensor.maxRange, options.maxRange + 1))),
      m_sensor(std::move(model)),
      m_lines(m_sensor),
      m_finder(m_sensor, options),
      m_stacker(m_sensor, options),
      m_freeFinder(m_sensor, sensor.height, options.maxRange) {}

void ScanLineExtractor::extract(const PointsView& points, const Eigen::Vector2f& upright,
                                std::vector<PoleDetection>& poles, ExtractionReport& report) {
  m_upright = upright;
  const auto& dropped = m_ground.build(points, static_cast<float>(m_sensorOptions.minRange),
                                       m_farthest, static_cast<float>(m_sensorOptions.height));
  const auto& counts = m_lines.build(points, m_ground, kClearance);
  report.points = points.size;
  report.invalid = dropped.invalid;
  report.outOfRange = dropped.outOfRange;
  report.outOfView = counts.outOfView;
  report.ground = m_ground.median();
  m_finder.find(m_lines, m_slices);
  const std::vector<SegmentCluster>& stacks = m_stacker.stack(m_slices);
  report.candidates = stacks.size();
  m_leans.clear();
  for (const SegmentCluster& stack : stacks) {
    PoleDetection pole;
    PoleTilt lean;
    const RejectionReason refusal = examine(stack, pole, lean);
    if (refusal == RejectionReason::count_) {
      poles.push_back(pole);
      m_leans.push_back(lean);
    } else {
      ++report.refused[static_cast<int>(refusal)];
    }
  }
  m_freeFinder.find(m_lines, m_ground, m_freeRange);
  setUpright(poles);
  report.refused[static_cast<int>(RejectionReason::duplicate)] = dropDuplicates(poles);
}

/// The sensor's tilt, which the fits did not know, moves poles whose own lean is not well seen.
void ScanLineExtractor::setUpright(std::vector<PoleDetection>& poles) const {
  const Eigen::Vector2f common = estimateTilt(m_leans, m_upright);
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const Eigen::Vector2f shift = shiftBy(m_leans[i], m_upright, common);
    poles[i].x += shift.x();
    poles[i].y += shift.y();
  }
}

/// Two stacks can stand on one thing (a sign's edge beside its post): the more confident one stays.
std::size_t ScanLineExtractor::dropDuplicates(std::vector<PoleDetection>& poles) const {
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
void ScanLineExtractor::selectForFit(const SegmentCluster& stack) {
  m_widths.clear();
  for (auto i : stack) m_widths.push_back(m_slices[i].width());
  const float typical = elementOfRank(m_widths, (m_widths.size() - 1) * 4 / 10);
  m_fitSlices.clear();
  for (auto i : stack) {
    const float column = m_slices[i].rho * static_cast<float>(m_sensor.columnAngle());
    if (m_slices[i].width() <= 1.4f * typical + 1.5f * column) m_fitSlices.push_back(i);
  }
}

/// Refusals that need no more than the slices, the cheapest first.
RejectionReason ScanLineExtractor::judgeShape(const SegmentCluster& stack,
                                              ClusterShape& shape) const {
  const ScanLineSegment &highest = m_slices[stack.top()], &lowest = m_slices[stack.bottom()];
  if (highest.z - lowest.z < m_options.minHeight) return RejectionReason::tooShort;
  if (lowest.z - m_ground.at(lowest.x, lowest.y) > m_options.maxBottom)
    return RejectionReason::startsTooHigh;
  shape = measureShape(m_slices, stack);
  if (shape.points < m_options.minPoints) return RejectionReason::tooFewPoints;
  if (shape.tilt > m_options.maxTilt && shape.high - shape.low > 0.8)
    return RejectionReason::tilted;
  if (shape.scatter > m_options.maxScatter) return RejectionReason::notStraight;
  return RejectionReason::count_;
}

/// Cheap tests first; the fit, which costs most, comes last.
RejectionReason ScanLineExtractor::examine(const SegmentCluster& stack, PoleDetection& pole,
                                           PoleTilt& lean) {
  ClusterShape shape;
  const RejectionReason early = judgeShape(stack, shape);
  if (early != RejectionReason::count_) return early;
  selectForFit(stack);
  const float column = static_cast<float>(m_sensor.columnAngle());
  const PoleAxis axis = roughAxis(m_slices, m_fitSlices, column);
  const CandidateFeatures evidence =
      computeFeatures(m_lines, m_sensor, m_ground, m_slices, stack, shape, axis);
  // Between the highest return and the first beam that passed over, the top is anywhere.
  const double top =
      std::isfinite(evidence.topBound) ? 0.5 * (evidence.top + evidence.topBound) : 1e9;
  if (std::max<double>(top, evidence.top) < m_options.minTop) return RejectionReason::tooLow;
  PoleFeatures features = describe(stack, shape, evidence, axis);
  if (roughOdds(features) < kHopelessOdds) return RejectionReason::lowConfidence;
  const float ground = m_ground.at(axis.x, axis.y);
  const auto fit = fitPole(m_lines, m_slices, m_fitSlices,
                           {column, ground + kFirmHeight, m_upright.x(), m_upright.y()});
  if (!fit || fit->radius < m_options.minRadius || fit->radius > m_options.maxRadius)
    return RejectionReason::badFit;
  features.residual = fit->residual;
  features.radius = fit->radius;
  // A place without clutter is the best that can be.
  if (confidence(poleOdds(features)) < m_options.minConfidence)
    return RejectionReason::lowConfidence;
  features.clutter = clutteredShare(m_lines, m_sensor, m_slices, stack, axis);
  const double odds = poleOdds(features);
  pole.confidence = confidence(odds);
  if (pole.confidence < m_options.minConfidence) return RejectionReason::notFree;
  pole.x = fit->x;
  pole.y = fit->y;
  pole.radius = fit->radius;
  lean = fit->lean;
  lean.weight = static_cast<float>(pole.confidence - m_options.minConfidence);
  pole.bottom = evidence.bottom;
  pole.top = evidence.top;
  pole.covariance = fit->covariance * covarianceScale(features, odds);
  pole.points = static_cast<std::uint32_t>(shape.points);
  return RejectionReason::count_;
}

PoleFeatures ScanLineExtractor::describe(const SegmentCluster& stack, const ClusterShape& shape,
                                         const CandidateFeatures& evidence,
                                         const PoleAxis& axis) const {
  PoleFeatures f;
  f.slices = static_cast<double>(stack.count);
  f.points = shape.points;
  f.extent = shape.high - shape.low;
  const double rows = f.slices + evidence.rowsPassed + evidence.rowsWide;
  f.passed = evidence.rowsPassed / rows;
  f.wide = evidence.rowsWide / rows;
  f.notWhole = 1 - shape.wholeSlices / f.slices;
  f.scatter = shape.scatter;
  f.widthSpread = shape.widthSpread;
  f.tilt = shape.tilt;
  f.top = evidence.top;
  f.missingTop = std::max(0.0, m_options.minTop - evidence.top);
  f.bottom = evidence.bottom;
  f.roughRadius = axis.radius;
  f.range = m_slices[stack.bottom()].rho;
  f.columnWidth = f.range * m_sensor.columnAngle();
  int freeEdges = 0;
  for (auto i : m_fitSlices)
    freeEdges += (m_slices[i].left == Side::free) + (m_slices[i].right == Side::free);
  f.hiddenEdges = 1 - 0.5 * freeEdges / static_cast<double>(m_fitSlices.size());
  return f;
}

/// What the fit's own covariance does not know: crooked, half hidden and doubtful things lie
/// farther off, and columns are the same for all beams, so that more slices do not make up for
/// wide ones. Maximum likelihood on the worlds of the score.
double ScanLineExtractor::covarianceScale(const PoleFeatures& f, double odds) const {
  constexpr double kFineColumns = 0.003;  // rad
  return std::exp(-1.15 - 0.124 * std::clamp(odds, 0.0, 7.0) +
                  56.5 * std::clamp(f.residual - 0.02, 0.0, 0.05) + 2.55 * f.tilt +
                  1.264 * f.range / 40 + 2.34 * f.radius + 0.46 * f.clutter + 2.52 * f.scatter +
                  1.09 * f.hiddenEdges + 0.851 * std::log(m_sensor.columnAngle() / kFineColumns));
}

}  // namespace polemcl
