#include "core/extraction/scan_line/TiltEstimation.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr float kMostPrior = 0.4f;  // greatest share of the prior in a tilt that is used
constexpr double kPole = 0.03;      // standard deviation of a pole's own tilt, m per m
constexpr double kSensor = 0.04;    // and of the sensor's
constexpr double kOutlier = 2;      // sigmas; poles farther off lose weight
constexpr int kTiltRounds = 3;

}  // namespace

Eigen::Vector2f estimateTilt(const std::vector<PoleTilt>& poles, const Eigen::Vector2f& upright) {
  const Eigen::Vector2d before = upright.cast<double>();
  Eigen::Vector2d common = before;
  for (int round = 0; round < kTiltRounds; ++round) {
    double weights = 1 / (kSensor * kSensor);
    Eigen::Vector2d sum = weights * before;
    for (const PoleTilt& pole : poles) {
      if (pole.prior > kMostPrior) continue;
      const double prior = pole.prior;
      const Eigen::Vector2d seen = (pole.tilt.cast<double>() - prior * before) / (1 - prior);
      const double variance = tiltSigma * tiltSigma * prior / (1 - prior) + kPole * kPole;
      const double off = (seen - common).squaredNorm() / (kOutlier * kOutlier * variance);
      const double weight = pole.weight / (variance * (1 + off * off));
      weights += weight;
      sum += weight * seen;
    }
    common = sum / weights;
  }
  return common.cast<float>();
}

Eigen::Vector2f shiftBy(const PoleTilt& pole, const Eigen::Vector2f& upright,
                        const Eigen::Vector2f& common) {
  return pole.prior * pole.step * (common - upright) + pole.gap * common;
}

}  // namespace polemcl
