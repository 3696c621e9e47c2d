#include "core/slam/PoleMotions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/common/Deskew.h"
#include "core/localization/ScanRegistration.h"

namespace polemcl {
namespace {

constexpr double kLongestCoast = 2;  // s without poles that tell the motion
constexpr int kMinPairsNear = 2;     // near the motion before; searched: kMinPairs
constexpr double kSigma = 0.05, kShare = 0.05, kTurnSigma = 0.01;  // m, of the way, rad
constexpr double kAcceleration = 3, kTurnAcceleration = 0.5;       // m/s², rad/s², while coasting
/// A motion of the odometry is wrong if another motion meets these conditions. It has at least this
/// number of pairs:
constexpr int kPairsAgainst = 4;
/// Its score is greater by this factor, so that poles seen for the first time do not decide:
constexpr double kClearly = 1.5;
/// It is a change of speed that a vehicle makes (kMostAcceleration), or has more pairs
/// (kSurePairs). Poles that stay where they are seen from the vehicle may move along with it. If it
/// stands, at least kStandingShare of the poles do, and it was slow enough to stop. It differs by
/// more than the odometry of a healthy vehicle errs: m and rad, and share of both; and by more than
/// three standard deviations that the odometry states, where these are small:
constexpr double kSlip = 0.3, kTurnSlip = 0.05, kSlipShare = 0.1;
constexpr double kStated = 3, kMostStated = 0.5, kMostTurnStated = 0.2;  // sigmas, m, rad
/// Share of these limits until odometry and poles agree again over a whole window:
constexpr double kDoubted = 1.0 / 3;
/// An odometry of which the poles tell a greater share anew, but not only a few motions, is of
/// another vehicle, in another frame or in other units.
constexpr double kMostRefuted = 0.3;
constexpr int kFewMotions = 10;
/// Greatest share of motions that the poles of a drive without odometry do not tell. Beyond, its
/// path is a guess.
constexpr double kMostUntold = 0.25;

/// Least share of the poles, if kSurePairs tell a change of speed that a vehicle makes: beyond a
/// gap others are seen.
constexpr double kShareBeyondGap = 0.25;

/// Poles as seen at the time of their scan.
std::vector<PoleDetection> stillPoles(const PoleScan& scan, const Velocity& velocity) {
  std::vector<PoleDetection> poles = scan.poles_robot;
  deskew(poles, velocity);
  return poles;
}

class MotionFiller {
 public:
  explicit MotionFiller(std::vector<PoleScan>& scans)
      : m_scans(scans), m_poses(scans.size()), m_spent(scans.size(), Eigen::Matrix3d::Zero()) {}

  FilledMotions run() {
    for (std::size_t i = 0; i < m_scans.size(); ++i) {
      const bool isTold = m_scans[i].motion.has_value();
      m_isTold.push_back(isTold);
      if (i > 0 && isTold) take(i);
      if (i > 0 && !isTold) fillMissing(i);
      m_poles.push_back(stillPoles(m_scans[i], m_velocity.value_or(Velocity())));
    }
    m_filled.motions = m_scans.empty() ? 0 : m_scans.size() - 1;
    m_filled.all = m_filled.byPoles + m_filled.coasted + m_filled.contradicted >= m_filled.motions;
    const auto most = kMostUntold * static_cast<double>(m_filled.motions);
    if (m_filled.all && static_cast<double>(m_filled.coasted) > most) refuseGuesses();
    return m_filled;
  }

 private:
  double secondsFrom(std::size_t before, std::size_t i) const {
    return m_scans[i].time - m_scans[before].time;
  }
  double secondsTo(std::size_t i) const { return secondsFrom(i - 1, i); }

  void move(std::size_t i, const PoseWithCovariance& motion) {
    m_scans[i].motion = motion;
    moveAsTold(i);
  }

  void moveAsTold(std::size_t i) {
    m_poses[i] = compose(m_poses[i - 1], m_scans[i].motion->mean);
    m_spent[i] = m_spent[i - 1] + m_scans[i].motion->covariance;
  }

  void fillMissing(std::size_t i) {
    if (fill(i)) {
      ++m_filled.byPoles;
    } else if (m_filled.coasted++ == 0) {
      m_filled.firstCoasted = m_scans[i].time;
    }
  }

  /// The first velocity is that of all motions before, too.
  void learnVelocity(std::size_t i, const Velocity& velocity) {
    for (std::size_t k = 1; k < i && !m_velocity; ++k) {
      const Pose2D motion = motionAfter(velocity, secondsTo(k));
      move(k, {motion, covarianceOf(motion, secondsTo(k))});
    }
    m_velocity = velocity;
  }

  enum class Verdict { open, borneOut, contradicted };
  struct Judgement {
    Verdict verdict = Verdict::open;
    Pose2D motion;  ///< by the poles
  };

