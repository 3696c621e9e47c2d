#include "core/evaluation/TrajectoryEvaluation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/common/PoseInterpolation.h"

namespace polemcl {
namespace {

/// \param before The pose before, null for the first.
void check(const StampedPose2D& at, const StampedPose2D* before, std::size_t index,
           const std::string& name) {
  if (!std::isfinite(at.time + at.pose.x + at.pose.y + at.pose.yaw)) {
    throw Error("pose " + std::to_string(index) + " of the " + name +
                " holds a number that is not finite");
  }
  if (before && !(at.time > before->time)) {
    throw Error("pose " + std::to_string(index) + " of the " + name + ", at " +
                std::to_string(at.time) +
                " s, is not later than the one before; times must increase");
  }
}

void check(const std::vector<StampedPose2D>& trajectory, const std::string& name) {
  if (trajectory.empty()) throw Error("the " + name + " holds no pose; there must be at least one");
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    check(trajectory[i], i > 0 ? &trajectory[i - 1] : nullptr, i, name);
}

constexpr const char* trueName = "true trajectory";
constexpr const char* estimatedName = "estimated trajectory";

PoseError errorOf(double time, const Pose2D& truth, const Pose2D& estimate) {
  const Pose2D error = relative(truth, estimate);
  return {time, std::hypot(error.x, error.y), error.y, error.x, error.yaw};
}

/// Times at which the true path has grown by whole metres since `start`, up to `end`.
std::vector<double> metreTimes(const std::vector<StampedPose2D>& truth, double start, double end) {
  StampedPose2D earlier = truth.front();
  if (const auto pose = poseAt(truth, start, INFINITY)) earlier = {start, *pose};
  std::vector<double> times;
  if (earlier.time <= end) times.push_back(earlier.time);
  double travelled = 0, metre = 1;  // along the path up to `earlier`, and the next to be marked
  for (const StampedPose2D& later : truth) {
    if (later.time <= earlier.time) continue;
    const double step = std::hypot(later.pose.x - earlier.pose.x, later.pose.y - earlier.pose.y);
    for (; metre <= travelled + step; ++metre) {
      const double time = earlier.time + (metre - travelled) / step * (later.time - earlier.time);
      if (time > end + sampleTolerance) return times;
      times.push_back(time);
    }
    travelled += step;
    earlier = later;
  }
  return times;
}

/// Half of them must be found again: less says more about the clocks than about the trajectory.
void requireHalf(std::size_t matched, std::size_t all, const std::vector<StampedPose2D>& truth,
                 const StampedPose2D& first, const StampedPose2D& last) {
  if (matched > 0 && 2 * matched >= all) return;
  throw Error("only " + std::to_string(matched) + " of " + std::to_string(all) +
              " poses can be compared, at least half must; the truth spans " +
              std::to_string(truth.front().time) + " to " + std::to_string(truth.back().time) +
              " s, the estimate " + std::to_string(first.time) + " to " +
              std::to_string(last.time) + " s: check that they belong together");
}

void addTo(TrajectoryErrors& sums, const PoseError& e) {
  ++sums.poses;
  sums.posMean += e.position;
  sums.posMax = std::max(sums.posMax, e.position);
  sums.latMean += std::abs(e.lateral);
  sums.lonMean += std::abs(e.longitudinal);
  sums.posRmse += e.position * e.position;
  sums.angMeanDeg += std::abs(e.heading);
  sums.angRmseDeg += e.heading * e.heading;
}

/// Turns sums of radians into means of degrees, those of squares into their roots.
void divide(TrajectoryErrors& sums) {
  const double n = static_cast<double>(sums.poses);
  sums.posMean /= n;
  sums.latMean /= n;
  sums.lonMean /= n;
  sums.posRmse = std::sqrt(sums.posRmse / n);
  sums.angMeanDeg = sums.angMeanDeg / n * 180 / M_PI;
  sums.angRmseDeg = std::sqrt(sums.angRmseDeg / n) * 180 / M_PI;
}

}  // namespace

TrajectoryEvaluator::TrajectoryEvaluator(const std::vector<StampedPose2D>& truth,
                                         double maxTruthGap)
    : m_truth(truth), m_maxTruthGap(maxTruthGap) {
  check(truth, trueName);
}

std::optional<PoseError> TrajectoryEvaluator::add(const StampedPose2D& estimate) {
  check(estimate, m_estimates > 0 ? &m_last : nullptr, m_estimates, estimatedName);
  if (m_estimates++ == 0) m_first = estimate;
  m_last = estimate;
  const auto truth = poseAt(m_truth, estimate.time, m_maxTruthGap);
  if (!truth) {
    ++m_sums.unmatched;
    return std::nullopt;
  }
  const PoseError error = errorOf(estimate.time, *truth, estimate.pose);
  addTo(m_sums, error);
  return error;
}

TrajectoryErrors TrajectoryEvaluator::finish() const {
  if (m_estimates == 0) check({}, estimatedName);
  requireHalf(m_sums.poses, m_estimates, m_truth, m_first, m_last);
  TrajectoryErrors summary = m_sums;
  divide(summary);
  return summary;
}

namespace {

/// At each metre of the true path since the first estimate.
TrajectoryErrors evaluateMetres(const std::vector<StampedPose2D>& truth,
                                const std::vector<StampedPose2D>& estimate, double maxTruthGap) {
  const auto times = metreTimes(truth, estimate.front().time, estimate.back().time);
  TrajectoryErrors summary;
  for (const double time : times) {
    const auto is = poseAt(truth, time, maxTruthGap), said = poseAt(estimate, time, maxTruthGap);
    if (is && said) {
      summary.errors.push_back(errorOf(time, *is, *said));
      addTo(summary, summary.errors.back());
    } else {
      ++summary.unmatched;
    }
  }
  requireHalf(summary.poses, times.size(), truth, estimate.front(), estimate.back());
  divide(summary);
  return summary;
}

}  // namespace

TrajectoryErrors evaluateTrajectory(const std::vector<StampedPose2D>& truth,
                                    const std::vector<StampedPose2D>& estimate, Sampling sampling,
                                    double maxTruthGap) {
  TrajectoryEvaluator poses(truth, maxTruthGap);
  check(estimate, estimatedName);
  std::vector<PoseError> errors;
  for (const StampedPose2D& e : estimate)
    if (const auto error = poses.add(e)) errors.push_back(*error);
  TrajectoryErrors summary = poses.finish();
  if (sampling == Sampling::perMetre) return evaluateMetres(truth, estimate, maxTruthGap);
  summary.errors = std::move(errors);
  return summary;
}

std::vector<double> distanceDriven(const std::vector<StampedPose2D>& truth,
                                   const std::vector<PoseError>& errors) {
  std::vector<double> along(truth.size(), 0.0);
  for (std::size_t i = 1; i < truth.size(); ++i)
    along[i] = along[i - 1] + std::hypot(truth[i].pose.x - truth[i - 1].pose.x,
                                         truth[i].pose.y - truth[i - 1].pose.y);
  std::vector<double> distances;
  for (const PoseError& error : errors) {
    const auto later =
        std::lower_bound(truth.begin(), truth.end(), error.time,
                         [](const StampedPose2D& pose, double time) { return pose.time < time; });
    const std::size_t i = static_cast<std::size_t>(later - truth.begin());
    if (i == 0 || i == truth.size()) {
      distances.push_back(i == 0 ? 0 : along.back());
      continue;
    }
    const double share = (error.time - truth[i - 1].time) / (truth[i].time - truth[i - 1].time);
    distances.push_back(along[i - 1] + share * (along[i] - along[i - 1]));
  }
  return distances;
}

}  // namespace polemcl
