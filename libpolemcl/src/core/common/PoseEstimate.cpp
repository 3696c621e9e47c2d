#include "core/common/PoseEstimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/common/SimdMath.h"

namespace polemcl {
namespace {

/// Weights scaled to a greatest of 1: no weight overflows, and not all become 0.
std::vector<double> weightsOf(const std::vector<double>& logWeights) {
  if (logWeights.empty())
    throw Error("no particles to estimate a pose from; there must be at least one");
  double greatest = -INFINITY;
  for (std::size_t i = 0; i < logWeights.size(); ++i) {
    if (std::isnan(logWeights[i]) || logWeights[i] == INFINITY) {
      throw Error("the logarithmic weight of particle " + std::to_string(i) + " is " +
                  std::to_string(logWeights[i]) + "; it must be a number below infinity");
    }
    greatest = std::max(greatest, logWeights[i]);
  }
  if (greatest == -INFINITY)
    throw Error("all particles have a weight of zero; at least one must count");
  std::vector<double> weights = logWeights;
  for (double& weight : weights) weight -= greatest;
  exponentials(weights.data(), weights.size());
  return weights;
}

void checkSizes(const std::vector<Pose2D>& particles, const std::vector<double>& logWeights) {
  if (particles.size() == logWeights.size()) return;
  throw Error("there are " + std::to_string(particles.size()) + " particles but " +
              std::to_string(logWeights.size()) + " weights; there must be one weight for each");
}

/// Mean of the chosen particles, which are given by ascending index.
Pose2D meanOf(const std::vector<Pose2D>& particles, const std::vector<double>& weights,
              const std::vector<std::size_t>& chosen) {
  // Sums relative to one particle lose no digits far from the origin of the map.
  const Pose2D origin = particles[chosen.front()];
  double sum = 0, x = 0, y = 0, sine = 0, cosine = 0;
  std::size_t heaviest = chosen.front(), next = 0;
  std::vector<double> yaws, sines(chosen.size()), cosines(chosen.size());
  yaws.reserve(chosen.size());
  for (const std::size_t i : chosen) yaws.push_back(particles[i].yaw);
  sinesAndCosines(yaws.data(), yaws.size(), sines.data(), cosines.data());
  for (const std::size_t i : chosen) {
    sum += weights[i];
    x += weights[i] * (particles[i].x - origin.x);
    y += weights[i] * (particles[i].y - origin.y);
    sine += weights[i] * sines[next];
    cosine += weights[i] * cosines[next++];
    if (weights[i] > weights[heaviest]) heaviest = i;
  }
  const bool cancelled = std::hypot(sine, cosine) <= 1e-12 * sum;
  return {origin.x + x / sum, origin.y + y / sum,
          wrapAngle(cancelled ? particles[heaviest].yaw : std::atan2(sine, cosine))};
}

Eigen::Matrix3d spreadAbout(const Pose2D& mean, const std::vector<Pose2D>& particles,
                            const std::vector<double>& weights) {
  double sum = 0, xx = 0, xy = 0, yy = 0, xa = 0, ya = 0, aa = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double x = particles[i].x - mean.x, y = particles[i].y - mean.y;
    const double a = wrapAngle(particles[i].yaw - mean.yaw);
    const double wx = weights[i] * x, wy = weights[i] * y, wa = weights[i] * a;
    xx += wx * x, xy += wx * y, yy += wy * y;
    xa += wx * a, ya += wy * a, aa += wa * a;
    sum += weights[i];
  }
  Eigen::Matrix3d covariance;
  covariance << xx, xy, xa, xy, yy, ya, xa, ya, aa;
  return covariance / sum;
}

}  // namespace

PoseWithCovariance weightedMean(const std::vector<Pose2D>& particles,
                                const std::vector<double>& logWeights) {
  return bestShareMean(particles, logWeights, 1);
}

PoseWithCovariance bestShareMean(const std::vector<Pose2D>& particles,
                                 const std::vector<double>& logWeights, double share) {
  if (!(share > 0 && share <= 1)) {
    throw Error("the share of the best particles is " + std::to_string(share) +
                "; it must lie in (0, 1]");
  }
  checkSizes(particles, logWeights);
  const std::vector<double> weights = weightsOf(logWeights);
  std::vector<std::size_t> chosen(particles.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  // Round down, but allow for rounding: 0.29 of 100 is 28.999999999999996.
  const double wanted = std::floor(share * static_cast<double>(particles.size()) + 1e-9);
  const std::size_t count =
      std::clamp<std::size_t>(static_cast<std::size_t>(wanted), 1, particles.size());
  if (count < chosen.size()) {
    std::nth_element(
        chosen.begin(), chosen.begin() + count, chosen.end(), [&](std::size_t a, std::size_t b) {
          return logWeights[a] != logWeights[b] ? logWeights[a] > logWeights[b] : a < b;
        });
    chosen.resize(count);
    std::sort(chosen.begin(), chosen.end());
  }
  const Pose2D mean = meanOf(particles, weights, chosen);
  return {mean, spreadAbout(mean, particles, weights)};
}

Eigen::Matrix3d covarianceAbout(const Pose2D& pose, const std::vector<Pose2D>& particles,
                                const std::vector<double>& logWeights) {
  checkSizes(particles, logWeights);
  return spreadAbout(pose, particles, weightsOf(logWeights));
}

double effectiveShare(const std::vector<double>& logWeights) {
  double sum = 0, squares = 0;
  for (const double weight : weightsOf(logWeights)) {
    sum += weight;
    squares += weight * weight;
  }
  return std::min(1.0, sum * sum / squares / static_cast<double>(logWeights.size()));
}

}  // namespace polemcl
