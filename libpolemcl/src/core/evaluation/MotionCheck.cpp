#include "core/evaluation/MotionCheck.h"

#include <Eigen/LU>
#include <algorithm>

namespace polemcl {
namespace {

constexpr int s_leastPairs = 3;           // fewer determine no motion that can be trusted
constexpr double s_farthest = 10;         // m, of a motion from the true one
constexpr double s_clearly = 1.5;         // times the score; three pairs often fit by chance
constexpr std::size_t s_every = 4;        // scans
constexpr double s_poseSigma = 0.02;      // m, as [map] pose_sigma_m
constexpr double s_headingSigma = 0.002;  // rad, as [map] heading_sigma_deg
constexpr double s_beyondChance = 16.27;  // 99.9 % of chi-squared with 3 degrees of freedom

}  // namespace

ScanRegistration motionOfPoles(const std::vector<PoleDetection>& before,
                               const std::vector<PoleDetection>& after, const Pose2D& truth) {
  RegistrationOptions options;
  options.maxMetres = s_farthest;
  const ScanRegistration near = refineMotion(before, after, truth, options);
  if (2 * static_cast<std::size_t>(near.pairs) >= std::min(before.size(), after.size()))
    return near;
  const ScanRegistration far = searchMotion(before, after, truth, options);
  return far.pairs > s_leastPairs && far.score > s_clearly * near.score ? far : near;
}

void MotionCheck::add(const ScanRegistration& poles, const Pose2D& truth) {
  if (poles.pairs < s_leastPairs) return;
  ++m_told;
  const Eigen::Vector3d error(poles.motion.x - truth.x, poles.motion.y - truth.y,
                              wrapAngle(poles.motion.yaw - truth.yaw));
  Eigen::Matrix3d covariance = poles.covariance;
  covariance.diagonal() += 2 * Eigen::Vector3d(s_poseSigma * s_poseSigma, s_poseSigma * s_poseSigma,
                                               s_headingSigma * s_headingSigma);
  if (error.dot(covariance.inverse() * error) > s_beyondChance) ++m_contradicting;
}

std::string MotionCheck::verdict() const {
  if (m_told == 0)
    return "the poles do not tell whether these poses are right: too few are seen twice";
  const auto of = [this](std::size_t count) {
    return " (in " + std::to_string(count) + " of " + std::to_string(m_told) + " stretches)";
  };
  if (!contradicts()) return "the poles agree with these poses" + of(m_told - m_contradicting);
  return "the poles contradict these poses: truth of another drive, wrong time or wrong scan "
         "timing" +
         of(m_contradicting);
}

MotionCheck checkMotion(const std::vector<SessionScan>& scans) {
  MotionCheck check;
  for (std::size_t i = 0; i + s_every < scans.size(); i += s_every) {
    const SessionScan &before = scans[i], &after = scans[i + s_every];
    const Pose2D truth = relative(before.pose_map_robot, after.pose_map_robot);
    check.add(motionOfPoles(before.poles_robot, after.poles_robot, truth), truth);
  }
  return check;
}

}  // namespace polemcl
