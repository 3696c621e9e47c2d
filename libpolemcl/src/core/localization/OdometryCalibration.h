#pragma once
/// \file OdometryCalibration.h
/// \brief Estimates scale error and yaw bias of the odometry while driving, and corrects them.
///
/// Over some metres, the motion between two poses in the map tells what the odometry should have
/// read. A Kalman filter keeps both errors as slowly varying states (random walks over the distance
/// travelled). Motions are corrected by its estimate, as far as an error is probable at all, and
/// its uncertainty is added to theirs: a wrong wheel radius is thus no surprise to the particle
/// filter. Errors common to successive motions add up, but a particle filter takes motions as
/// independent. The variance of each motion is therefore increased, so that the variance of their
/// sum is right: over 3 m, or over the whole way on which no pole is matched.

#include <Eigen/Core>
#include <deque>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/localization/LocalizationUpdate.h>
#include <polemcl/export.h>
#include "core/common/PoseEstimate.h"

namespace polemcl {

/// \brief A motion with the covariance of its error.
struct POLEMCL_EXPORT CorrectedMotion {
  Pose2D motion;               ///< m, rad, in the robot frame before the motion
  Eigen::Matrix3d covariance;  ///< m², m·rad, rad²
};

/// \brief Follows one drive. Deterministic.
class POLEMCL_EXPORT OdometryCalibration {
 public:
  /// At the start, standard deviations of the scale error, as a share, and of the yaw bias, rad/m.
  static constexpr double scaleSigma = 0.02, yawSigma = 0.00052;

  /// \param enabled false: the odometry is taken as it is.
  /// \param doubted true: the odometry may have no such errors, and what is corrected depends on
  /// how probable they are. false: the estimate is corrected as it is.
  explicit OdometryCalibration(bool enabled = true, bool doubted = true);

  /// \brief The motion without the errors known of, with their uncertainty in its covariance.
  /// \param motion, covariance As the odometry has them.
  CorrectedMotion correct(const Pose2D& motion, const Eigen::Matrix3d& covariance) const;
  /// \brief What is to be added to the covariance of a corrected motion while no pole is matched,
  /// so that the variance of the sum since then is right over any distance.
  /// \param unseen Distance since a pole was last matched, without this motion, m.
  Eigen::Matrix3d unseenCovariance(const Pose2D& motion, double unseen) const;
  /// \brief One scan more: the motion to it as the odometry has it, and the pose found there.
  /// \param estimate Map frame; null where it is not known or not to be trusted: comparisons then
  /// begin anew.
  void add(const Pose2D& motion, const Eigen::Matrix3d& covariance,
           const PoseWithCovariance* estimate);
  /// \brief What is corrected: the estimate, less as long as it may be zero.
  OdometryErrors errors() const;

 private:
  struct Step {
    Pose2D motion;
    Eigen::Matrix3d covariance;
  };
  void addRest(const Pose2D& motion, const Eigen::Matrix3d& covariance);
  Pose2D chain(double scale, double yaw) const;
  Eigen::Matrix3d walkedCovariance() const;
  Eigen::Vector3d innovation(const PoseWithCovariance& estimate, double scale, double yaw) const;
  void compare(const PoseWithCovariance& estimate);

  bool m_enabled;
  OdometryErrors m_errors;     ///< of the Kalman filter
  double m_leastLogOdds;       ///< of m_logOdds
  double m_logOdds;            ///< that there are such errors
  PoseWithCovariance m_begin;  ///< pose at which the steps begin
  std::deque<Step> m_steps;    ///< as the odometry has them
  double m_driven = 0;         ///< length of the steps, m
  bool m_begun = false;
};

}  // namespace polemcl
