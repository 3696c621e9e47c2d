#pragma once
/// \file ConstellationSearch.h
/// \brief A submap made ready for matching, and candidates for its place, from pairs of poles of
/// equal distance.
/// Private to the library; see GlobalLocalizer.h.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/global_localization/GlobalLocalizer.h"
#include "core/global_localization/PreparedMap.h"
#include "core/localization/LocalSubmap.h"

namespace polemcl {

/// \brief One pole of the submap, robot frame of now.
struct QueryPole {
  Eigen::Vector2d centre;      ///< m
  Eigen::Matrix2d covariance;  ///< as seen from now, without the error of scale, m²
  /// From the robot now to where it was when it last saw the pole, m: an error of scale s moves the
  /// pole by s·way.
  Eigen::Vector2d travel;
  double odds = 0;  ///< that it stands on the map; 0: too few hits, only marks map poles as seen
  const SubmapPole* pole = nullptr;
};

/// \brief The poles of a submap as seen from the robot now.
class Constellation {
 public:
  Constellation(const LocalSubmap& submap, const GlobalOptions& options,
                const std::optional<SearchArea>& area = std::nullopt);

  /// \brief Query poles with odds first, by falling odds; then the others.
  const std::vector<QueryPole>& queryPoles() const { return m_queryPoles; }
  std::size_t reliable() const { return m_reliable; }  ///< query poles with odds
  /// \brief Robot's places of the last metres, robot frame of now, a few metres apart, m.
  const std::vector<Eigen::Vector2d>& path() const { return m_path; }
  /// \brief Whether the submap began within the area, if the robot is at the pose now.
  bool beganInArea(const Pose2D& pose_map_robot) const;
  double scaleSigma() const { return m_scale; }
  /// \brief Variance along an axis of what two query poles' distance vector may be off by, m²: what
  /// each was measured with, and the odometry between them.
  double relativeVariance(const QueryPole& a, const QueryPole& b) const {
    return 0.5 * (a.pole->covariance.trace() + b.pole->covariance.trace()) + driftVariance(a, b);
  }
  /// \brief The odometry's part of it, m².
  double driftVariance(const QueryPole& a, const QueryPole& b) const;

 private:
  std::vector<QueryPole> m_queryPoles;
  std::size_t m_reliable = 0;
  std::vector<Eigen::Vector2d> m_path;
  std::optional<SearchArea> m_area;
  Eigen::Vector2d m_begin;  ///< robot frame of now, m
  double m_scale = 0;
};

/// \brief A place to be refined.
struct PoseCandidate {
  Pose2D pose_map_robot;
  std::uint32_t hits = 0;   ///< further query poles that found a map pole
  std::uint32_t first = 0;  ///< the pair of query poles it came from
  std::uint32_t second = 0;
};

/// \brief How far a query pole may lie from its map pole when the constellation is laid on two
/// poles.
struct PairTolerance {
  /// \brief For the pair of query poles (first, second). \throws nothing
  PairTolerance(const PreparedMap& map, const Constellation& query, const QueryPole& first,
                const QueryPole& second);
  double of(const QueryPole& queryPole) const;  ///< m, at most the greatest of the options

 private:
  const PreparedMap& m_map;
  const Constellation& m_query;
  const QueryPole &m_first, &m_second;
  Eigen::Vector2d m_middle;
  double m_variance, m_squaredLength;
};

/// \brief Searches the whole map.
class ConstellationSearch {
 public:
  ConstellationSearch(const PreparedMap& map, const Constellation& query);
  /// \brief The best seeds by falling hits, no two in the same cell of place and heading.
  std::vector<PoseCandidate> run();
  std::size_t candidates() const { return m_candidates; }

 private:
  struct QueryPair {
    double cost;  ///< candidates, dearer for short baselines
    std::uint32_t first, second;
    PairDistanceIndex::Range range;
  };
  std::vector<QueryPair> choosePairs() const;
  void tryPair(const QueryPair& pair);
  void tryPlace(const QueryPair& pair, const Eigen::Vector2d& first, const Eigen::Vector2d& second);
  std::vector<PoseCandidate> bestSeeds();

  /// A query pole to try a candidate on.
  struct Probe {
    double x, y, squaredTolerance;
  };
  const PreparedMap& m_map;
  const Constellation& m_query;
  std::vector<Probe> m_probes;  ///< the surest first
  std::vector<PoseCandidate> m_seeds;
  std::size_t m_candidates = 0;
};

}  // namespace polemcl
