#include "core/mapping/LandmarkFusion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/common/DetectionCheck.h"
#include "core/common/PoleIndex.h"
#include "core/common/Statistics.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kMedianOfTwo = 1.386;  ///< median of chi² with two degrees of freedom
constexpr double kEllipse99 = 9.21;     ///< its 99 % quantile

/// Added to variances, m².
constexpr double kLeastVariance = 1e-8;
/// A detection without any confidence counts so little that it changes nothing, but alone it has a
/// place.
constexpr double kLeastConfidence = 1e-9;

double weightOf(const PoleDetection& pole) {
  return std::max(pole.confidence, kLeastConfidence);
}

struct Weighted {
  std::uint32_t member;
  Eigen::Vector2d offset;       ///< from the first member: no digits are lost far from the origin
  Eigen::Matrix2d information;  ///< inverse covariance times confidence
};

std::vector<Weighted> weigh(const std::vector<LandmarkObservation>& observations,
                            const std::vector<std::uint32_t>& members,
                            const Eigen::Vector2d& origin) {
  std::vector<Weighted> weighted;
  weighted.reserve(members.size());
  for (const std::uint32_t member : members) {
    const PoleDetection& pole = observations[member].pole;
    // A tenth of a millimetre: a zero covariance would give an infinite weight.
    Eigen::Matrix2d covariance = pole.covariance + kLeastVariance * Eigen::Matrix2d::Identity();
    // In a far longer ellipse, rounding takes that away again.
    const double trace = covariance.trace();
    if (!(covariance.determinant() > 1e-9 * trace * trace))
      covariance += 1e-8 * trace * Eigen::Matrix2d::Identity();
    weighted.push_back(
        {member, Eigen::Vector2d(pole.x, pole.y) - origin, weightOf(pole) * covariance.inverse()});
  }
  return weighted;
}

/// Weighted median of each coordinate: outliers cannot move it far.
Eigen::Vector2d median(const std::vector<Weighted>& weighted) {
  Eigen::Vector2d result;
  std::vector<std::pair<double, double>> values(weighted.size());
  for (int axis = 0; axis < 2; ++axis) {
    double half = 0;
    for (std::size_t i = 0; i < weighted.size(); ++i) {
      values[i] = {weighted[i].offset[axis], weighted[i].information.trace()};
      half += 0.5 * values[i].second;
    }
    std::sort(values.begin(), values.end());
    std::size_t i = 0;
    for (double sum = values[0].second; sum < half && i + 1 < values.size();
         sum += values[i].second)
      ++i;
    result[axis] = values[i].first;
  }
  return result;
}

struct Mean {
  Eigen::Vector2d centre;
  Eigen::Matrix2d covariance;
};

Mean fusedMeanOf(const std::vector<Weighted>& weighted, const std::vector<bool>& inliers) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < weighted.size(); ++i) {
    if (!inliers[i]) continue;
    information += weighted[i].information;
    sum += weighted[i].information * weighted[i].offset;
  }
  const Eigen::Matrix2d covariance = information.inverse();
  return {covariance * sum, covariance};
}

std::vector<double> squaredDistances(const std::vector<Weighted>& weighted,
                                     const Eigen::Vector2d& centre) {
  std::vector<double> squared;
  squared.reserve(weighted.size());
  for (const Weighted& w : weighted) {
    const Eigen::Vector2d e = w.offset - centre;
    squared.push_back(e.dot(w.information * e));
  }
  return squared;
}

/// Who lies inside the 99 % ellipse. The median of the distances tells how much wider than promised
/// the ellipses really are (with the correction for few of them of Rousseeuw and Leroy 1987, as
/// that median varies much); they are never narrowed.
std::vector<bool> inside(const std::vector<double>& squared) {
  std::vector<double> ordered = squared;
  const double middle = elementOfRank(ordered, ordered.size() / 2);
  const double few = 1 + 5 / (2.0 * static_cast<double>(squared.size()) - 2);
  const double limit = kEllipse99 * std::max(1.0, few * few * middle / kMedianOfTwo);
  std::vector<bool> inliers(squared.size());
  for (std::size_t i = 0; i < squared.size(); ++i) inliers[i] = squared[i] <= limit;
  return inliers;
}

/// Scatter of the inliers divided by what their covariances promise, never below 1.
double excess(const std::vector<double>& squared, const std::vector<bool>& inliers) {
  double sum = 0, freedom = -2;
  for (std::size_t i = 0; i < squared.size(); ++i) {
    if (!inliers[i]) continue;
    sum += squared[i];
    freedom += 2;
  }
  return freedom > 0 ? std::max(1.0, sum / freedom) : 1.0;
}

}  // namespace

