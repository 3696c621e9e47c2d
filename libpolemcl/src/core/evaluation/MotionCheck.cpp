#include "core/evaluation/MotionCheck.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace polemcl {
namespace {

constexpr int kLeastPairs = 3;               // fewer determine no motion that can be trusted
constexpr double kFarthestMotion = 10;       // m, of a motion from the true one
constexpr double kClearlyBetter = 1.5;       // times the score; three pairs often fit by chance
constexpr std::size_t kEvery = 4;            // scans
constexpr std::size_t kFarthestWitness = 3;  // scans: farthest that confirm a step, on each side
constexpr double kMapPoseSigma = 0.02;       // m, as [map] pose_sigma_m
constexpr double kMapHeadingSigma = 0.002;   // rad, as [map] heading_sigma_deg
constexpr double kBeyondChance = 16.27;      // 99.9 % of chi-squared with 3 degrees of freedom
// Least size of a step in the poses. Bad timing alone makes smaller errors over four scans.
constexpr double kStepMetres = 0.3, kStepTurn = 0.03;  // m, rad
// What tells how the LiDAR is mounted.
constexpr double kMostTurn = 0.2;  // rad, within a stretch
constexpr std::size_t kLeastStretches = 5;
constexpr double kAheadWeight = 2e-4;           // rad^2: it stands within 2 m of where it is said
constexpr double kLeastAside = 0.2, kSure = 4;  // deg; standard errors: smaller ones are chance
// Other scans confirm a step if theirs differs by less, m and share. It differs a little, as poles
// were deskewed by the poses.
constexpr double kSameStep = 0.15, kSameShare = 0.25;

Eigen::Vector3d errorOf(const ScanRegistration& poles, const Pose2D& truth) {
  return {poles.motion.x - truth.x, poles.motion.y - truth.y,
          wrapAngle(poles.motion.yaw - truth.yaw)};
}

bool isBeyondChance(const ScanRegistration& poles, const Eigen::Vector3d& error) {
  Eigen::Matrix3d covariance = poles.covariance;
  covariance.diagonal() +=
      2 * Eigen::Vector3d(kMapPoseSigma * kMapPoseSigma, kMapPoseSigma * kMapPoseSigma,
                          kMapHeadingSigma * kMapHeadingSigma);
  return error.dot(covariance.inverse() * error) > kBeyondChance;
}

std::string decimals(double value, int count) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(count) << value;
  return text.str();
}

/// Two scans, by their poles and by their poses.
struct Stretch {
  Stretch(const SessionScan& before, const SessionScan& after)
      : truth(relative(before.pose_map_robot, after.pose_map_robot)),
        poles(motionOfPoles(before.poles_robot, after.poles_robot, truth)) {}
  bool isStep() const { return contradictsClearly(poles, truth); }
  /// Where the poles have the second scan, as seen from where the poses have it.
  Pose2D step() const { return relative(truth, poles.motion); }
  Pose2D truth;
  ScanRegistration poles;
};

/// Whether stretches that begin earlier, or end later, have the same step. On each side the first
/// one decides of which the poles tell as much. One side must have it, none may be without.
bool isConfirmed(const std::vector<SessionScan>& scans, std::size_t first, const Stretch& found) {
  const Pose2D step = found.step();
  const auto isSame = [&](const Stretch& other) {
    const Pose2D off = relative(step, other.step());
    return other.isStep() &&
           std::hypot(off.x, off.y) < kSameStep + kSameShare * std::hypot(step.x, step.y);
  };
  const std::size_t last = first + kEvery;
  std::vector<Stretch> neighbours;
  const auto addIfTold = [&](std::size_t before, std::size_t after) {
    const Stretch other(scans[before], scans[after]);
    if (other.poles.pairs <= kLeastPairs) return false;
    neighbours.push_back(other);
    return true;
  };
  for (std::size_t k = 1; k <= std::min(kFarthestWitness, first); ++k)
    if (addIfTold(first - k, last)) break;
  for (std::size_t k = 1; k <= kFarthestWitness && last + k < scans.size(); ++k)
    if (addIfTold(first, last + k)) break;
  return !neighbours.empty() && std::all_of(neighbours.begin(), neighbours.end(), isSame);
}

}  // namespace

