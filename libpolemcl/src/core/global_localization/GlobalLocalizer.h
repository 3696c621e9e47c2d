#pragma once
/// \file GlobalLocalizer.h
/// \brief Finds a submap on the whole map, without a start pose.
///
/// The poles of a LocalSubmap are matched against the whole map: pairs of them by their distance
/// (geometric hashing, PairDistanceIndex), each candidate tried on its other poles and given up
/// early. The best are refined by least squares and judged on all poles: matched poles raise the
/// score, map poles beside the path that were never seen lower it. See share/doc/global.md.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include "core/localization/LocalSubmap.h"

namespace polemcl {

/// \brief Constants of the method; tests change some. Measured in share/reports/BENCHMARK.md.
struct POLEMCL_EXPORT GlobalOptions {
  int minHits = 2;  ///< poles of the submap with fewer hits are not used
  /// Probability that a true pole of the submap is on the map, in (0, 1).
  double mapped = 0.9;
  double sigma = 0.05;        ///< σ of a pole from its map pole, beyond both covariances, m
  double radiusSigma = 0.02;  ///< σ of a pole's radius from that of its map pole, m
  double maxTolerance = 1.0;  ///< greatest distance of a pole from its map pole, m
  double minBaseline = 8, maxBaseline = 40;  ///< of pole pairs that give a candidate, m
  double corridor = 15;  ///< map poles nearer than this to the path should have been seen, m
  double seen = 0.5;     ///< probability that such a pole is in the submap, in [0, 1)
  /// \name Verdict
  /// @{
  int minMatched = 6;         ///< least number of matched poles of an answer
  double minShare = 0.4;      ///< least share of the submap's poles that are matched, in [0, 1]
  double margin = 7;          ///< least lead in log-likelihood over every other place, nats
  double distinct = 2;        ///< places farther apart than this are different ones, m
  double distinctYaw = 0.17;  ///< places turned by more are different, rad
  /// @}
  int maxPairs = 40;           ///< greatest number of pole pairs that are looked up
  int maxCandidates = 100000;  ///< greatest number of places that are tried; bounds the time
  int maxRefined = 64;         ///< greatest number of places that are refined
  int maxHypotheses = 20;      ///< greatest number of places in an answer
};

/// \brief Where the robot was when the submap began; places that disagree are not tried.
struct POLEMCL_EXPORT SearchArea {
  Eigen::Vector2d centre_map = Eigen::Vector2d::Zero();  ///< m
  double radius = 0;                                     ///< m; grows with `drift`
  static constexpr double drift = 0.05;                  ///< of the distance driven since
};

/// \brief A place where the submap may lie.
struct POLEMCL_EXPORT GlobalHypothesis {
  Pose2D pose_map_robot;  ///< the robot now, m, rad
  Pose2D pose_map_local;  ///< the submap's local frame
  /// Covariance of pose_map_robot's (x, y, yaw), m², m·rad, rad²: of the least squares, scaled by
  /// its residuals where these are larger than expected.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  double scale =
      0;  ///< error of the odometry's scale: true length = (1 + scale)·length by odometry
  double logRatio = 0;        ///< log-likelihood ratio to a place without any match, nats
  double weight = 0;          ///< share of exp(logRatio) among the hypotheses handed out
  std::uint32_t matched = 0;  ///< map poles matched, each once
  double matchedShare = 0;    ///< of the submap's poles with `minHits`
  std::uint32_t unseen = 0;   ///< map poles beside the path that are not in the submap
};

enum class GlobalVerdict {
  resolved,   ///< the first hypothesis, clearly better than all other places
  ambiguous,  ///< several about as good: keep all, drive on
  none        ///< no place is good enough: too few poles, or not on this map
};

/// \brief Why the verdict is what it is.
enum class GlobalReason {
  clear,       ///< resolved
  rivals,      ///< ambiguous: another place is within the margin
  fewPoles,    ///< none: the submap has fewer than `minMatched` poles with `minHits`
  noPlace,     ///< none: no candidate survived
  fewMatched,  ///< none: the best has fewer than `minMatched`
  smallShare   ///< none: the best has less than `minShare`
};

struct GlobalResult {
  GlobalVerdict verdict = GlobalVerdict::none;
  GlobalReason reason = GlobalReason::fewPoles;
  std::vector<GlobalHypothesis> hypotheses;  ///< by falling logRatio; may be empty
  std::size_t poles = 0;                     ///< submap poles that took part
  std::size_t candidates = 0;                ///< places tried
};

struct PreparedMap;

/// \brief The map, prepared once. Const calls may run in parallel; the answer depends on nothing
/// but map, options and submap.
class POLEMCL_EXPORT GlobalLocalizer {
 public:
  /// \throws Error on a map pole whose centre or covariance is not finite.
  explicit GlobalLocalizer(const std::vector<MapPole>& map, const GlobalOptions& options = {});

  /// \param area None: the whole map.
  GlobalResult localize(const LocalSubmap& submap,
                        const std::optional<SearchArea>& area = std::nullopt) const;

 private:
  std::shared_ptr<const PreparedMap> m_map;  ///< never changed, so copies share it
};

}  // namespace polemcl
