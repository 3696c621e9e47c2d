#pragma once
/// \file Constellation.h
/// \brief A submap made ready for matching: its poles as seen from the robot now. Private to the
/// library; see GlobalLocalizer.h.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/global_localization/GlobalLocalizer.h"
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

}  // namespace polemcl
