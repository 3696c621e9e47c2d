#include "core/global_localization/PoseRefinement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr int kRefinements = 4;
constexpr double kMatchGate = 3;  ///< standard deviations
/// A match of a pole known worse than this counts for less, m: it could be had by chance.
constexpr double kSharpSigma = 0.3;

/// J·v, a quarter turn to the left.
Eigen::Vector2d turnedBy(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

}  // namespace

PoseRefinement::PoseRefinement(const PreparedMap& map, const Constellation& query,
                               const Pose2D& pose_local)
    : m_map(map), m_query(query), m_poseLocal(pose_local), m_claimed(map.index.tree().size(), 0) {}

bool PoseRefinement::run(const PoseCandidate& seed, GlobalHypothesis& out) {
  State state;
  state.pose = seed.pose_map_robot;
  matchSeed(seed, state);
  if (!solve(state)) return false;
  for (int round = 1; round < kRefinements; ++round) {
    matchGated(state);
    if (!solve(state)) return false;
  }
  judge(state, out);
  return true;
}

Eigen::Vector2d PoseRefinement::seenAt(const QueryPole& queryPole, const State& state) const {
  return Eigen::Vector2d(state.pose.x, state.pose.y) +
         rotationOf(state.pose.yaw) * (queryPole.centre + state.scale * queryPole.travel);
}

Eigen::Matrix2d PoseRefinement::uncertainty(const QueryPole& queryPole, std::size_t pole,
                                            const State& state) const {
  const Eigen::Matrix2d rotation = rotationOf(state.pose.yaw);
  const double sigma = m_map.options.sigma;
  return rotation * queryPole.covariance * rotation.transpose() +
         (sigma * sigma + m_map.index.variance(pole)) * Eigen::Matrix2d::Identity();
}

void PoseRefinement::matchSeed(const PoseCandidate& seed, const State& state) {
  const std::vector<QueryPole>& queryPoles = m_query.queryPoles();
  const PairTolerance tolerance(m_map, m_query, queryPoles[seed.first], queryPoles[seed.second]);
  m_matches.clear();
  for (std::uint32_t i = 0; i < m_query.reliable(); ++i) {
    const Eigen::Vector2d at = seenAt(queryPoles[i], state);
    const double t = tolerance.of(queryPoles[i]);
    const PointHit hit = m_map.index.grid().nearest(at.x(), at.y(), t * t);
    if (hit) m_matches.push_back({i, hit.index});
  }
}

void PoseRefinement::matchGated(const State& state) {
  const double most = m_map.options.maxTolerance;
  m_matches.clear();
  for (std::uint32_t i = 0; i < m_query.reliable(); ++i) {
    const QueryPole& queryPole = m_query.queryPoles()[i];
    const Eigen::Vector2d at = seenAt(queryPole, state);
    const PointHit hit = m_map.index.grid().nearest(at.x(), at.y(), most * most);
    if (!hit) continue;
    Eigen::Matrix<double, 2, 4> jacobian;
    const Eigen::Vector2d arm = at - Eigen::Vector2d(state.pose.x, state.pose.y);
    jacobian << Eigen::Matrix2d::Identity(), turnedBy(arm),
        rotationOf(state.pose.yaw) * queryPole.travel;
    const Eigen::Matrix2d S = uncertainty(queryPole, hit.index, state) +
                              jacobian * state.covariance * jacobian.transpose();
    const Eigen::Vector2d error = m_map.index.tree().point(hit.index) - at;
    if (error.dot(S.inverse() * error) <= kMatchGate * kMatchGate)
      m_matches.push_back({i, hit.index});
  }
}