Eigen::Vector2d fusedCentre(const std::vector<LandmarkObservation>& observations,
                            const std::vector<std::uint32_t>& members, Eigen::Matrix2d* covariance,
                            std::vector<std::uint32_t>* inliers) {
  const PoleDetection& first = observations[members.front()].pole;
  const Eigen::Vector2d origin(first.x, first.y);
  const std::vector<Weighted> weighted = weigh(observations, members, origin);
  std::vector<bool> taken(weighted.size(), true);
  Mean mean = fusedMeanOf(weighted, taken);
  if (weighted.size() > 2) {  // with two it is unknown which is the outlier
    std::vector<bool> next = inside(squaredDistances(weighted, median(weighted)));
    for (int round = 0; round < 10 && next != taken; ++round) {
      taken = std::move(next);
      mean = fusedMeanOf(weighted, taken);
      next = inside(squaredDistances(weighted, mean.centre));
    }
  }
  if (covariance)
    *covariance = mean.covariance * excess(squaredDistances(weighted, mean.centre), taken);
  if (inliers) {
    inliers->clear();
    for (std::size_t i = 0; i < weighted.size(); ++i) {
      if (taken[i]) inliers->push_back(weighted[i].member);
    }
  }
  return origin + mean.centre;
}

MapPole fuse(const std::vector<LandmarkObservation>& observations,
             const std::vector<std::uint32_t>& members) {
  MapPole pole;
  std::vector<std::uint32_t> inliers;
  const Eigen::Vector2d centre = fusedCentre(observations, members, &pole.covariance, &inliers);
  pole.x = centre.x();
  pole.y = centre.y();
  pole.count = static_cast<std::uint32_t>(members.size());
  double weight = 0, radius = 0;
  for (const std::uint32_t member : inliers) {
    const PoleDetection& seen = observations[member].pole;
    const double w = weightOf(seen) / (seen.covariance.trace() + kLeastVariance);
    weight += w;
    radius += w * seen.radius;
  }
  pole.radius = radius / weight;
  std::vector<double> bottoms, tops;
  pole.confidence = 0;
  for (const std::uint32_t member : members) {
    bottoms.push_back(observations[member].pole.bottom);
    tops.push_back(observations[member].pole.top);
    pole.confidence += observations[member].pole.confidence;
  }
  pole.confidence /= static_cast<double>(members.size());  // last: so that all ones give one
  pole.bottom = nearestRank(std::move(bottoms), 0.1);
  pole.top = nearestRank(std::move(tops), 0.9);
  return pole;
}

LandmarkObservation landmarkObservation(const PoleDetection& pole, const Pose2D& pose,
                                        std::uint32_t scan, const PoseTrust& trust) {
  const auto [arm, centre, covariance] = movedCentre(pose, pole);
  const Eigen::Vector2d byHeading = trust.headingSigma * Eigen::Vector2d(-arm.y(), arm.x());
  LandmarkObservation observation{pole, scan};
  observation.pole.x = centre.x();
  observation.pole.y = centre.y();
  observation.pole.covariance = covariance + byHeading * byHeading.transpose() +
                                trust.sigma * trust.sigma * Eigen::Matrix2d::Identity();
  if (!trust.covariance.isZero(0)) {
    Eigen::Matrix<double, 2, 3> jacobian;
    jacobian << 1, 0, -arm.y(), 0, 1, arm.x();
    observation.pole.covariance +=
        symmetrized<2>(jacobian * trust.covariance * jacobian.transpose());
  }
  return observation;
}

void checkScan(const Pose2D& pose, const std::vector<PoleDetection>& poles,
               const std::string& where) {
  if (!std::isfinite(pose.x + pose.y + pose.yaw)) {
    throw Error("the pose of " + where + " is not finite; leave the scan out or correct its pose");
  }
  if (std::max(std::abs(pose.x), std::abs(pose.y)) > PoleIndex::farthest)
    throw Error("the pose of " + where +
                " is more than 1e9 m from the origin; leave the scan out or correct its pose");
  for (std::size_t i = 0; i < poles.size(); ++i)
    if (const char* fault = faultOf(poles[i]))
      throw Error("pole " + std::to_string(i) + " of " + where + " has " + fault +
                  "; extract the scan again");
}

}  // namespace polemcl