  /// The scans that a scan is compared with, the latest first. A slip adds up over a second.
  std::vector<std::size_t> compared(std::size_t i) const {
    std::vector<std::size_t> result;
    for (const double lag : kLags) {
      std::size_t before = i - 1;
      while (before > 0 && secondsFrom(before - 1, i) <= lag * kComparedTime + 1e-6) --before;
      if (result.empty() || result.back() != before) result.push_back(before);
    }
    return result;
  }

  /// What poles of this scan and an earlier one say of the motion of the odometry. Another one is
  /// sought near it and near the motion that they told last, not farther off: alike poles would
  /// fit.
  Judgement judge(std::size_t before, std::size_t i) const {
    const double seconds = secondsFrom(before, i);
    const Pose2D told = relative(m_poses[before], m_poses[i]);
    const bool isSeen = m_seen && m_scans[before].time - m_seenTime <= kLongestCoast;
    const Velocity velocity = isSeen ? *m_seen : velocityOf(told, seconds);
    const std::vector<PoleDetection>& then = m_poles[before];
    const std::vector<PoleDetection> now = stillPoles(m_scans[i], velocity);
    ScanRegistration found = refineMotion(then, now, told, {});
    if (!isEnough(found, then, now, kPairsAgainst))
      found = isSeen ? refineMotion(then, now, motionAfter(velocity, seconds), {})
                     : searchMotion(then, now, {}, searchLimits(seconds));
    if (!isEnough(found, then, now, kPairsAgainst)) return {};
    if (!isSlip(told, found.motion, m_spent[i] - m_spent[before]))
      return {Verdict::borneOut, found.motion};
    const bool isClear = found.score > kClearly * judgeMotion(then, now, told, {}).score;
    if (!isClear || isShiftedRow(then, now, found, told)) return {};
    const Pose2D off =
        relative(isSeen ? motionAfter(velocity, seconds) : found.motion, found.motion);
    const bool isPossible =
        std::hypot(off.x, off.y) <= kSlip + kMostAcceleration * seconds * seconds;
    const bool isStanding = countNear(then, now, Pose2D()) >= found.pairs;
    const int least = isPossible ? kPairsAgainst : kSurePairs;
    if (!isEnough(found, then, now, least, isStanding ? kStandingShare : kMinShare)) return {};
    return {isStanding && !isPossible ? Verdict::open : Verdict::contradicted, found.motion};
  }

  bool isSlip(const Pose2D& told, const Pose2D& found, const Eigen::Matrix3d& stated) const {
    const Pose2D off = relative(found, told);
    const double metres = std::min(kStated * std::sqrt(stated(0, 0) + stated(1, 1)), kMostStated);
    const double turn = std::min(kStated * std::sqrt(stated(2, 2)), kMostTurnStated);
    const double share = m_isDoubted ? kDoubted : 1;
    const double way = std::hypot(found.x, found.y);
    return std::hypot(off.x, off.y) > share * (kSlip + kSlipShare * way) + metres ||
           std::abs(off.yaw) > share * (kTurnSlip + kSlipShare * std::abs(found.yaw)) + turn;
  }

  /// A motion of the odometry, unless the poles contradict it.
  void take(std::size_t i) {
    moveAsTold(i);
    Verdict verdict = Verdict::open;  // over the longest time
    for (const std::size_t before : compared(i)) {
      const Judgement judged = judge(before, i);
      verdict = judged.verdict;
      if (verdict == Verdict::contradicted) return replace(before, i, judged.motion);
      if (verdict == Verdict::borneOut) see(i, velocityOf(judged.motion, secondsFrom(before, i)));
    }
    if (verdict == Verdict::borneOut) m_isDoubted = false;
    if (verdict == Verdict::open && isDoubtful(i)) return distrust(i);
    learnVelocity(i, velocityOf(m_scans[i].motion->mean, secondsTo(i)));
    m_coasted = 0;
  }

  /// The poles, which contradicted this odometry, say nothing of its motion, and it is not the one
  /// that they told a moment ago.
  bool isDoubtful(std::size_t i) const {
    if (!m_isDoubted || !m_seen || m_scans[i].time - m_seenTime > kLongestCoast) return false;
    const PoseWithCovariance& told = *m_scans[i].motion;
    return isSlip(told.mean, motionAfter(*m_seen, secondsTo(i)), told.covariance);
  }

  void distrust(std::size_t i) {
    ++m_filled.contradicted;
    m_isTold[i] = false;
    fill(i);
  }

  void see(std::size_t i, const Velocity& velocity) {
    m_seen = velocity;
    m_seenTime = m_scans[i].time;
  }

