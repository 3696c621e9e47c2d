#pragma once
/// \file JointAdjustment.h
/// \brief One least-squares problem (Dellaert and Kaess 2006) over the poses of drives, the poles
/// they saw, and scale error and yaw bias of each drive's odometry, solved with Ceres. Private to
/// the library.
///
/// Detections and positions from satellites have the loss of Geman and McClure, so that wrong ones
/// let go.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Squared Mahalanobis distance at which a detection or a position from satellites has a
/// quarter of its weight.
constexpr double kQuarterWeight = 9;

/// \brief One scan of a drive.
struct DrivenScan {
  Pose2D pose_map_robot;                     ///< where to start from
  std::vector<PoleDetection> poles_robot;    ///< seen from one place: deskewed
  std::optional<PoseWithCovariance> motion;  ///< since the scan before; none: another drive begins
};

/// \brief How far what was measured can be trusted.
struct AdjustmentTrust {
  double scaleSigma = 0.02;   ///< standard deviation of the scale error of an odometry, as a share
  double yawSigma = 0.00052;  ///< of its yaw bias, rad per metre driven forwards
  double decorrelation = 5;   ///< scans within this distance count as one, m
  double poleSigma = 0.02;    ///< of each detection along an axis, beyond its covariance, m
};

/// \brief What is adjusted.
struct AdjustedState {
  std::vector<Pose2D> poses;               ///< one a scan
  std::vector<Eigen::Vector2d> odometry;   ///< scale error and yaw bias (rad/m) of each drive
  std::vector<Eigen::Vector2d> poles;      ///< centres, m
  std::vector<Eigen::Vector2d> fixErrors;  ///< lasting ones of positions from satellites, m
  std::vector<Eigen::Vector2d> antennas;   ///< of each drive, frame of the robot, m
};

/// \brief A detection of a scan that is a pole.
struct PoleSighting {
  std::size_t scan = 0, detection = 0, pole = 0;
};

/// \brief A pole whose place is known, with a covariance.
struct PoleAnchor {
  std::size_t pole = 0;
  MapPole known;
};

/// \brief A pose that is known, with a covariance.
struct KnownPose {
  std::size_t scan = 0;
  PoseWithCovariance pose;
};

/// \brief What the poles say of the way from one scan to a later one.
struct PoseTie {
  std::size_t first = 0, second = 0;  ///< scans
  PoseWithCovariance motion;          ///< from the first to the second, frame of the first
};

/// \brief A position from satellites between a scan and the next one of its drive.
struct PositionFix {
  std::size_t scan = 0;
  double share = 0;                                    ///< of the way to the next scan, 0 to 1
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the antenna by the receiver, m
  double sigma = 0;       ///< along each axis, beyond the lasting error, m
  std::size_t error = 0;  ///< the lasting one, see AdjustedState::fixErrors
};

/// \brief A lasting error of a receiver: a Gauss-Markov process.
struct LastingError {
  double sigma = 0;        ///< along each axis, m
  double correlation = 0;  ///< with the one before; 0: another drive begins
};

/// \brief The antenna of a drive.
struct AntennaPlace {
  Eigen::Vector2d stated = Eigen::Vector2d::Zero();  ///< frame of the robot, m
  double sigma = 0;                                  ///< along each axis, m
};

/// \brief Positions from satellites.
struct FixFactors {
  std::vector<PositionFix> fixes;
  std::vector<LastingError> errors;
  std::vector<AntennaPlace> antennas;  ///< of each drive
  double widening = 1;                 ///< of the sigmas, while the poses are still bent
};

/// \brief What holds the state together, besides the motions of the scans.
struct AdjustmentFactors {
  std::vector<PoleSighting> sightings;
  std::vector<PoleAnchor> anchors;
  std::vector<PoseTie> ties;
  /// One at least of all drives that hang together, where no anchor says where they are.
  std::vector<KnownPose> known;
  FixFactors gnss;
};

/// \brief The number of the drive that each scan belongs to. A scan without a motion begins one.
std::vector<std::size_t> drivesOf(const std::vector<DrivenScan>& scans);

/// \brief The problem as it stands; all arguments must outlive it.
class JointAdjustment {
 public:
  JointAdjustment(const std::vector<DrivenScan>& scans, const AdjustmentTrust& trust,
                  const AdjustmentFactors& factors, AdjustedState& state);
  ~JointAdjustment();
  JointAdjustment(const JointAdjustment&) = delete;
  JointAdjustment& operator=(const JointAdjustment&) = delete;

  /// \brief Improves the state. \throws Error when nothing holds it.
  void solve(int iterations);
  /// \brief Covariance of the poses of these scans and between them, by x, y, yaw of each, m² to
  /// rad². \throws Error as solve().
  Eigen::MatrixXd poseCovariance(const std::vector<std::size_t>& scans) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
