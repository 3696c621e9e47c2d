#include "core/evaluation/MotionCheck.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace polemcl {
namespace {

constexpr int s_leastPairs = 3;           // fewer determine no motion that can be trusted
constexpr double s_farthest = 10;         // m, of a motion from the true one
constexpr double s_clearly = 1.5;         // times the score; three pairs often fit by chance
constexpr std::size_t s_every = 4;        // scans
constexpr std::size_t s_beside = 3;       // scans: farthest that confirm a step, on each side
constexpr double s_poseSigma = 0.02;      // m, as [map] pose_sigma_m
constexpr double s_headingSigma = 0.002;  // rad, as [map] heading_sigma_deg
constexpr double s_beyondChance = 16.27;  // 99.9 % of chi-squared with 3 degrees of freedom
// Least size of a step in the poses. Bad timing alone makes smaller errors over four scans.
constexpr double s_stepMetres = 0.3, s_stepTurn = 0.03;  // m, rad
// What tells how the LiDAR is mounted.
constexpr double s_mostTurn = 0.2;  // rad, within a stretch
constexpr std::size_t s_leastStretches = 5;
constexpr double s_aheadWeight = 2e-4;            // rad^2: it stands within 2 m of where it is said
constexpr double s_leastAside = 0.2, s_sure = 4;  // deg; standard errors: smaller ones are chance
// Other scans confirm a step if theirs differs by less, m and share. It differs a little, as poles
// were deskewed by the poses.
constexpr double s_sameStep = 0.15, s_sameShare = 0.25;

Eigen::Vector3d errorOf(const ScanRegistration& poles, const Pose2D& truth) {
  return {poles.motion.x - truth.x, poles.motion.y - truth.y,
          wrapAngle(poles.motion.yaw - truth.yaw)};
}

bool isBeyondChance(const ScanRegistration& poles, const Eigen::Vector3d& error) {
  Eigen::Matrix3d covariance = poles.covariance;
  covariance.diagonal() += 2 * Eigen::Vector3d(s_poseSigma * s_poseSigma, s_poseSigma * s_poseSigma,
                                               s_headingSigma * s_headingSigma);
  return error.dot(covariance.inverse() * error) > s_beyondChance;
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
           std::hypot(off.x, off.y) < s_sameStep + s_sameShare * std::hypot(step.x, step.y);
  };
  const std::size_t last = first + s_every;
  std::vector<Stretch> neighbours;
  const auto addIfTold = [&](std::size_t before, std::size_t after) {
    const Stretch other(scans[before], scans[after]);
    if (other.poles.pairs <= s_leastPairs) return false;
    neighbours.push_back(other);
    return true;
  };
  for (std::size_t k = 1; k <= std::min(s_beside, first); ++k)
    if (addIfTold(first - k, last)) break;
  for (std::size_t k = 1; k <= s_beside && last + k < scans.size(); ++k)
    if (addIfTold(first, last + k)) break;
  return !neighbours.empty() && std::all_of(neighbours.begin(), neighbours.end(), isSame);
}

}  // namespace

ScanRegistration motionOfPoles(const std::vector<PoleDetection>& before,
                               const std::vector<PoleDetection>& after, const Pose2D& truth) {
  RegistrationOptions options;
  options.maxMetres = s_farthest;
  ScanRegistration near = refineMotion(before, after, truth, options);
  if (2 * static_cast<std::size_t>(near.pairs) >= std::min(before.size(), after.size()))
    return near;
  const ScanRegistration far = searchMotion(before, after, truth, options);
  const bool isBetter = far.pairs > s_leastPairs && far.score > s_clearly * near.score;
  return isBetter && !isShiftedRow(before, after, far, truth) ? far : near;
}

bool contradictsClearly(const ScanRegistration& poles, const Pose2D& truth) {
  const Eigen::Vector3d error = errorOf(poles, truth);
  return poles.pairs > s_leastPairs &&
         (error.head<2>().norm() > s_stepMetres || std::abs(error.z()) > s_stepTurn) &&
         isBeyondChance(poles, error);
}

void MotionCheck::add(const ScanRegistration& poles, const Pose2D& truth, double time,
                      bool isConfirmed) {
  if (poles.pairs < s_leastPairs) return;
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
  if (way < s_stepMetres || std::abs(truth.yaw) > s_mostTurn || poles.pairs <= s_leastPairs) return;
  const double aside = (poles.motion.x * truth.y - poles.motion.y * truth.x) / way;
  const Eigen::Vector2d causes(way, truth.yaw);
  ++m_mounting.stretches;
  m_mounting.matrix += causes * causes.transpose();
  m_mounting.vector += causes * aside;
  m_mounting.square += aside * aside;
}

std::string MotionCheck::mountingDoubt() const {
  if (m_mounting.stretches < s_leastStretches) return "";
  Eigen::Matrix2d matrix = m_mounting.matrix;
  matrix(1, 1) += s_aheadWeight;
  const Eigen::Matrix2d covariance = matrix.inverse();
  const Eigen::Vector2d solution = covariance * m_mounting.vector;
  const double residual = std::max(0.0, m_mounting.square - solution.dot(m_mounting.vector));
  const double degrees = solution.x() * 180 / M_PI;
  const double sigma =
      std::sqrt(residual / static_cast<double>(m_mounting.stretches - 2) * covariance(0, 0)) * 180 /
      M_PI;
  if (std::abs(degrees) < std::max(s_leastAside, s_sure * sigma)) return "";
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
  for (std::size_t i = 0; i + s_every < scans.size(); i += s_every) {
    const Stretch stretch(scans[i], scans[i + s_every]);
    check.add(stretch.poles, stretch.truth, scans[i + s_every].time,
              !stretch.isStep() || isConfirmed(scans, i, stretch));
  }
  return check;
}

}  // namespace polemcl
