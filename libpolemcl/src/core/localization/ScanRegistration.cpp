#include "core/localization/ScanRegistration.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/common/GreedyAssignment.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kAlikeReach = 0.4;     // of alike poles, m
constexpr double kAlikeShare = 0.5;     // least share of pairs that a shifted row finds again
constexpr int kPairingRounds = 5;       // of pairing and Gauss-Newton
constexpr std::size_t kMostPoles = 24;  // of each scan that a search takes, bounds its time

/// The poles of the second scan, in the frame of the first.
std::vector<MovedCentre> moveAll(const std::vector<PoleDetection>& poles, const Pose2D& motion,
                                 double sigma) {
  std::vector<MovedCentre> moved;
  moved.reserve(poles.size());
  for (const PoleDetection& pole : poles) {
    moved.push_back(movedCentre(motion, pole));
    moved.back().covariance += 2 * sigma * sigma * Eigen::Matrix2d::Identity();
  }
  return moved;
}

/// A pole of the first scan and a pole of the second; `distance` is the squared Mahalanobis one.
struct RegistrationPair : AssignedPair {
  Eigen::Vector2d error;        ///< of the second from the first
  Eigen::Matrix2d information;  ///< of the error
};

/// One to one, the nearest by Mahalanobis distance first.
std::vector<RegistrationPair> pairUp(const std::vector<PoleDetection>& before,
                                     const std::vector<MovedCentre>& after, double gate,
                                     double reach) {
  std::vector<RegistrationPair> all;
  for (std::size_t a = 0; a < after.size(); ++a)
    for (std::size_t b = 0; b < before.size(); ++b) {
      const Eigen::Vector2d error = after[a].centre - Eigen::Vector2d(before[b].x, before[b].y);
      if (!(error.squaredNorm() <= reach * reach)) continue;
      const Eigen::Matrix2d information = (after[a].covariance + before[b].covariance).inverse();
      const double squared = error.dot(information * error);
      if (squared <= gate * gate) all.push_back({{b, a, squared}, error, information});
    }
  return chooseClosest(std::move(all));
}

void judge(const std::vector<RegistrationPair>& pairs, double gate, ScanRegistration& result) {
  result.pairs = static_cast<int>(pairs.size());
  result.score = 0;
  for (const RegistrationPair& pair : pairs) result.score += 1 - pair.distance / (gate * gate);
}

/// One Gauss-Newton step over the pairs. \return Whether the pairs determine a motion.
bool solve(const std::vector<RegistrationPair>& pairs, const std::vector<MovedCentre>& moved,
           ScanRegistration& result) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double squared = 0;
  for (const RegistrationPair& pair : pairs) {
    Eigen::Matrix<double, 2, 3> jacobian;  // of the error by x, y, yaw
    const Eigen::Vector2d& arm = moved[pair.second].arm;
    jacobian << 1, 0, -arm.y(), 0, 1, arm.x();
    information += jacobian.transpose() * pair.information * jacobian;
    gradient += jacobian.transpose() * pair.information * pair.error;
    squared += pair.distance;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(information);
  if (pairs.size() < 2 || solver.info() != Eigen::Success || !(solver.rcond() > 1e-12))
    return false;
  const Eigen::Vector3d step = solver.solve(gradient);
  result.motion = {result.motion.x - step.x(), result.motion.y - step.y(),
                   wrapAngle(result.motion.yaw - step.z())};
  // Above 1 the detections are worse than they say.
  const double freedom = 2.0 * static_cast<double>(pairs.size()) - 3;
  result.covariance = std::max(1.0, squared / freedom) * information.inverse();
  return true;
}

std::vector<PoleDetection> surest(const std::vector<PoleDetection>& poles) {
  std::vector<PoleDetection> sorted = poles;
  if (sorted.size() <= kMostPoles) return sorted;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& l, const auto& r) { return l.confidence > r.confidence; });
  sorted.resize(kMostPoles);
  return sorted;
}

/// The motion that takes two poles of the second scan onto two of the first.
Pose2D motionOf(const PoleDetection& b0, const PoleDetection& b1, const PoleDetection& a0,
                const PoleDetection& a1) {
  Pose2D motion;
  motion.yaw =
      wrapAngle(std::atan2(b1.y - b0.y, b1.x - b0.x) - std::atan2(a1.y - a0.y, a1.x - a0.x));
  const double c = std::cos(motion.yaw), s = std::sin(motion.yaw);
  const double x = 0.5 * (a0.x + a1.x), y = 0.5 * (a0.y + a1.y);
  motion.x = 0.5 * (b0.x + b1.x) - (c * x - s * y);
  motion.y = 0.5 * (b0.y + b1.y) - (s * x + c * y);
  return motion;
}

