#include "core/common/DetectionFusion.h"

#include <Eigen/LU>
#include <algorithm>

#include "core/common/GreedyAssignment.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kEllipse95 = 5.991;  ///< 95 % quantile of chi² with two degrees of freedom

/// A tenth of a millimetre: a zero covariance would give an infinite weight.
Eigen::Matrix2d informationOf(const PoleDetection& pole) {
  return (pole.covariance + 1e-8 * Eigen::Matrix2d::Identity()).inverse();
}

std::vector<PoleDetection> atStamp(std::vector<PoleDetection> poles, const Velocity& velocity) {
  deskew(poles, velocity);
  return poles;
}

PoleDetection fusedPole(const PoleDetection& a, const PoleDetection& b, const Velocity& velocity,
                        FusionAgreement& agreement) {
  const Eigen::Matrix2d Ia = informationOf(a), Ib = informationOf(b);
  const double share = Ib.trace() / (Ia.trace() + Ib.trace());  // of b
  const double time = a.timeOffset + share * (b.timeOffset - a.timeOffset);
  std::vector<PoleDetection> both{a, b};
  for (PoleDetection& pole : both) pole.timeOffset -= time;
  deskew(both, velocity);
  const Eigen::Matrix2d C = (Ia + Ib).inverse();
  const Eigen::Vector2d step = centreOf(both[1]) - centreOf(both[0]);
  const double squaredSigmas = step.dot(
      (both[0].covariance + both[1].covariance + 2e-8 * Eigen::Matrix2d::Identity()).inverse() *
      step);
  const Eigen::Vector2d centre = centreOf(both[0]) + C * Ib * step;
  PoleDetection fused = a;
  fused.x = centre.x();
  fused.y = centre.y();
  fused.covariance = symmetrized<2>(C) * std::max(1.0, squaredSigmas / kEllipse95);
  fused.radius = both[0].radius + share * (both[1].radius - both[0].radius);
  fused.bottom = std::min(a.bottom, b.bottom);
  fused.top = std::max(a.top, b.top);
  fused.confidence = std::max(a.confidence, b.confidence);
  fused.points = a.points + b.points;
  fused.timeOffset = time;
  fused.turnRate = 0;
  agreement += {1, step.squaredNorm(), squaredSigmas};
  return fused;
}

}  // namespace

void FusionAgreement::operator+=(const FusionAgreement& other) {
  poles += other.poles;
  squaredMetres += other.squaredMetres;
  squaredSigmas += other.squaredSigmas;
}

FusionAgreement fuseDetections(std::vector<PoleDetection>& fused,
                               const std::vector<PoleDetection>& more, const Velocity& velocity) {
  FusionAgreement agreement;
  std::vector<bool> isNew(more.size(), true);
  for (const AssignedPair& pair :
       greedyAssignment(centresOf(atStamp(fused, velocity)), centresOf(atStamp(more, velocity)),
                        samePoleRadius)) {
    fused[pair.first] = fusedPole(fused[pair.first], more[pair.second], velocity, agreement);
    isNew[pair.second] = false;
  }
  for (std::size_t i = 0; i < more.size(); ++i)
    if (isNew[i]) fused.push_back(more[i]);
  return agreement;
}

}  // namespace polemcl
