#pragma once
/// \file Consistency.h
/// \brief Are poses as uncertain as their covariances say? Normalised errors and coverage.

#include <vector>

#include "core/common/PoseEstimate.h"

namespace polemcl {

/// \brief An estimate beside the truth, both in the map frame.
struct ConsistencySample {
  PoseWithCovariance estimate;
  Pose2D truth;
  double time = 0;       ///< s
  bool isFirst = false;  ///< something was left out before it, or it is the first of its run
};

/// \brief Figures over samples. Right, for Gaussian errors: 3, 2, 1 and 0.95.
struct ConsistencyScore {
  std::size_t samples = 0;
  double neesMean = 0;          ///< mean of eᵀC⁻¹e over x, y, yaw: 3 degrees of freedom
  double neesMedian = 0;        ///< of the same; 2.37 expected
  double neesPositionMean = 0;  ///< over x, y
  double neesHeadingMean = 0;   ///< over yaw
  double coverage95 = 0;        ///< share of samples whose 95 % position ellipse holds the truth
  double longestBeyond5 = 0;    ///< longest time beyond 5 sigma of the position without a break, s
  double errorBeyond5 = 0;      ///< greatest position error of such a sample, m; 0 without any
};

/// Square of the 95 % quantile of a two-dimensional Gaussian's Mahalanobis distance (χ², 2).
constexpr double chiSquare95of2 = 5.991464547107979;

/// \brief Error of the position in its own standard deviations (Mahalanobis distance).
/// \param estimate With a positive definite covariance. \param truth In the same frame.
double sigmasOfPosition(const PoseWithCovariance& estimate, const Pose2D& truth);

/// \brief Longest time between the first and the last of samples in a row for which something
/// holds.
class LongestTime {
 public:
  /// \param time s, of one sample after the other. \param isFirst It goes on from no other.
  void add(double time, bool holds, bool isFirst = false);
  double seconds() const { return m_longest; }

 private:
  bool m_holds = false;
  double m_begin = 0, m_longest = 0;
};

/// \brief Normalised estimation error squared (Bar-Shalom, Li, Kirubarajan 2001, 5.4.2).
/// \throws Error without samples, and naming the sample whose pose is not finite or whose
///         covariance is not symmetric positive definite.
ConsistencyScore scoreConsistency(const std::vector<ConsistencySample>& samples);

}  // namespace polemcl