ScanRegistration motionOfPoles(const std::vector<PoleDetection>& before,
                               const std::vector<PoleDetection>& after, const Pose2D& truth) {
  RegistrationOptions options;
  options.maxMetres = kFarthestMotion;
  ScanRegistration near = refineMotion(before, after, truth, options);
  if (2 * static_cast<std::size_t>(near.pairs) >= std::min(before.size(), after.size()))
    return near;
  const ScanRegistration far = searchMotion(before, after, truth, options);
  const bool isBetter = far.pairs > kLeastPairs && far.score > kClearlyBetter * near.score;
  return isBetter && !isShiftedRow(before, after, far, truth) ? far : near;
}

bool contradictsClearly(const ScanRegistration& poles, const Pose2D& truth) {
  const Eigen::Vector3d error = errorOf(poles, truth);
  return poles.pairs > kLeastPairs &&
         (error.head<2>().norm() > kStepMetres || std::abs(error.z()) > kStepTurn) &&
         isBeyondChance(poles, error);
}

void MotionCheck::add(const ScanRegistration& poles, const Pose2D& truth, double time,
                      bool isConfirmed) {
  if (poles.pairs < kLeastPairs) return;
  ++m_told;
  const Eigen::Vector3d error = errorOf(poles, truth);
  addMounting(poles, truth);
  if (isBeyondChance(poles, error)) ++m_contradicting;
  if (!isConfirmed || !contradictsClearly(poles, truth)) return;
  ++m_steps;
  if (error.head<2>().norm() <= m_worstMetres) return;
  m_worstMetres = error.head<2>().norm();
  m_worstTime = time;
}

void MotionCheck::addMounting(const ScanRegistration& poles, const Pose2D& truth) {
  const double way = std::hypot(truth.x, truth.y);
  if (way < kStepMetres || std::abs(truth.yaw) > kMostTurn || poles.pairs <= kLeastPairs) return;
  const double aside = (poles.motion.x * truth.y - poles.motion.y * truth.x) / way;
  const Eigen::Vector2d causes(way, truth.yaw);
  ++m_mounting.stretches;
  m_mounting.matrix += causes * causes.transpose();
  m_mounting.vector += causes * aside;
  m_mounting.square += aside * aside;
}

std::string MotionCheck::mountingDoubt() const {
  if (m_mounting.stretches < kLeastStretches) return "";
  Eigen::Matrix2d matrix = m_mounting.matrix;
  matrix(1, 1) += kAheadWeight;
  const Eigen::Matrix2d covariance = matrix.inverse();
  const Eigen::Vector2d solution = covariance * m_mounting.vector;
  const double residual = std::max(0.0, m_mounting.square - solution.dot(m_mounting.vector));
  const double degrees = solution.x() * 180 / M_PI;
  const double sigma =
      std::sqrt(residual / static_cast<double>(m_mounting.stretches - 2) * covariance(0, 0)) * 180 /
      M_PI;
  if (std::abs(degrees) < std::max(kLeastAside, kSure * sigma)) return "";
  return "as the poles pass, the LiDAR points " + decimals(std::abs(degrees), 2) + "° (sigma " +
         decimals(sigma, 2) + "°) farther " + (degrees > 0 ? "left" : "right") +
         " than its pose on the vehicle says (--sensor-pose, [sensor] pose)";
}

std::string MotionCheck::verdict() const {
  if (m_told == 0)
    return "the poles do not tell whether these poses are right: too few are seen twice, or the "
           "poses are in another frame";
  const auto of = [this](std::size_t count) {
    return " (in " + std::to_string(count) + " of " + std::to_string(m_told) + " stretches)";
  };
  if (m_steps > 0 && 2 * m_contradicting <= m_told)
    return "the poles contradict these poses" + of(m_steps) + ", most before " +
           decimals(m_worstTime, 3) + " s, by " + decimals(m_worstMetres, 2) +
           " m: the poses have a step there";
  if (!contradicts()) {
    const char* part = 4 * m_contradicting > m_told ? "only a part of " : "";
    return std::string("the poles agree with ") + part + "these poses" +
           of(m_told - m_contradicting);
  }
  return "the poles contradict these poses: truth of another drive or in another frame, wrong "
         "time or wrong scan timing" +
         of(m_contradicting);
}

MotionCheck checkMotion(const std::vector<SessionScan>& scans) {
  MotionCheck check;
  for (std::size_t i = 0; i + kEvery < scans.size(); i += kEvery) {
    const Stretch stretch(scans[i], scans[i + kEvery]);
    check.add(stretch.poles, stretch.truth, scans[i + kEvery].time,
              !stretch.isStep() || isConfirmed(scans, i, stretch));
  }
  return check;
}

}  // namespace polemcl
