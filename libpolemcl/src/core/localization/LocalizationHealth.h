#pragma once
/// \file LocalizationHealth.h
/// \brief Whether the pose can be trusted: `ok`, `degraded` or `lost`, with the reason.

#include <cstddef>
#include <deque>
#include <map>
#include <vector>

#include <polemcl/core/localization/LocalizationUpdate.h>
#include <polemcl/export.h>
#include "core/common/PoseEstimate.h"
#include "core/localization/MapAssociation.h"
#include "core/localization/RivalPose.h"

namespace polemcl {

/// \brief What one update brings.
struct HealthInput {
  double time = 0;                 ///< s
  double metres = 0;               ///< driven since the update before
  std::vector<PoleMatch> matches;  ///< of this scan's poles at the estimate
  PoseWithCovariance estimate;
  double effectiveParticles = 0;  ///< number
  double modeShare = 1;           ///< of the weight of particles round the estimate, in [0, 1]
  bool odometryContradicted = false;
  RivalPose rival;  ///< of findRival()
  NearPoles near;   ///< of nearPoles(); all 0: whether the vehicle left the map is not asked
};

/// \brief Where an assumed pose comes from.
enum class PoseSource {
  given,      ///< a start, or one of several answers of a search: confirmed by matches over 5 m
  found,      ///< by a search that is sure of it: over 2 m
  foundNear,  ///< by such a search, near a pose that was believed: over 8 m, or 2 m where nearly
              ///< all poles match. What misled that pose, such as a moved LiDAR, may still be there
};

/// \brief Follows one run. Deterministic.
class POLEMCL_EXPORT HealthMonitor {
 public:
  /// \param maxGap A longer time between two scans degrades the pose, s.
  explicit HealthMonitor(double maxGap = 2) : m_maxGap(maxGap) {}

  /// \brief No pose is known: `lost`, `searching`.
  void reset();
  /// \brief A pose was assumed: forgets the scans before; `degraded`, `converging` until matches
  /// bear it out.
  void begin(PoseSource source = PoseSource::given);
  /// \brief One update more. Before begin(): stays `searching`.
  Health update(const HealthInput& input);
  /// \brief For one update: the constellation of the last metres lies elsewhere.
  void reportElsewhere() {
    m_health.state = HealthState::lost, m_health.reason = HealthReason::elsewhere;
  }
  const Health& health() const { return m_health; }
  /// \brief Whether the poles of the last scans speak for a wrong place as strongly as they can,
  /// also while the vehicle stands and the pose is not confirmed yet.
  bool isInFullDoubt() const;
  /// \brief Whether the map has hardly any pole where a confirmed pose says that the vehicle is.
  bool hasLeftMap() const { return m_leftMap; }

 private:
  struct Figures {
    double seen = 0, matched = 0, squared = 0, matches = 0;
    NearPoles near;
    /// Calls step(own, other) for each figure.
    template <class Step>
    void combine(const Figures& other, const Step& step);
  };
  /// Means of the scans from one viewpoint.
  struct Viewpoint : Figures {
    double driven = 0;
    int scans = 0;
  };
  /// Sums over the viewpoints of a window.
  struct Window : Figures {
    int viewpoints = 0;
    double matchedShare() const { return seen > 0 ? matched / seen : 0; }
  };
  void learnUsual();
  void remember(const HealthInput& input, double metres);
  void doubt(const Figures& scan, double metres);
  void doubtByRivals(const HealthInput& input);
  Window sumOver(double metres) const;
  double shareOfUsual(const Window& window) const;
  void sumUp();
  double metresToConfirm() const;
  void confirm(const HealthInput& input);
  void confirmReturn(const HealthInput& input);
  bool leftMap(const Window& window) const;
  void judge(const HealthInput& input);

  double m_maxGap;
  Health m_health;
  std::deque<Viewpoint> m_viewpoints;
  bool m_begun = false, m_confirmed = false;
  PoseSource m_source = PoseSource::given;  ///< foundNear only if the pose before was believed
  double m_driven = 0, m_time = 0;          ///< at the last update
  double m_usual = 0;      ///< poles a viewpoint, by confidence; the one under way does not count
  double m_usualOver = 0;  ///< distance that this mean is over, m
  bool m_isEnough = false, m_isEnoughLong = false;  ///< to judge the window; to be lost
  double m_longShare = 0;                           ///< of matched poles over the longer window
  bool m_leftMap = false;                           ///< see leftMap()
  double m_seenDriven = 0, m_seenTime = 0;          ///< when a pole was last seen
  double m_rivalDoubt = 0;  ///< by poles that fit another pose, see doubtByRivals()
  Pose2D m_lastRival;       ///< that pose, from the estimate
  /// Poles of the map that fit it, and the metres driven when each last did.
  std::map<std::size_t, double> m_rivalPoles;
  double m_doubt = 0;          ///< log-likelihood ratio of a wrong place, see doubt()
  double m_goodDriven = 0;     ///< metres with enough matches since begin()
  double m_gapUntil = 0;       ///< as many of them end a time gap
  double m_lostUntil = 0;      ///< as many of them confirm a pose that was lost
  bool m_isReturning = false;  ///< it was lost, and neither a search nor the poles confirm it yet
  /// Poles of the map that matched since then, and the metres driven when each last did.
  std::map<std::size_t, double> m_returnPoles;
};

}  // namespace polemcl