  /// The poles tell the way from an earlier scan anew, so that it ends where they say.
  void replace(std::size_t before, std::size_t i, const Pose2D& found) {
    if (m_filled.contradicted == 0) m_filled.firstContradicted = m_scans[before + 1].time;
    m_isDoubted = true;
    m_coasted = 0;
    learnVelocity(before + 1, velocityOf(found, secondsFrom(before, i)));
    const Pose2D end = compose(m_poses[before], found);
    for (std::size_t k = before + 1; k <= i; ++k) {
      m_filled.contradicted += m_isTold[k];
      m_isTold[k] = false;
      if (k < i) fill(k);
    }
    const Pose2D last = relative(m_poses[i - 1], end);
    move(i, {last, covarianceOf(last, 0)});
    learnVelocity(i, velocityOf(last, secondsTo(i)));
    see(i, velocityOf(found, secondsFrom(before, i)));
  }

  /// \return Whether the poles told the motion; else the motion before goes on.
  bool fill(std::size_t i) {
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
      move(i, {motion, covarianceOf(motion, doubt)});
      m_coasted = 0;
      see(i, *m_velocity);
      return true;
    }
    m_coasted += seconds;
    m_filled.longestCoast = std::max(m_filled.longestCoast, m_coasted);
    if (m_coasted > kLongestCoast) refuse(i);
    move(i, {guess, covarianceOf(guess, m_coasted)});
    return false;
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
      if (before + 1 < i && seconds > kComparedTime) break;
      const auto found = align(m_poles[before], now, relative(m_poses[before], expected), seconds);
      if (found) return FoundPose{compose(m_poses[before], found->motion), found->pairs, before};
    }
    return std::nullopt;
  }

  std::optional<ScanRegistration> align(const std::vector<PoleDetection>& before,
                                        const std::vector<PoleDetection>& now, const Pose2D& guess,
                                        double seconds) const {
    ScanRegistration near;
    if (m_velocity) near = refineMotion(before, now, guess, {});
    if (isEnough(near, before, now, kMinPairsNear)) return near;
    const ScanRegistration found = searchMotion(before, now, guess, searchLimits(seconds));
    const Pose2D off = relative(guess, found.motion);
    const bool isPossible =
        m_velocity && std::hypot(off.x, off.y) <= kSlip + kAcceleration * seconds * seconds;
    if (isEnough(found, before, now, kMinPairs) ||
        (isPossible && found.score > kClearly * near.score &&
         isEnough(found, before, now, kSurePairs, kShareBeyondGap)))
      return found;
    return std::nullopt;
  }

  static bool isEnough(const ScanRegistration& found, const std::vector<PoleDetection>& before,
                       const std::vector<PoleDetection>& now, int pairs, double share = kMinShare) {
    const auto fewer = static_cast<double>(std::min(before.size(), now.size()));
    return found.pairs >= pairs && found.score >= share * fewer;
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

  [[noreturn]] void refuseGuesses() const {
    throw Error("without odometry, the poles do not tell " + std::to_string(m_filled.coasted) +
                " of its " + std::to_string(m_filled.motions) + " motions, the first before " +
                std::to_string(m_filled.firstCoasted) +
                " s: its path would be a guess; write odometry to the rawlog (pole-import "
                "--odometry), take scans closer together, or mend their order and times");
  }

  std::vector<PoleScan>& m_scans;
  std::vector<bool> m_isTold;                       ///< by the odometry, and not contradicted
  std::vector<Pose2D> m_poses;                      ///< in the frame of the first
  std::vector<Eigen::Matrix3d> m_spent;             ///< sums of the covariances of the motions
  std::vector<std::vector<PoleDetection>> m_poles;  ///< of each scan, when it was taken
  std::optional<Velocity> m_velocity;               ///< by the last motion that was told
  std::optional<Velocity> m_seen;                   ///< by the last motion that poles told
  double m_seenTime = 0;
  bool m_isDoubted = false;  ///< the odometry, since poles contradicted it
  double m_coasted = 0;      ///< s, since poles or odometry last told the motion
  FilledMotions m_filled;
};

}  // namespace

FilledMotions fillMotions(std::vector<PoleScan>& scans) {
  using Motions = std::vector<std::optional<PoseWithCovariance>>;
  const auto motions = [&] {
    Motions result;
    for (const PoleScan& scan : scans) result.push_back(scan.motion);
    return result;
  };
  const auto set = [&](const Motions& from) {
    for (std::size_t i = 0; i < scans.size(); ++i) scans[i].motion = from[i];
  };
  const Motions told = motions();
  const auto count = static_cast<double>(std::count_if(
      told.begin(), told.end(), [](const auto& motion) { return motion.has_value(); }));
  FilledMotions filled = MotionFiller(scans).run();
  if (static_cast<double>(filled.contradicted) <=
      std::max<double>(kMostRefuted * count, kFewMotions))
    return filled;
  const Motions mended = motions();
  try {
    set(Motions(scans.size()));
    FilledMotions alone = MotionFiller(scans).run();
    alone.refuted = true;
    alone.contradicted = filled.contradicted;
    alone.firstContradicted = filled.firstContradicted;
    return alone;
  } catch (const Error&) {  // too few poles in some place
    set(mended);
    return filled;
  }
}

}  // namespace polemcl
