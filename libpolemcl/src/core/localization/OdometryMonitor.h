#pragma once
/// \file OdometryMonitor.h
/// \brief Detects faults of the odometry by the poles, and replaces its motion.
///
/// Each scan's poles are compared with those of a few scans before, up to a second back, where a
/// slip has added up. While poles and odometry agree, nothing is changed. An odometry that is
/// stuck, slips or jumps is contradicted when enough poles fit another motion, clearly better than
/// the odometry's, and that motion is outside what the odometry's covariance and a tolerance for
/// errors of its scale allow. Without such poles, a change of speed that no vehicle makes
/// contradicts it, for some seconds; so do poles of which none is seen again where it says, when by
/// the usual share of those seen again this has a chance of one in a thousand. Where the odometry
/// has not changed since poles were seen again, the poles have vanished: it is contradicted, but
/// its motion is used. Else the poles' motion, or the last speed, takes its place, until both agree
/// again for a while. See share/doc/health.md.

#include <Eigen/Core>
#include <cmath>
#include <deque>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/localization/LocalizationUpdate.h>
#include <polemcl/export.h>
#include "core/localization/ScanRegistration.h"
#include "core/localization/WholeSteps.h"

namespace polemcl {

/// \brief The motion to use for this step.
struct POLEMCL_EXPORT MonitoredMotion {
  OdometryVerdict verdict = OdometryVerdict::unknown;
  bool replaced = false;  ///< motion or covariance differ from the odometry's
  Pose2D motion;          ///< since the scan before, in the robot frame before; m, rad
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m², m·rad, rad²
  int pairs = 0;                                         ///< pairs of poles that support it
};

/// \brief Follows one drive. Deterministic.
class POLEMCL_EXPORT OdometryMonitor {
 public:
  /// \param enabled false: the odometry is always believed.
  explicit OdometryMonitor(bool enabled = true) : m_enabled(enabled) {}

  /// \brief One scan more. After a gap longer than the window, and for the first scan, there is
  /// nothing to compare with.
  /// \param time Time of the scan, s; scans that are not earlier are forgotten, so that one that
  /// was refused elsewhere can be given again. \param motion, covariance Odometry since the scan
  /// before; finite. \param poles_robot Detections, robot frame; those that are not finite or have
  /// no confidence are not used.
  MonitoredMotion add(double time, const Pose2D& motion, const Eigen::Matrix3d& covariance,
                      const std::vector<PoleDetection>& poles_robot);
  /// \brief Forgets all scans: the next is a first one.
  void clear();

 private:
  /// A scan to compare with. Chains of motions since the first scan: as the odometry has them, as
  /// they were handed out, and as the poles of successive scans have them.
  struct Reference {
    double time = 0;
    Pose2D odometry, used, seen;
    Eigen::Matrix3d spent = Eigen::Matrix3d::Zero();  ///< sum of the odometry's covariances
    std::vector<PoleDetection> poles;
    bool known = true;  ///< the poles confirmed the motion to it (while contradicted)
  };
  /// What the poles say about the motion since a reference.
  struct Finding {
    OdometryVerdict verdict = OdometryVerdict::unknown;
    ScanRegistration alignment;
  };
  enum class State {
    believed,     ///< the odometry is handed out
    suspected,    ///< the last scan contradicted it with few pairs; the next contradiction decides
    contradicted  ///< the motion of the poles, or the last known speed, is handed out
  };
  Finding compare(const Reference& reference, const Reference& now, bool search) const;
  ScanRegistration align(const Reference& reference, const Reference& now, bool search) const;
  static double beyondOdometry(const Reference& reference, const Reference& now,
                               const ScanRegistration& found);
  static ScanRegistration allowed(const Reference& reference, const Reference& now);
  static double beyondMotion(const Pose2D& motion, const Eigen::Matrix3d& spent,
                             const ScanRegistration& found);
  bool allowsLastSpeed(const Reference& reference, const Reference& now,
                       const ScanRegistration& found) const;
  bool isDistinct(const Reference& reference, const Reference& now, const ScanRegistration& found,
                  const ScanRegistration& stated) const;
  static bool suffices(const ScanRegistration& alignment, const Reference& reference,
                       const Reference& now);
  std::vector<std::size_t> chosen(double time) const;
  MonitoredMotion watch(Reference& now, const MonitoredMotion& odometry);
  MonitoredMotion contradict(Reference& now, const Reference& reference,
                             const ScanRegistration& alignment, const MonitoredMotion& odometry);
  MonitoredMotion replace(Reference& now, const MonitoredMotion& odometry);
  MonitoredMotion take(Reference& now, const Reference& reference,
                       const ScanRegistration& alignment);
  bool hasSettled(const Reference& now) const;
  Pose2D coast(double seconds) const;
  void learnSpeed(const Pose2D& motion, double seconds);
  MonitoredMotion coasted(Reference& now, const MonitoredMotion& odometry);
  bool isPossible(const Reference& now, const Pose2D& motion) const;
  void countSeenAgain(const Reference& now, const Pose2D& motion);
  bool hasChanged(const Pose2D& motion, double seconds) const;
  std::size_t keyScan() const;

  bool m_enabled;
  std::deque<Reference> m_past;
  State m_state = State::believed;
  WholeSteps m_steps;  ///< of the motions handed out, as the odometry has them
  Pose2D m_speed;      ///< of the last motion handed out, per second
  bool m_isSpeedKnown = false;
  /// Poles that could be seen again, and those that were; the start counts like a few scans.
  double m_counted = 20, m_seenAgain = 10;
  Pose2D m_speedSeen;   ///< the last one with a pole that was seen again; at first the first one
  double m_chance = 1;  ///< that no pole was seen again since the last one that was
  bool m_hasChanged = false;  ///< the odometry, when that chance became small
  /// When the odometry last was possible, or the poles agreed, s.
  double m_possibleTime = -INFINITY;
  double m_knownTime = 0;  ///< when the poles last told the motion, while contradicted, s
  /// Time of the scan that later scans are aligned with while contradicted, s. Several scans share
  /// one such scan: chains of every third scan would drift apart.
  double m_keyTime = 0;
};

}  // namespace polemcl
