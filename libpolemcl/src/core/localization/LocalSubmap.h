#pragma once
/// \file LocalSubmap.h
/// \brief The poles of the last metres of a drive in a local odometry frame: associated over the
/// scans, averaged, counted, forgotten with distance.
///
/// The local frame is the robot's at the first frame; dead reckoning carries it on, so what lies
/// far back has drifted. Each pole's covariance belongs to the moment it was last seen; what the
/// odometry may have added since is OdometryDrift, plus an error of scale common to all steps.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief Running sums over the steps of a drive; the difference of two states gives the
/// uncertainty added between them, to first order and in closed form.
///
/// A step that ends at p_k with position noise N_k and heading noise ω_k moves a place m that was
/// fixed before it, seen from after it, by -n_k - ω_k·J·(m - p_k) with J a quarter turn. Steps are
/// independent, so the covariances add up, and the sums of ω_k², ω_k²·p_k and ω_k²·p_k·p_kᵀ are all
/// that has to be kept of the way.
class POLEMCL_EXPORT OdometryDrift {
 public:
  /// \brief One step more.
  /// \param end Where the step ends, local frame, m.
  /// \param yaw Heading before the step, local frame, rad.
  /// \param covariance Covariance of the step's (x, y, yaw) in the robot frame before it,
  ///        m², m·rad, rad². Its correlations of position and heading are not used.
  void add(const Eigen::Vector2d& end, double yaw, const Eigen::Matrix3d& covariance);

  /// \brief Covariance of `place` (local frame, m), known exactly from the robot at the moment
  /// `then`, as seen from the robot `now`; m², along the axes of the local frame.
  /// \param then A state of the same drive, not later than `now`.
  static Eigen::Matrix2d between(const OdometryDrift& then, const OdometryDrift& now,
                                 const Eigen::Vector2d& place);

  /// \brief The state counted from a later one, with sums about another origin (local frame, m).
  /// between() gives the same for states that were all counted anew. Far from the origin, the
  /// differences of the sums would be lost in rounding.
  OdometryDrift countedFrom(const OdometryDrift& zero, const Eigen::Vector2d& origin) const;
  const Eigen::Vector2d& origin() const { return m_origin; }  ///< of the sums, local frame, m

 private:
  Eigen::Vector2d m_origin = Eigen::Vector2d::Zero();    ///< p_k are from here, m
  Eigen::Matrix2d m_position = Eigen::Matrix2d::Zero();  ///< Σ N_k, m²
  double m_heading = 0;                                  ///< Σ ω_k², rad²
  Eigen::Vector2d m_first = Eigen::Vector2d::Zero();     ///< Σ ω_k² p_k
  Eigen::Matrix2d m_second = Eigen::Matrix2d::Zero();    ///< Σ ω_k² p_k p_kᵀ
};

/// \brief Constants of the method; tests change some.
struct POLEMCL_EXPORT SubmapOptions {
  double length = 60;  ///< poles not seen over this distance travelled are dropped, m
  double gate = 3.5;   ///< greatest Mahalanobis distance of a detection from its pole
  /// Standard deviation of the error that all detections of a pole share and that does not average
  /// out, m. Added to each detection's; a pole's never falls below it.
  double floor = 0.01;
  double viewRange = 25;  ///< a pole nearer than this that is not detected is a missed chance, m
  /// A pole with ten chances or more that was seen in a smaller share is dropped, unless it has
  /// `sureHits`. In [0, 1].
  double minShare = 0.15;
  int sureHits = 6;  ///< a pole with this number of hits is dropped by distance only
  /// \name Odometry without a covariance
  /// @{
  double positionWalk = 0.02;   ///< σ of position after a metre; grows with √distance, m/√m
  double headingWalk = 0.0007;  ///< σ of heading after a metre, rad/√m
  double turnWalk = 0.01;  ///< σ of heading after a radian turned; grows with √angle, rad/√rad
  /// @}
  double scale = 0.01;  ///< σ of the scale error that all steps of the odometry share
};

/// \brief Covariance of (x, y, yaw) of a motion by the walks of the options, m², m·rad, rad².
/// \param motion In the robot frame before it.
POLEMCL_EXPORT Eigen::Matrix3d walkCovariance(const Pose2D& motion, const SubmapOptions& options);

