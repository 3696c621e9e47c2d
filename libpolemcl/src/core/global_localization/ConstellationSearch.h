#pragma once
/// \file ConstellationSearch.h
/// \brief Candidates for the place of a constellation, from pairs of poles of equal distance.
/// Private to the library; see GlobalLocalizer.h.

#include "core/global_localization/Constellation.h"
#include "core/global_localization/PreparedMap.h"

namespace polemcl {

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
