#pragma once
/// \file LocalizationHealth.h
/// \brief Whether the pose can be trusted: `ok`, `degraded` or `lost`, with the reason.

#include <cstddef>
#include <deque>
#include <vector>

#include <polemcl/core/common/Binder.h>
#include <polemcl/core/common/PoseEstimate.h>
#include <polemcl/core/localization/MapAssociation.h>
#include <polemcl/export.h>

namespace polemcl {

enum class HealthState { ok, degraded, lost };

/// \brief Why the state is not `ok`; the first that applies in this order.
enum class HealthReason {
  none,        ///< ok
  searching,   ///< lost: no pose is known yet
  elsewhere,   ///< lost: the poles of the last metres fit another place of the map
  mismatch,    ///< lost or degraded: too few of the observed poles stand on the map
  spread,      ///< lost or degraded: the pose is too uncertain
  ambiguous,   ///< degraded: several places are about as likely
  converging,  ///< degraded: not yet confirmed since the start or since the last search
  timeGap,     ///< degraded: no scan for longer than `maxGap`, until poles confirm the pose again
  noPoles,     ///< degraded: no pole was seen for `blindSeconds` or `blindMetres`
  odometry,    ///< degraded: the poles contradict the odometry
  innovation,  ///< degraded: matched poles lie farther off than their covariances say
};

/// \brief The words of the CSV and of the live view, in the order of the enumerators.
POLEMCL_EXPORT const char* name(HealthState state);
POLEMCL_EXPORT const char* name(HealthReason reason);

/// \brief `[health]` in INI files.
struct POLEMCL_EXPORT HealthOptions {
  /// Scans over this distance are judged together, m. Scans from one viewpoint count as one: a
  /// vehicle that stands beside something odd is not lost.
  double window = 8;
  /// Lost: scans over this longer distance agree, m. Where most poles are gone or new, few known
  /// poles are seen for some metres.
  double lostWindow = 18;
  /// Least number of sightings in a window that says anything: sum of the confidences of all poles
  /// from all viewpoints.
  double minSightings = 8;
  /// Lost: least number of poles a scan in the longer window, as a share of what is usual on this
  /// drive, so that it means the same for a LiDAR that sees 3 and for one that sees 28. Where the
  /// poles of the map are gone, the few new ones prove nothing.
  double lostSeen = 0.15;
  /// What is usual is the mean of scans whose poles match; it forgets over this distance, m.
  double usualWithin = 200;
  /// Lost: a smaller share of the observed poles is on the map. A pose that has gone wrong was
  /// known well before, so matches by chance are rare: 0.002 for 20 cm round each pole.
  double lostShare = 0.03;
  double degradedShare = 0.4;      ///< degraded: a smaller share of them is on the map
  double lostSpread = 5;           ///< lost: greater σ of the position along its worst axis, m
  double degradedSpread = 0.2;     ///< degraded: greater σ of the position, m
  double degradedHeading = 0.052;  ///< degraded: greater σ of the heading, rad
  double innovation = 4;    ///< degraded: greater mean m² per degree of freedom of matched poles
  double modeShare = 0.95;  ///< degraded: smaller share of the particles' weight at the estimate
  double blindSeconds = 2;  ///< degraded: no pole for a longer time, s
  double blindMetres = 20;  ///< degraded: no pole over a longer distance, m
  double maxGap = 2;        ///< degraded: a longer time between two scans, s
  double confirm = 5;       ///< distance with good matches until a new pose is `ok`, m
  double confirmFound = 2;  ///< the same for a pose found by a search, which its submap confirms, m
  /// Share of matched poles that confirms a new pose; particles drawn over metres find matches by
  /// chance. With less than 0.3 of it the pose is lost after 2 m.
  double confirmShare = 0.5;
  double confirmWithin = 15;  ///< lost: a new pose is not confirmed within this distance, m
};

POLEMCL_EXPORT void bind(Binder& binder, HealthOptions& options);  ///< `[health]`

/// \brief What one update brings.
struct HealthInput {
  double time = 0;                 ///< s
  double metres = 0;               ///< driven since the update before
  std::vector<PoleMatch> matches;  ///< of this scan's poles at the estimate
  PoseWithCovariance estimate;
  double effectiveParticles = 0;  ///< number
  double modeShare = 1;           ///< of the weight of particles round the estimate, in [0, 1]
  bool odometryContradicted = false;
};

/// \brief The verdict with what it is made of.
struct Health {
  HealthState state = HealthState::lost;
  HealthReason reason = HealthReason::searching;
  double matchedShare = 0;  ///< of the window's observed poles, by confidence; 0 without any
  double seenShare = 0;     ///< poles a scan in the window, by confidence, as a share of the usual
  double innovation = 0;    ///< mean m² per degree of freedom of the window's matches; 1 expected
  double effectiveParticles = 0;
  double modeShare = 1;
  double spread = 0;         ///< standard deviation of the position along its worst axis, m
  double spreadHeading = 0;  ///< standard deviation of the heading, rad
};

/// \brief Follows one run. Deterministic.
class POLEMCL_EXPORT HealthMonitor {
 public:
  /// \throws Error on options out of range.
  explicit HealthMonitor(const HealthOptions& options = {});

  /// \brief No pose is known: `lost`, `searching`.
  void reset();
  /// \brief A pose was assumed (a start, a search's answer): forgets the scans before; `degraded`,
  /// `converging` until matches over `confirm` metres support it.
  /// \param found By a search that is sure of it: `confirmFound` metres do.
  void begin(bool found = false);
  /// \brief One update more. Before begin(): stays `searching`.
  Health update(const HealthInput& input);
  /// \brief For one update: the constellation of the last metres lies elsewhere.
  void reportElsewhere() {
    m_health.state = HealthState::lost, m_health.reason = HealthReason::elsewhere;
  }
  const Health& health() const { return m_health; }
  const HealthOptions& options() const { return m_options; }

 private:
  /// Means of the scans from one viewpoint.
  struct Viewpoint {
    double driven = 0, seen = 0, matched = 0, squared = 0, matches = 0;
    int scans = 0;
  };
  /// Sums over the viewpoints of a window.
  struct Window {
    double seen = 0, matched = 0, squared = 0, matches = 0;
    int viewpoints = 0;
    double matchedShare() const { return seen > 0 ? matched / seen : 0; }
  };
  void learnUsual();
  void remember(const HealthInput& input);
  Window sumOver(double metres) const;
  double shareOfUsual(const Window& window) const;
  void sumUp();
  void confirm(const HealthInput& input);
  void judge(const HealthInput& input);

  HealthOptions m_options;
  Health m_health;
  std::deque<Viewpoint> m_viewpoints;
  bool m_begun = false, m_found = false, m_confirmed = false;
  double m_driven = 0, m_time = 0;  ///< at the last update
  double m_usual = 0;      ///< poles a viewpoint, by confidence; the one under way does not count
  double m_usualOver = 0;  ///< distance that this mean is over, m
  bool m_isEnough = false, m_isEnoughLong = false;  ///< to judge the window; to be lost
  double m_longShare = 0;                           ///< of matched poles over `lostWindow`
  double m_seenDriven = 0, m_seenTime = 0;          ///< when a pole was last seen
  double m_goodDriven = 0;                          ///< metres in a row with enough matches
  double m_gapUntil = -1;  ///< metres driven at which a time gap is forgotten
};

}  // namespace polemcl