/// \brief One pole of the submap, local frame.
struct POLEMCL_EXPORT SubmapPole {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m
  /// Covariance of the centre, m², axes of the local frame, as seen from the robot when the pole
  /// was last detected.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  double radius = 0;          ///< mean of the detections, m
  double bottom = 0;          ///< lowest seen, m above local ground
  double top = 0;             ///< highest seen, m above local ground
  double confidence = 0;      ///< mean of the detections, in [0, 1]
  std::uint32_t hits = 0;     ///< frames that detected it
  std::uint32_t chances = 0;  ///< frames that detected it or had it within `viewRange`
  double takenAt = 0;         ///< metres driven when take() last gave it out
  bool taken = false;         ///< take() gave it out and it was not detected since
  /// \name When it was last detected
  /// @{
  Eigen::Vector2d seenFrom = Eigen::Vector2d::Zero();  ///< where the robot was, local frame, m
  double seenAt = 0;                                   ///< metres driven by then
  std::size_t seenFrame = 0;                           ///< number of frames by then
  OdometryDrift drift;                                 ///< what the odometry had gathered by then
  std::size_t detection = 0;                           ///< which one of that frame it was
  /// @}
  std::size_t number = 0;  ///< how many poles were opened before it
};

/// \brief Poles of the last metres. Deterministic; not to be shared between threads while adding.
class POLEMCL_EXPORT LocalSubmap {
 public:
  explicit LocalSubmap(const SubmapOptions& options = {});

  /// \brief One frame more: moves on, associates the detections one to one by ascending Mahalanobis
  /// distance, opens poles for the rest, drops what is far back or was hardly ever seen.
  /// \param motion Robot's motion since the frame before, in the robot frame before. It is
  ///        ignored for the first frame: the robot starts at the origin.
  /// \param poles_robot Detections of this frame, robot frame; may be empty. A confidence of 0
  ///        leaves one out.
  /// \throws Error on a motion that is not finite or a detection with a fault, see faultOf().
  ///         Nothing has changed then.
  void add(const Pose2D& motion, const std::vector<PoleDetection>& poles_robot);
  /// \brief The same with the motion's own covariance of (x, y, yaw), m², m·rad, rad², which takes
  /// the place of the walks in the options. \throws Error also when it is not symmetric positive
  /// semidefinite.
  void add(const Pose2D& motion, const Eigen::Matrix3d& covariance,
           const std::vector<PoleDetection>& poles_robot);
  /// \brief Forgets everything: the next frame is a first one.
  void clear();

  /// \brief In the order they were first seen.
  const std::vector<SubmapPole>& poles() const { return m_poles; }
  /// \brief The robot in the local frame, by dead reckoning.
  const Pose2D& pose() const { return m_pose; }
  double driven() const { return m_driven; }  ///< m, since the first frame
  std::size_t frames() const { return m_frames; }
  /// \brief Places of the robot over the last `length` metres, local frame, oldest first, a metre
  /// or more apart, the present one last.
  const std::vector<Eigen::Vector2d>& path() const { return m_path; }
  const OdometryDrift& drift() const { return m_drift; }
  const SubmapOptions& options() const { return m_options; }

  /// \brief Covariance of the pole's centre as seen from the robot now: its own plus the odometry's
  /// since it was last seen; m², axes of the local frame.
  /// \param withScale false: without the error of scale, for those who estimate it.
  Eigen::Matrix2d presentCovariance(const SubmapPole& pole, bool withScale = true) const;
  /// \brief The poles with at least `minHits` hits as the robot would detect them now: robot frame,
  /// covariance with the odometry's part, `points` the number of hits.
  std::vector<PoleDetection> detections(std::uint32_t minHits) const;

  /// \brief Gives each detection out once, averaged: the poles detected in the latest frame that
  /// have `minHits` and were not given out for `metres`, as the mean of their detections since
  /// then. Of two frames the one nearer to `metres` counts. Robot frame, covariance with `floor`,
  /// `points` the number of hits. Afterwards these poles begin anew: their place is that of the
  /// next detection.
  std::vector<PoleDetection> take(std::uint32_t minHits, double metres);

 private:
  PoleDetection seenNow(const SubmapPole& pole) const;
  void check(const std::vector<PoleDetection>& poles_robot) const;
  void move(const Pose2D& motion, const Eigen::Matrix3d& covariance);
  void countDriftFrom(const Eigen::Vector2d& here);
  void associate(const std::vector<PoleDetection>& poles_robot);
  void update(SubmapPole& pole, const PoleDetection& detection, const Eigen::Vector2d& centre,
              const Eigen::Matrix2d& covariance) const;
  void drop();

  SubmapOptions m_options;
  std::vector<SubmapPole> m_poles;
  Pose2D m_pose;
  double m_driven = 0;
  double m_step = 0;  ///< length of the last motion, m
  std::size_t m_frames = 0;
  std::size_t m_opened = 0;  ///< poles
  OdometryDrift m_drift;
  std::vector<Eigen::Vector2d> m_path;
  std::vector<double> m_pathDriven;  ///< metres driven at each place of m_path
};

}  // namespace polemcl
