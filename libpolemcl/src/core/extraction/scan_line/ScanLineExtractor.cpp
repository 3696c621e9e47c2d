#include "core/extraction/scan_line/ScanLineExtractor.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/common/Statistics.h"
#include "core/extraction/CovarianceScale.h"

namespace polemcl {
namespace {

/// m: points less than this above the ground say little about poles, and are most of a scan.
constexpr float kClearance = 0.1f;
/// m: nearer points are at the sensor, and have no direction. Products of such ranges are 0.
constexpr float kAtSensor = 1e-3f;
/// m above ground: below, a pole's foot is seldom free.
constexpr float kFirmHeight = 0.6f;
/// Candidates whose odds are lower before the fit are not fitted: 0.3 % of the poles found.
constexpr double kHopelessOdds = -2.5;

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
      m_clustering(m_sensor, options),
      m_visibilityFinder(m_sensor, sensor.height, std::min(sensor.maxRange, options.maxRange)) {}

void ScanLineExtractor::extract(const PointsView& points, const Eigen::Vector2f& upright,
                                std::vector<PoleDetection>& poles, ExtractionReport& report) {
  m_upright = upright;
  const auto& dropped =
      m_ground.build(points, std::max(static_cast<float>(m_sensorOptions.minRange), kAtSensor),
                     m_farthest, static_cast<float>(m_sensorOptions.height), upright);
  const auto& counts = m_lines.build(points, m_ground, kClearance);
  report.points = points.size;
  report.invalid = dropped.invalid;
  report.outOfRange = dropped.outOfRange;
  report.outOfView = counts.outOfView;
  report.ground = m_ground.median();
  m_finder.find(m_lines, m_segments);
  const std::vector<SegmentCluster>& clusters = m_clustering.cluster(m_segments);
  report.candidates = clusters.size();
  m_tilts.clear();
  if (m_recorded) m_recorded->clear();
  for (const SegmentCluster& cluster : clusters) {
    PoleDetection pole;
    PoleTilt tilt;
    if (const auto rejection = examine(cluster, pole, tilt)) {
      ++report.refused[static_cast<int>(*rejection)];
    } else {
      poles.push_back(pole);
      m_tilts.push_back(tilt);
    }
  }
  m_visibilityFinder.find(m_lines, m_ground, upright, m_visibilityRange);
  setUpright(poles);
  report.refused[static_cast<int>(RejectionReason::duplicate)] = dropDuplicates(poles);
}

/// Moves poles whose own tilt is poorly seen, by the sensor's tilt that their fits did not know.
void ScanLineExtractor::setUpright(std::vector<PoleDetection>& poles) const {
  const Eigen::Vector2f common = estimateTilt(m_tilts, m_upright);
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const Eigen::Vector2f shift = shiftBy(m_tilts[i], m_upright, common);
    poles[i].x += shift.x();
    poles[i].y += shift.y();
  }
}

/// Two clusters can stand on one thing (a sign's edge beside its post): the more confident one
/// stays.
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

/// The segments of the bare trunk: those not much wider than the slimmer ones (a sign is wider).
void ScanLineExtractor::selectForFit(const SegmentCluster& cluster) {
  m_widths.clear();
  for (auto i : cluster) m_widths.push_back(m_segments[i].width());
  const float typical = elementOfRank(m_widths, (m_widths.size() - 1) * 4 / 10);
  m_fitSegments.clear();
  for (auto i : cluster) {
    const float column = m_segments[i].rho * static_cast<float>(m_sensor.columnAngle());
    if (m_segments[i].width() <= 1.4f * typical + 1.5f * column) m_fitSegments.push_back(i);
  }
}

/// Rejects by the segments alone, cheap tests first.
std::optional<RejectionReason> ScanLineExtractor::judgeShape(const SegmentCluster& cluster,
                                                             ClusterShape& shape) const {
  const ScanLineSegment &highest = m_segments[cluster.top()],
                        &lowest = m_segments[cluster.bottom()];
  if (highest.z - lowest.z < m_options.minHeight) return RejectionReason::tooShort;
  if (lowest.z - m_ground.at(lowest.x, lowest.y) > m_options.maxBottom)
    return RejectionReason::startsTooHigh;
  shape = measureShape(m_segments, cluster, m_upright);
  if (shape.points < m_options.minPoints) return RejectionReason::tooFewPoints;
  if (shape.tilt > m_options.maxTilt && shape.high - shape.low > 0.8)
    return RejectionReason::tilted;
  if (shape.scatter > m_options.maxScatter) return RejectionReason::notStraight;
  return std::nullopt;
}

/// Cheap tests first; the fit, which costs most, comes last.
std::optional<RejectionReason> ScanLineExtractor::examine(const SegmentCluster& cluster,
                                                          PoleDetection& pole, PoleTilt& tilt) {
  ClusterShape shape;
  if (const auto rejection = judgeShape(cluster, shape)) return rejection;
  selectForFit(cluster);
  const float column = static_cast<float>(m_sensor.columnAngle());
  const PoleAxis axis = roughAxis(m_segments, m_fitSegments, column, m_upright);
  const CandidateFeatures candidate = computeFeatures(m_lines, m_sensor, m_ground, m_segments,
                                                      cluster, shape, axis, m_options.minTop);
  if (candidate.highestTop() < m_options.minTop) return RejectionReason::tooLow;
  PoleFeatures features = describe(cluster, shape, candidate, axis);
  const bool hopeless = roughOdds(features) < kHopelessOdds;
  if (hopeless && !m_recorded) return RejectionReason::lowConfidence;
  const float ground = m_ground.at(axis.x, axis.y);
  const auto fit = fitPole(m_lines, m_segments, m_fitSegments,
                           {column, ground + kFirmHeight, m_upright.x(), m_upright.y()});
  if (!fit || fit->radius < m_options.minRadius || fit->radius > m_options.maxRadius)
    return RejectionReason::badFit;
  features.residual = fit->residual;
  features.radius = fit->radius;
  if (m_recorded) record(cluster, features, axis, *fit);
  if (hopeless) return RejectionReason::lowConfidence;
  // Upper bound: assume no clutter; skip the costly check if even that fails.
  if (confidence(poleOdds(features)) < m_options.minConfidence)
    return RejectionReason::lowConfidence;
  features.clutter = clutteredShare(m_lines, m_sensor, m_segments, cluster, axis);
  const double odds = poleOdds(features);
  pole.confidence = confidence(odds);
  if (pole.confidence < m_options.minConfidence) return RejectionReason::notFree;
  pole.x = fit->x;
  pole.y = fit->y;
  pole.radius = fit->radius;
  tilt = fit->tilt;
  tilt.weight = static_cast<float>(pole.confidence - m_options.minConfidence);
  pole.bottom = candidate.bottom;
  pole.top = candidate.top;
  pole.covariance = fit->covariance * covarianceScale(features, odds, m_sensor.columnAngle());
  pole.points = static_cast<std::uint32_t>(shape.points);
  return std::nullopt;
}

void ScanLineExtractor::record(const SegmentCluster& cluster, PoleFeatures features,
                               const PoleAxis& axis, const PoleFit& fit) {
  features.clutter = clutteredShare(m_lines, m_sensor, m_segments, cluster, axis);
  m_recorded->push_back({features, fit.x, fit.y, fit.covariance, fit.tilt});
}

PoleFeatures ScanLineExtractor::describe(const SegmentCluster& cluster, const ClusterShape& shape,
                                         const CandidateFeatures& candidate,
                                         const PoleAxis& axis) const {
  PoleFeatures f;
  f.segments = static_cast<double>(cluster.count);
  f.points = shape.points;
  f.extent = shape.high - shape.low;
  const double rows = f.segments + candidate.rowsPassed + candidate.rowsWide;
  f.passed = candidate.rowsPassed / rows;
  f.wide = candidate.rowsWide / rows;
  f.notWhole = 1 - shape.wholeSegments / f.segments;
  f.scatter = shape.scatter;
  f.widthSpread = shape.widthSpread;
  f.tilt = shape.tilt;
  f.top = candidate.top;
  f.missingTop = std::max(0.0, m_options.minTop - candidate.top);
  f.bottom = candidate.bottom;
  f.roughRadius = axis.radius;
  f.range = m_segments[cluster.bottom()].rho;
  f.columnWidth = f.range * m_sensor.columnAngle();
  int freeEdges = 0;
  for (auto i : m_fitSegments)
    freeEdges += (m_segments[i].left == Side::free) + (m_segments[i].right == Side::free);
  f.hiddenEdges = 1 - 0.5 * freeEdges / static_cast<double>(m_fitSegments.size());
  return f;
}

}  // namespace polemcl
