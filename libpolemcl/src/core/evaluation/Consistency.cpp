#include "core/evaluation/Consistency.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/common/Covariance.h"
#include "core/common/Statistics.h"

namespace polemcl {
namespace {

[[noreturn]] void refuseSample(std::size_t sample, const char* what) {
  throw Error("sample " + std::to_string(sample) + " of the consistency has " + what);
}

Eigen::Vector3d sampleError(const ConsistencySample& sample) {
  const Pose2D &estimate = sample.estimate.mean, &truth = sample.truth;
  return {estimate.x - truth.x, estimate.y - truth.y, wrapAngle(estimate.yaw - truth.yaw)};
}

void checkSample(const ConsistencySample& sample, std::size_t index) {
  const Eigen::Matrix3d& covariance = sample.estimate.covariance;
  if (!sampleError(sample).allFinite()) refuseSample(index, "a pose that is not finite");
  if (!isDefiniteCovariance(covariance))
    refuseSample(index, "a covariance that is not symmetric positive definite");
}

double squaredSigmasOfPosition(const PoseWithCovariance& estimate, const Pose2D& truth) {
  const Eigen::Vector2d offset(estimate.mean.x - truth.x, estimate.mean.y - truth.y);
  const Eigen::Matrix2d covariance = estimate.covariance.topLeftCorner<2, 2>();
  return offset.dot(covariance.inverse() * offset);
}

}  // namespace

double sigmasOfPosition(const PoseWithCovariance& estimate, const Pose2D& truth) {
  return std::sqrt(squaredSigmasOfPosition(estimate, truth));
}

void LongestTime::add(double time, bool holds, bool isFirst) {
  if (!m_holds || isFirst) m_begin = time;
  m_holds = holds;
  if (holds) m_longest = std::max(m_longest, time - m_begin);
}

ConsistencyScore scoreConsistency(const std::vector<ConsistencySample>& samples) {
  if (samples.empty()) throw Error("no pose to score the consistency of");
  ConsistencyScore score;
  score.samples = samples.size();
  std::vector<double> all;
  all.reserve(samples.size());
  double sum = 0, position = 0, heading = 0;
  std::size_t covered = 0;
  LongestTime beyond5;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    checkSample(samples[i], i);
    const Eigen::Matrix3d& covariance = samples[i].estimate.covariance;
    const Eigen::Vector3d error = sampleError(samples[i]);
    all.push_back(error.dot(covariance.inverse() * error));
    const double planar = squaredSigmasOfPosition(samples[i].estimate, samples[i].truth);
    sum += all.back();
    position += planar;
    heading += error.z() * error.z() / covariance(2, 2);
    covered += planar <= chiSquare95of2 ? 1 : 0;
    beyond5.add(samples[i].time, planar > 25, samples[i].isFirst);
    if (planar > 25) score.errorBeyond5 = std::max(score.errorBeyond5, error.head<2>().norm());
  }
  const double count = static_cast<double>(samples.size());
  score.neesMean = sum / count;
  score.neesMedian = *quantile(std::move(all), 0.5);
  score.neesPositionMean = position / count;
  score.neesHeadingMean = heading / count;
  score.coverage95 = static_cast<double>(covered) / count;
  score.longestBeyond5 = beyond5.seconds();
  return score;
}

}  // namespace polemcl
