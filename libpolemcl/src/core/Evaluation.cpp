#include <polemcl/core/BipartiteMatching.h>
#include <polemcl/core/Evaluation.h>
#include <polemcl/core/KdTree2D.h>
#include <polemcl/core/PoseInterpolation.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace polemcl {
namespace {

void check(const std::vector<StampedPose2D>& trajectory, const std::string& name) {
  if (trajectory.empty()) throw Error("the " + name + " holds no pose; there must be at least one");
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const StampedPose2D& at = trajectory[i];
    if (!std::isfinite(at.time + at.pose.x + at.pose.y + at.pose.yaw)) {
      throw Error("pose " + std::to_string(i) + " of the " + name +
                  " holds a number that is not finite");
    }
    if (i > 0 && !(at.time > trajectory[i - 1].time)) {
      throw Error("pose " + std::to_string(i) + " of the " + name + ", at " +
                  std::to_string(at.time) +
                  " s, is not later than the one before; times must increase");
    }
  }
}

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
                 const std::vector<StampedPose2D>& estimate) {
  if (matched > 0 && 2 * matched >= all) return;
  throw Error("only " + std::to_string(matched) + " of " + std::to_string(all) +
              " poses can be compared, at least half must; the truth spans " +
              std::to_string(truth.front().time) + " to " + std::to_string(truth.back().time) +
              " s, the estimate " + std::to_string(estimate.front().time) + " to " +
              std::to_string(estimate.back().time) + " s: check that they belong together");
}

void summarize(TrajectoryErrors& summary) {
  double squares = 0, angle = 0, squaredAngles = 0;
  for (const PoseError& e : summary.errors) {
    summary.posMean += e.position;
    summary.posMax = std::max(summary.posMax, e.position);
    summary.latMean += std::abs(e.lateral);
    summary.lonMean += std::abs(e.longitudinal);
    squares += e.position * e.position;
    angle += std::abs(e.heading);
    squaredAngles += e.heading * e.heading;
  }
  summary.poses = summary.errors.size();
  const double n = static_cast<double>(summary.poses);
  summary.posMean /= n;
  summary.latMean /= n;
  summary.lonMean /= n;
  summary.posRmse = std::sqrt(squares / n);
  summary.angMeanDeg = angle / n * 180 / M_PI;
  summary.angRmseDeg = std::sqrt(squaredAngles / n) * 180 / M_PI;
}

void checkPoles(const std::vector<Eigen::Vector2d>& poles, const std::string& name) {
  if (poles.empty()) throw Error("the " + name + " holds no pole; there must be at least one");
  for (std::size_t i = 0; i < poles.size(); ++i) {
    if (poles[i].allFinite()) continue;
    throw Error("pole " + std::to_string(i) + " of the " + name +
                " has a coordinate that is not finite; remove it");
  }
}

std::vector<std::vector<std::uint32_t>> edgesWithin(const std::vector<Eigen::Vector2d>& from,
                                                    const KdTree2D& to, double radius) {
  std::vector<std::vector<std::uint32_t>> edges;
  std::vector<PointHit> hits;
  for (const Eigen::Vector2d& p : from) {
    to.within(p.x(), p.y(), 1.001 * radius, hits);  // wider, as the tree leaves the border out
    edges.emplace_back();
    for (const PointHit& hit : hits) {
      if (hit.squaredDistance <= radius * radius) edges.back().push_back(hit.index);
    }
  }
  return edges;
}

}  // namespace

TrajectoryErrors evaluateTrajectory(const std::vector<StampedPose2D>& truth,
                                    const std::vector<StampedPose2D>& estimate, Sampling sampling,
                                    double maxTruthGap) {
  check(truth, "true trajectory");
  check(estimate, "estimated trajectory");
  std::vector<double> times;
  for (const StampedPose2D& e : estimate) {
    if (poseAt(truth, e.time, maxTruthGap)) times.push_back(e.time);
  }
  requireHalf(times.size(), estimate.size(), truth, estimate);
  TrajectoryErrors summary;
  summary.unmatched = estimate.size() - times.size();
  if (sampling == Sampling::perMetre) {
    times = metreTimes(truth, estimate.front().time, estimate.back().time);
    summary.unmatched = 0;
  }
  for (const double time : times) {
    const auto is = poseAt(truth, time, maxTruthGap), said = poseAt(estimate, time, maxTruthGap);
    if (is && said) {
      summary.errors.push_back(errorOf(time, *is, *said));
    } else {
      ++summary.unmatched;
    }
  }
  requireHalf(summary.errors.size(), times.size(), truth, estimate);
  summarize(summary);
  return summary;
}

MapScore scoreMap(const std::vector<Eigen::Vector2d>& truth,
                  const std::vector<Eigen::Vector2d>& map, double radius, bool oneToOne) {
  checkPoles(truth, "true map");
  checkPoles(map, "map");
  if (!(std::isfinite(radius) && radius > 0)) {
    throw Error("the matching radius is " + std::to_string(radius) +
                " m; it must be finite and above 0");
  }
  const auto edges = edgesWithin(map, KdTree2D(truth), radius);
  const auto matched = [](const std::vector<std::uint32_t>& candidates) {
    return !candidates.empty();
  };
  MapScore score;
  score.mapPoles = map.size();
  score.truthPoles = truth.size();
  score.matches =
      oneToOne ? maximumMatching(edges, truth.size())
               : static_cast<std::size_t>(std::count_if(edges.begin(), edges.end(), matched));
  const double matches = static_cast<double>(score.matches);
  score.precision = matches / static_cast<double>(map.size());
  score.recall = matches / static_cast<double>(truth.size());
  if (score.matches > 0)
    score.f1 = 2 * score.precision * score.recall / (score.precision + score.recall);
  return score;
}

}  // namespace polemcl
