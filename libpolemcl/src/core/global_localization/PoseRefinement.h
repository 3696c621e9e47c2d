#pragma once
/// \file PoseRefinement.h
/// \brief A candidate place made exact and judged on all poles. Private to the library; see
/// GlobalLocalizer.h.

#include "core/global_localization/ConstellationSearch.h"

namespace polemcl {

/// \brief Refines and judges one candidate after the other; keeps its memory between them.
class PoseRefinement {
 public:
  PoseRefinement(const PreparedMap& map, const Constellation& query, const Pose2D& pose_local);
  /// \return False when it fell apart: fewer than three matches, or no unique solution.
  bool run(const PoseCandidate& seed, GlobalHypothesis& out);

 private:
  using Vector4 = Eigen::Vector4d;
  using Matrix4 = Eigen::Matrix4d;
  struct Match {
    std::uint32_t queryPole, pole;
  };
  /// The place under refinement: x, y, yaw of the robot, and the odometry's error of scale.
  struct State {
    Pose2D pose;
    double scale = 0;
    Matrix4 covariance = Matrix4::Zero();
    double squaredResiduals = 0;  ///< Mahalanobis, summed over the matches
  };
  Eigen::Vector2d seenAt(const QueryPole& queryPole, const State& state) const;
  Eigen::Matrix2d uncertainty(const QueryPole& queryPole, std::size_t pole,
                              const State& state) const;
  void matchSeed(const PoseCandidate& seed, const State& state);
  void matchGated(const State& state);
  bool solve(State& state) const;
  void judge(const State& state, GlobalHypothesis& out);
  std::uint32_t countUnseen(const State& state);
  /// True for the first caller of a pole since the last newRound().
  bool claim(std::uint32_t pole);
  void newRound() { ++m_round; }

  const PreparedMap& m_map;
  const Constellation& m_query;
  Pose2D m_poseLocal;
  std::vector<Match> m_matches;
  std::vector<std::uint32_t> m_claimed;  ///< round in which each map pole was claimed
  std::uint32_t m_round = 0;
  std::vector<PointHit> m_hits;
};

}  // namespace polemcl
