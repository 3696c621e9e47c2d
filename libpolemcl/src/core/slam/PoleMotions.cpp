#include "core/slam/PoleMotions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/common/Deskew.h"
#include "core/localization/ScanRegistration.h"

namespace polemcl {
namespace {

constexpr double kWindow = 1;                    // s, longest time over which scans are compared
constexpr double kLongestCoast = 2;              // s without poles that tell the motion
constexpr double kMaxSpeed = 40;                 // m/s
constexpr double kMaxTurnRate = 1.5;             // rad/s
constexpr int kMinPairsNear = 2, kMinPairs = 3;  // near the motion before; searched
constexpr double kMinShare = 0.4;                // of the poles of the scan with fewer, paired
constexpr double kSigma = 0.05, kShare = 0.05, kTurnSigma = 0.01;  // m, of the way, rad
constexpr double kAcceleration = 3, kTurnAcceleration = 0.5;       // m/s², rad/s², while coasting

/// Poles as seen at the time of their scan.
std::vector<PoleDetection> stillPoles(const PoleScan& scan, const Velocity& velocity) {
  std::vector<PoleDetection> poles = scan.poles_robot;
  deskew(poles, velocity);
  return poles;
}

class MotionFiller {
 public:
  explicit MotionFiller(std::vector<PoleScan>& scans) : m_scans(scans), m_poses(scans.size()) {}

  FilledMotions run() {
    for (std::size_t i = 0; i < m_scans.size(); ++i) {
      if (i > 0) {
        if (m_scans[i].motion) {
          learnVelocity(i, velocityOf(m_scans[i].motion->mean, secondsTo(i)));
          m_coasted = 0;
        } else {
          fill(i);
        }
        m_poses[i] = compose(m_poses[i - 1], m_scans[i].motion->mean);
      }
      m_poles.push_back(stillPoles(m_scans[i], m_velocity.value_or(Velocity())));
    }
    m_filled.all = m_filled.byPoles + m_filled.coasted + 1 >= m_scans.size();
    return m_filled;
  }

 private:
  double secondsTo(std::size_t i) const { return m_scans[i].time - m_scans[i - 1].time; }

  /// The first velocity is that of all motions before, too.
  void learnVelocity(std::size_t i, const Velocity& velocity) {
    for (std::size_t k = 1; k < i && !m_velocity; ++k) {
      const Pose2D motion = motionAfter(velocity, secondsTo(k));
      m_scans[k].motion = PoseWithCovariance{motion, covarianceOf(motion, secondsTo(k))};
      m_poses[k] = compose(m_poses[k - 1], motion);
    }
    m_velocity = velocity;
  }

  void fill(std::size_t i) {
    const double seconds = secondsTo(i);
    const Velocity velocity = m_velocity.value_or(Velocity());
    const Pose2D guess = motionAfter(velocity, seconds);
    if (const auto found = findPose(i, guess, stillPoles(m_scans[i], velocity))) {
      const Pose2D way = relative(m_poses[found->before], found->pose);
      const double since = m_scans[i].time - m_scans[found->before].time;
      const bool isFirst = !m_velocity;
      learnVelocity(i, velocityOf(way, since));
      const Pose2D motion =
          isFirst ? motionAfter(*m_velocity, seconds) : relative(m_poses[i - 1], found->pose);
      const double doubt = found->pairs < kMinPairs ? m_coasted + seconds : m_coasted;
      m_scans[i].motion = PoseWithCovariance{motion, covarianceOf(motion, doubt)};
      m_coasted = 0;
      ++m_filled.byPoles;
    } else {
      m_coasted += seconds;
      if (m_coasted > kLongestCoast) refuse(i);
      m_scans[i].motion = PoseWithCovariance{guess, covarianceOf(guess, m_coasted)};
      ++m_filled.coasted;
    }
  }

  struct FoundPose {
    Pose2D pose;  ///< in the frame of the first scan
    int pairs = 0;
    std::size_t before = 0;  ///< the scan that it was compared with
  };

  /// By the scan before, else by earlier ones.
  std::optional<FoundPose> findPose(std::size_t i, const Pose2D& guess,
                                    const std::vector<PoleDetection>& now) const {
    const Pose2D expected = compose(m_poses[i - 1], guess);
    for (std::size_t before = i; before-- > 0;) {
      const double seconds = m_scans[i].time - m_scans[before].time;
      if (before + 1 < i && seconds > kWindow) break;
      const auto found = align(m_poles[before], now, relative(m_poses[before], expected), seconds);
      if (found) return FoundPose{compose(m_poses[before], found->motion), found->pairs, before};
    }
    return std::nullopt;
  }

  std::optional<ScanRegistration> align(const std::vector<PoleDetection>& before,
                                        const std::vector<PoleDetection>& now, const Pose2D& guess,
                                        double seconds) const {
    const auto enough = [&](const ScanRegistration& found, int pairs) {
      const auto fewer = static_cast<double>(std::min(before.size(), now.size()));
      return found.pairs >= pairs && found.score >= kMinShare * fewer;
    };
    RegistrationOptions options;
    if (m_velocity) {
      const ScanRegistration near = refineMotion(before, now, guess, options);
      if (enough(near, kMinPairsNear)) return near;
    }
    options.maxMetres = kMaxSpeed * seconds;
    options.maxRadians = kMaxTurnRate * seconds + 0.05;
    const ScanRegistration found = searchMotion(before, now, guess, options);
    return enough(found, kMinPairs) ? std::optional(found) : std::nullopt;
  }

  static Eigen::Matrix3d covarianceOf(const Pose2D& motion, double coasted) {
    const double way = std::hypot(motion.x, motion.y);
    const double metres = kSigma + kShare * way + kAcceleration * coasted * coasted;
    const double turn = kTurnSigma + kTurnAcceleration * coasted * coasted;
    return Eigen::Vector3d(metres * metres, metres * metres, turn * turn).asDiagonal();
  }

  [[noreturn]] void refuse(std::size_t i) const {
    throw Error("no odometry leads to scan " + std::to_string(i) + " at " +
                std::to_string(m_scans[i].time) +
                " s, and the poles did not tell the motion for 2 s: three at least must be seen in "
                "two scans; write "
                "odometry to the rawlog, or cut the drive there");
  }

  std::vector<PoleScan>& m_scans;
  std::vector<Pose2D> m_poses;                      ///< in the frame of the first
  std::vector<std::vector<PoleDetection>> m_poles;  ///< of each scan, when it was taken
  std::optional<Velocity> m_velocity;               ///< by the last motion that was told
  double m_coasted = 0;  ///< s, since poles or odometry last told the motion
  FilledMotions m_filled;
};

}  // namespace

FilledMotions fillMotions(std::vector<PoleScan>& scans) {
  return MotionFiller(scans).run();
}

}  // namespace polemcl
