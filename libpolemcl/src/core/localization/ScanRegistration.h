#pragma once
/// \file ScanRegistration.h
/// \brief The rigid motion between two scans by the poles that both saw.

#include <Eigen/Core>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief Limits of an alignment.
struct RegistrationOptions {
  /// Standard deviation added to each detection along an axis, m: what its covariance leaves out.
  double sigma = 0.03;
  double gate = 3;           ///< greatest Mahalanobis distance of a pair
  double reach = 1;          ///< greatest distance of a pair at the first guess, m
  double maxMetres = 4;      ///< longest motion a search considers
  double maxRadians = 0.35;  ///< largest turn a search considers
  double minBaseline = 3;    ///< of the pole pairs that give a candidate, m
};

/// \name Limits by which poles judge the motions that the odometry states
/// @{
constexpr double kComparedTime = 1;      ///< longest time over which scans are compared, s
constexpr double kLags[] = {0, 0.3, 1};  ///< of this time: the scans compared with
constexpr int kMinPairs = 3;             ///< least number of poles in common that contradict
constexpr int kSurePairs = 5;            ///< pairs that decide, whatever the speed before
constexpr double kMinShare = 0.4;  ///< least share of the poles of the scan with fewer, paired
constexpr double kStandingShare = 0.75;  ///< least share that stands, where the vehicle does
constexpr double kMostAcceleration = 6;  ///< of a vehicle, m/s²
/// \brief Limits of a search over a time, by what a vehicle can do: 40 m/s, 1.5 rad/s.
RegistrationOptions searchLimits(double seconds);
/// @}

/// \brief A motion and the pairs of poles that bear it out.
struct POLEMCL_EXPORT ScanRegistration {
  /// Motion of the robot from the first scan to the second, in the first's robot frame.
  Pose2D motion;
  /// Covariance of (x, y, yaw), m², m·rad, rad²: that of the least squares, scaled by the residuals
  /// where these are larger than expected. Meaningless without 2 pairs.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  int pairs = 0;     ///< one to one, within the gate
  double score = 0;  ///< sum of 1 - m²/gate² of the pairs, m their Mahalanobis distances
};

/// \brief How well a motion fits, as it is. Nothing is estimated; the covariance stays as it was.
POLEMCL_EXPORT ScanRegistration judgeMotion(const std::vector<PoleDetection>& before,
                                            const std::vector<PoleDetection>& after,
                                            const Pose2D& motion,
                                            const RegistrationOptions& options);

/// \brief Number of poles that come to lie near others by this motion, within 0.4 m, whatever their
/// covariances.
int countNear(const std::vector<PoleDetection>& before, const std::vector<PoleDetection>& after,
              const Pose2D& motion);

/// \brief Whether a motion may be another one that a row of alike poles has shifted: as many as
/// half of its pairs find poles of the two scans again at the distance between the two motions.
/// Then both fit, and the poles do not tell which is right.
bool isShiftedRow(const std::vector<PoleDetection>& before, const std::vector<PoleDetection>& after,
                  const ScanRegistration& found, const Pose2D& other);

/// \brief Least squares over the pairs near a first guess (Gauss-Newton, paired again each time,
/// the reach narrowing from `reach` to the gate), weighted by the covariances.
POLEMCL_EXPORT ScanRegistration refineMotion(const std::vector<PoleDetection>& before,
                                             const std::vector<PoleDetection>& after,
                                             const Pose2D& guess,
                                             const RegistrationOptions& options);

/// \brief Without a guess: every two poles of one scan that lie as far apart as two of the other
/// give a candidate; the candidate that most other poles support is refined.
/// \param centre Candidates lie within `maxMetres` and `maxRadians` of it.
POLEMCL_EXPORT ScanRegistration searchMotion(const std::vector<PoleDetection>& before,
                                             const std::vector<PoleDetection>& after,
                                             const Pose2D& centre,
                                             const RegistrationOptions& options);

}  // namespace polemcl
