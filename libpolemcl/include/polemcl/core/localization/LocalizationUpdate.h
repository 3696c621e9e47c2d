#pragma once
/// \file LocalizationUpdate.h
/// \brief What a scan brings: the pose, and what speaks against it.

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

enum class HealthState { ok, degraded, lost };

/// \brief Why the state is not `ok`: the first that applies in the table of share/doc/health.md.
enum class HealthReason {
  none,        ///< ok
  searching,   ///< lost: no pose is known yet
  elsewhere,   ///< lost: the poles of the last metres fit another place of the map
  mismatch,    ///< lost or degraded: too few of the observed poles stand on the map
  spread,      ///< lost or degraded: the pose is too uncertain, or too few particles tell it
  ambiguous,   ///< degraded: several places are about as likely
  converging,  ///< degraded: not yet confirmed since the start or since the last search
  timeGap,     ///< degraded: no scan for longer than `max_gap_s`, until 5 m of good matches
  noPoles,     ///< degraded: no pole was seen for 2 s or 20 m
  odometry,    ///< degraded: the poles contradict the odometry
  innovation,  ///< degraded: matched poles lie farther off than their covariances say, or others
               ///< fit another pose nearby together
};

/// \brief The words of the CSV and of the live view, in the order of the enumerators.
POLEMCL_EXPORT const char* name(HealthState state);
POLEMCL_EXPORT const char* name(HealthReason reason);

/// \brief The verdict with what it is made of.
struct Health {
  HealthState state = HealthState::lost;
  HealthReason reason = HealthReason::searching;
  double matchedShare = 0;  ///< of the window's observed poles, by confidence; 0 without any
  double seenShare = 0;     ///< poles a scan in the window, by confidence, as a share of the usual
  double innovation = 0;    ///< mean m² per degree of freedom of the window's matches; 1 expected
  double effectiveParticles = 0;
  double modeShare = 1;
  double spread = 0;         ///< standard deviation of the position along its worst axis, m
  double spreadHeading = 0;  ///< standard deviation of the heading, rad
};

/// \brief What the poles say about the odometry.
enum class OdometryVerdict {
  agrees,        ///< the poles support the odometry
  contradicted,  ///< they do not: the motion is the poles', or the last known speed's
  unknown        ///< too few poles to tell: the motion is the odometry's
};

/// \brief What is known of the errors of the odometry.
struct POLEMCL_EXPORT OdometryErrors {
  double scale = 0;  ///< true distance / odometry - 1
  double yaw = 0;    ///< true turn - odometry, rad per metre driven forwards
  /// Covariance of (scale, yaw).
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// \brief Report of the particle filter on one step.
struct StepReport {
  std::size_t poles = 0;      ///< number of observed poles
  std::size_t particles = 0;  ///< number before resampling
  double effectiveShare = 1;  ///< of the particles, after the update, before resampling
  int temperingStages = 0;    ///< resamplings in the update (see FilterOptions::tempering)
  bool resampled = false;     ///< whether resampling took place after the update
};

/// \brief Result of one scan.
struct LocalizationUpdate {
  double time = 0;                             ///< time of the scan, s
  std::optional<PoseWithCovariance> estimate;  ///< map frame; nullopt while the pose is unknown
  Health health;
  std::size_t poles = 0;  ///< poles observed in the scan
  /// Report of the filter, all zero without a pose. Its `poles` are those given to the filter.
  StepReport step;
  bool relocalized = false;  ///< the global search moved the filter to this pose in this step
  OdometryVerdict motion = OdometryVerdict::unknown;  ///< verdict of the odometry monitor
  OdometryErrors odometryErrors;                      ///< as estimated so far
};

}  // namespace polemcl