/// One Gauss-Newton step on the matches, with the odometry's scale known beforehand to be near 0.
bool PoseRefinement::solve(State& state) const {
  if (m_matches.size() < 3) return false;
  Matrix4 normal = Matrix4::Zero();
  Vector4 right = Vector4::Zero();
  const double scaleSigma = std::max(m_query.scaleSigma(), 1e-6);
  normal(3, 3) = 1 / (scaleSigma * scaleSigma);
  right(3) = -state.scale * normal(3, 3);
  const Eigen::Matrix2d rotation = rotationOf(state.pose.yaw);
  double squared = 0;
  for (const Match& match : m_matches) {
    const QueryPole& queryPole = m_query.queryPoles()[match.queryPole];
    const Eigen::Vector2d at = seenAt(queryPole, state);
    Eigen::Matrix<double, 2, 4> jacobian;
    const Eigen::Vector2d arm = at - Eigen::Vector2d(state.pose.x, state.pose.y);
    jacobian << Eigen::Matrix2d::Identity(), turnedBy(arm), rotation * queryPole.travel;
    const Eigen::Matrix2d weight = uncertainty(queryPole, match.pole, state).inverse();
    const Eigen::Vector2d error = m_map.index.tree().point(match.pole) - at;
    normal += jacobian.transpose() * weight * jacobian;
    right += jacobian.transpose() * weight * error;
    squared += error.dot(weight * error);
  }
  const Eigen::LDLT<Matrix4> factors(normal);
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 0)) return false;
  const Vector4 step = factors.solve(right);
  state.covariance = factors.solve(Matrix4::Identity());
  if (!step.allFinite() || !state.covariance.allFinite()) return false;
  state.squaredResiduals = std::max(0.0, squared - step.dot(right));
  state.pose.x += step(0);
  state.pose.y += step(1);
  state.pose.yaw = wrapAngle(state.pose.yaw + step(2));
  state.scale += step(3);
  return true;
}

void PoseRefinement::judge(const State& state, GlobalHypothesis& out) {
  const double most = m_map.options.maxTolerance;
  const double sharp = kSharpSigma * kSharpSigma;
  newRound();
  out = {};
  for (const QueryPole& queryPole : m_query.queryPoles()) {
    const Eigen::Vector2d at = seenAt(queryPole, state);
    const PointHit hit = m_map.index.grid().nearest(at.x(), at.y(), most * most);
    if (!hit) continue;
    const Eigen::Matrix2d S = uncertainty(queryPole, hit.index, state);
    const Eigen::Vector2d error = m_map.index.tree().point(hit.index) - at;
    const double squared = error.dot(S.inverse() * error);
    // Reliable query poles come first, so none loses its map pole to a doubtful one.
    if (squared > kMatchGate * kMatchGate || !claim(hit.index) || queryPole.odds <= 0) continue;
    ++out.matched;
    const double sharpness = std::min(1.0, sharp / std::sqrt(S.determinant()));
    const double alike = m_map.likeness(queryPole.pole->radius, hit.index);
    out.logRatio += std::log1p(queryPole.odds * sharpness * alike * std::exp(-0.5 * squared));
  }
  out.unseen = countUnseen(state);
  // On old maps or maps with false poles, unseen poles must not outweigh the matches.
  const double doubt = -std::log1p(-m_map.options.seen) * out.unseen;
  out.logRatio -= std::min(doubt, 0.5 * out.logRatio);
  out.matchedShare = static_cast<double>(out.matched) / static_cast<double>(m_query.reliable());
  out.pose_map_robot = state.pose;
  out.pose_map_local = compose(state.pose, relative(m_poseLocal, Pose2D{}));
  out.scale = state.scale;
  const double freedom = 2 * static_cast<double>(m_matches.size()) - 3;
  const double inflation = std::max(1.0, state.squaredResiduals / freedom);
  out.covariance = inflation * state.covariance.topLeftCorner<3, 3>();
}

/// Number of map poles beside the path that no submap pole claimed in this round.
std::uint32_t PoseRefinement::countUnseen(const State& state) {
  std::uint32_t unseen = 0;
  const Eigen::Matrix2d rotation = rotationOf(state.pose.yaw);
  for (const Eigen::Vector2d& place : m_query.path()) {
    const Eigen::Vector2d at = Eigen::Vector2d(state.pose.x, state.pose.y) + rotation * place;
    m_map.index.tree().within(at.x(), at.y(), m_map.options.corridor, m_hits);
    for (const PointHit& hit : m_hits) unseen += claim(hit.index);
  }
  return unseen;
}

bool PoseRefinement::claim(std::uint32_t pole) {
  if (m_claimed[pole] == m_round) return false;
  m_claimed[pole] = m_round;
  return true;
}

}  // namespace polemcl