double meanVariance(const PoleDetection& pole, double sigma) {
  return 0.5 * pole.covariance.trace() + sigma * sigma;
}

}  // namespace

RegistrationOptions searchLimits(double seconds) {
  constexpr double kMaxSpeed = 40, kMaxTurnRate = 1.5;  // m/s, rad/s
  RegistrationOptions options;
  options.maxMetres = kMaxSpeed * seconds;
  options.maxRadians = kMaxTurnRate * seconds + 0.05;
  return options;
}

ScanRegistration judgeMotion(const std::vector<PoleDetection>& before,
                             const std::vector<PoleDetection>& after, const Pose2D& motion,
                             const RegistrationOptions& options) {
  ScanRegistration result;
  result.motion = motion;
  judge(pairUp(before, moveAll(after, motion, options.sigma), options.gate, options.reach),
        options.gate, result);
  return result;
}

int countNear(const std::vector<PoleDetection>& before, const std::vector<PoleDetection>& after,
              const Pose2D& motion) {
  RegistrationOptions near;
  near.sigma = near.reach = kAlikeReach;
  return judgeMotion(before, after, motion, near).pairs;
}

bool isShiftedRow(const std::vector<PoleDetection>& before, const std::vector<PoleDetection>& after,
                  const ScanRegistration& found, const Pose2D& other) {
  // From where the other motion ends to where this one does, in the frame before.
  const Pose2D shift = compose(found.motion, relative(other, Pose2D()));
  if (std::hypot(shift.x, shift.y) < 2 * kAlikeReach) return false;  // each pole would find itself
  std::vector<PoleDetection> all = before;
  for (PoleDetection pole : after) {
    const Pose2D place = compose(found.motion, {pole.x, pole.y, 0});
    pole.x = place.x;
    pole.y = place.y;
    all.push_back(pole);
  }
  return countNear(all, all, shift) >= kAlikeShare * found.pairs;
}

ScanRegistration refineMotion(const std::vector<PoleDetection>& before,
                              const std::vector<PoleDetection>& after, const Pose2D& guess,
                              const RegistrationOptions& options) {
  ScanRegistration result;
  result.motion = guess;
  for (int round = 0; round < kPairingRounds; ++round) {
    // At first all that is within reach, whatever its covariance; at last the gate alone.
    const double open = std::pow(0.25, round);
    const double gate = round + 1 < kPairingRounds ? options.gate + 30 * open : options.gate;
    const auto moved = moveAll(after, result.motion, options.sigma);
    if (!solve(pairUp(before, moved, gate, options.reach), moved, result)) break;
  }
  judge(pairUp(before, moveAll(after, result.motion, options.sigma), options.gate, options.reach),
        options.gate, result);
  return result;
}

ScanRegistration searchMotion(const std::vector<PoleDetection>& allBefore,
                              const std::vector<PoleDetection>& allAfter, const Pose2D& centre,
                              const RegistrationOptions& options) {
  const auto before = surest(allBefore), after = surest(allAfter);
  ScanRegistration best;
  best.motion = centre;
  const auto consider = [&](std::size_t i, std::size_t j, std::size_t a, std::size_t b) {
    const Pose2D motion = motionOf(before[i], before[j], after[a], after[b]);
    if (std::abs(wrapAngle(motion.yaw - centre.yaw)) > options.maxRadians) return;
    if (std::hypot(motion.x - centre.x, motion.y - centre.y) > options.maxMetres) return;
    const ScanRegistration tried = judgeMotion(before, after, motion, options);
    if (tried.score > best.score) best = tried;
  };
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t j = i + 1; j < before.size(); ++j) {
      const double first = std::hypot(before[j].x - before[i].x, before[j].y - before[i].y);
      if (first < options.minBaseline) continue;
      const double variance =
          meanVariance(before[i], options.sigma) + meanVariance(before[j], options.sigma);
      for (std::size_t a = 0; a < after.size(); ++a)
        for (std::size_t b = a + 1; b < after.size(); ++b) {
          const double second = std::hypot(after[b].x - after[a].x, after[b].y - after[a].y);
          const double sigma = std::sqrt(variance + meanVariance(after[a], options.sigma) +
                                         meanVariance(after[b], options.sigma));
          if (std::abs(second - first) > options.gate * sigma) continue;
          consider(i, j, a, b);
          consider(i, j, b, a);
        }
    }
  if (best.pairs < 2) return best;
  RegistrationOptions near = options;
  near.reach = std::min(options.reach, 0.5);
  return refineMotion(allBefore, allAfter, best.motion, near);
}

}  // namespace polemcl
