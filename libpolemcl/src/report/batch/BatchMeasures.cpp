#include "report/batch/BatchMeasures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "core/common/PoseInterpolation.h"
#include "core/common/Statistics.h"
#include "core/common/TickStep.h"

namespace polemcl::report {
namespace {

constexpr double degrees = 180 / M_PI;

/// Standard deviation of all poses about their mean.
template <typename Value>
double deviation(const std::vector<PoseError>& errors, const Value& value) {
  double mean = 0, squares = 0;
  for (const PoseError& error : errors) mean += value(error) / static_cast<double>(errors.size());
  for (const PoseError& error : errors) squares += std::pow(value(error) - mean, 2);
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

/// Sums of squares of the errors along the axes of the map.
Eigen::Array2d axisSquares(const std::vector<PoseError>& errors,
                           const std::vector<StampedPose2D>& truth) {
  Eigen::Array2d squares = Eigen::Array2d::Zero();
  for (const PoseError& error : errors) {
    const auto pose = poseAt(truth, error.time, HUGE_VAL);
    if (!pose)
      throw Error("report: an error at " + std::to_string(error.time) +
                  " s lies outside the truth; give the truth it was computed against");
    const double c = std::cos(pose->yaw), s = std::sin(pose->yaw);
    const Eigen::Array2d alongAxes(c * error.longitudinal - s * error.lateral,
                                   s * error.longitudinal + c * error.lateral);
    squares += alongAxes.square();
  }
  return squares;
}

double distanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((point - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (point - from - share * along).norm();
}

double defaultTolerance(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Array2d low = points.front(), high = points.front();
  for (const Eigen::Vector2d& point : points) {
    low = low.min(point.array());
    high = high.max(point.array());
  }
  return (high - low).maxCoeff() / 1500;
}

Eigen::Vector2d roundedToCentimetres(const Eigen::Vector2d& point) {
  // Adding zero turns -0 into 0.
  return {std::round(point.x() * 100) / 100 + 0.0, std::round(point.y() * 100) / 100 + 0.0};
}

/// Nearly all errors are no farther apart than this, m. Bins must not be narrower than the scans
/// are apart, or the curve would be full of gaps.
double usualSpacing(const std::vector<double>& distance) {
  std::vector<double> spacing;
  for (std::size_t i = 1; i < distance.size(); ++i)
    spacing.push_back(distance[i] - distance[i - 1]);
  if (spacing.empty()) return 0;
  return elementOfRank(spacing,
                       static_cast<std::size_t>(0.95 * static_cast<double>(spacing.size() - 1)));
}

}  // namespace

ErrorMetrics errorMetrics(const TrajectoryErrors& errors, const std::vector<StampedPose2D>& truth) {
  ErrorMetrics figures;
  figures.poses = errors.errors.size();
  figures.unmatched = errors.unmatched;
  if (errors.errors.empty()) return figures;
  figures.posMean = errors.posMean;
  figures.posRmse = errors.posRmse;
  figures.posMax = errors.posMax;
  figures.posEnd = errors.errors.back().position;
  figures.latMean = errors.latMean;
  figures.lonMean = errors.lonMean;
  figures.latStd = deviation(errors.errors, [](const PoseError& e) { return e.lateral; });
  figures.lonStd = deviation(errors.errors, [](const PoseError& e) { return e.longitudinal; });
  const Eigen::Array2d squares = axisSquares(errors.errors, truth) / double(figures.poses);
  figures.xRmse = std::sqrt(squares.x());
  figures.yRmse = std::sqrt(squares.y());
  figures.angMeanDeg = errors.angMeanDeg;
  figures.angStdDeg =
      degrees * deviation(errors.errors, [](const PoseError& e) { return e.heading; });
  figures.angRmseDeg = errors.angRmseDeg;
  return figures;
}

void addErrors(SessionPlots& plots, const TrajectoryErrors& errors) {
  for (const PoseError& error : errors.errors) {
    plots.positionErrors.add(error.position);
    plots.headingErrors.add(degrees * std::abs(error.heading));
  }
}

std::vector<Eigen::Vector2d> thinPath(const std::vector<Eigen::Vector2d>& points,
                                      double tolerance) {
  if (points.empty()) return {};
  if (!(tolerance > 0)) tolerance = defaultTolerance(points);
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  // A stack rather than recursion: a spiral of 20,000 poses would go deep.
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t index = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distanceToSegment(points[i], points[first], points[last]);
      if (distance > farthest) farthest = distance, index = i;
    }
    if (index == 0) continue;
    kept[index] = true;
    open.push_back({first, index});
    open.push_back({index, last});
  }
  std::vector<Eigen::Vector2d> thinned;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept[i]) thinned.push_back(roundedToCentimetres(points[i]));
  return thinned;
}

std::vector<Eigen::Vector2d> thinPath(const std::vector<StampedPose2D>& path, double tolerance) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(path.size());
  for (const StampedPose2D& pose : path) points.emplace_back(pose.pose.x, pose.pose.y);
  return thinPath(points, tolerance);
}

BinnedMaxima positionOverDistance(const TrajectoryErrors& errors,
                                  const std::vector<StampedPose2D>& truth, std::size_t mostBins) {
  BinnedMaxima bins;
  if (errors.errors.empty()) return bins;
  const std::vector<double> distance = distanceDriven(truth, errors.errors);
  const double length = *std::max_element(distance.begin(), distance.end());
  // One bin less than allowed: the end of the drive opens another.
  const double most = static_cast<double>(std::max<std::size_t>(mostBins, 2) - 1);
  const double least = std::max({1.0, length / most, 1.5 * usualSpacing(distance)});
  bins.binWidth = tickStep(least, 1);
  bins.largest.assign(static_cast<std::size_t>(length / bins.binWidth) + 1, noFigure);
  for (std::size_t i = 0; i < distance.size(); ++i) {
    double& largest = bins.largest[static_cast<std::size_t>(distance[i] / bins.binWidth)];
    const double rounded = std::round(errors.errors[i].position * 1e4) / 1e4;
    if (!(largest >= rounded)) largest = rounded;
  }
  return bins;
}

}  // namespace polemcl::report
