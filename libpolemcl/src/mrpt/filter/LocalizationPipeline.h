#pragma once
/// \file LocalizationPipeline.h
/// \brief The complete localization behind one call per scan: particle filter, submap of the last
/// metres, global search, health, and fault detection for the odometry.

#include <memory>
#include <optional>
#include <vector>

#include <polemcl/core/localization/LocalizationUpdate.h>
#include <polemcl/export.h>
#include "core/common/Binder.h"
#include "core/common/Deskew.h"
#include "core/global_localization/GlobalLocalizer.h"
#include "core/localization/LocalMaps.h"
#include "core/localization/LocalSubmap.h"
#include "core/localization/LocalizationHealth.h"
#include "core/localization/OdometryCalibration.h"
#include "core/localization/OdometryMonitor.h"
#include "core/localization/WholeSteps.h"
#include "mrpt/filter/PoleParticleFilter.h"

namespace polemcl {

/// \brief When the filter gets detections.
enum class Cadence {
  scan,    ///< at every scan
  section  ///< at the end of each section, with the detections of its middle scan (authors'
           ///< program)
};

/// \brief Which detections the filter is given. `[tracking]` in INI files.
struct POLEMCL_EXPORT TrackingOptions {
  /// Detections of a pole are averaged in the odometry frame and used together. Errors of
  /// successive detections are alike, so each for itself would count too much. Scans farther apart
  /// than LocalizationPipeline::sparseMetres are used as they are.
  bool average = true;
  int minHits = 2;                  ///< poles seen in fewer scans are not used
  double every = 0.5;               ///< distance travelled until a pole is used again, m
  Cadence cadence = Cadence::scan;  ///< `section` needs `average` to be false
  LocalMapOptions localMaps;        ///< of Cadence::section
};

POLEMCL_EXPORT void bind(Binder& binder, TrackingOptions& options);  ///< `[tracking]`

/// \brief All settings of the chain.
struct POLEMCL_EXPORT LocalizationOptions {
  FilterOptions filter;
  TrackingOptions tracking;
  double maxGap =
      2;  ///< a longer time between two scans degrades the pose, s (`[health] max_gap_s`)
  bool recover = true;  ///< the map is searched when the vehicle is lost (`[search] recover`)
  /// Faults of the odometry are detected by the poles; their motion then replaces it
  /// (`[odometry_monitor] enabled`).
  bool monitorOdometry = true;
  /// Scale error and yaw bias of the odometry are estimated while driving
  /// (`[odometry_calibration] enabled`).
  bool calibrateOdometry = true;
};

POLEMCL_EXPORT void bind(Binder& binder, LocalizationOptions& options);  ///< their sections

/// \brief The map with the data for the global search, prepared once and shared by many runs.
///
/// A map is coarse if `weighted` counts its covariances and the median of its poles' standard
/// deviations (root of ½ tr Σ) is above `coarseness` times LikelihoodOptions::sigma: an inventory.
/// Its likelihood then gets this median for sigma. The error of a pole stays the same as long as
/// the pole is in view, so the pipeline counts detections in it by NewShares::all.
struct POLEMCL_EXPORT LocalizationMap {
  static constexpr double coarseness = 3;
  /// \throws Error on a map without poles.
  LocalizationMap(std::shared_ptr<const CPoleMap> poleMap);
  std::shared_ptr<const CPoleMap> poles;
  std::shared_ptr<const GlobalLocalizer> search;
  bool coarse = false;
};

/// \brief Localizes one drive. Results depend only on input and seed. Several objects may run in
/// parallel on one map.
class POLEMCL_EXPORT LocalizationPipeline {
 public:
  /// \throws Error on options out of range.
  LocalizationPipeline(LocalizationMap map, const LocalizationOptions& options, std::uint32_t seed);

  /// \brief Starts around a pose. \throws Error as PoleParticleFilter::start(). Also when the disc
  /// is farther than `maxStartDistance` from every pole of the map.
  void start(const StartOptions& start);
  /// \brief Starts without a pose: the global search finds it during the drive.
  /// \param area Where the robot is now; none: anywhere. Used until a pose is known.
  /// \throws Error when the area is not finite, or as far from the map as in start().
  void initializeGlobally(const std::optional<SearchArea>& area = std::nullopt);

  /// \brief Processes the next scan. The motion of the first frame is ignored.
  ///
  /// A motion over a gap of the scans may be beyond the limits of makeMotionAction(). Then the pose
  /// is forgotten, and the frame is a first one: the pose is searched for, or with
  /// `recover = false` lost until the next start.
  /// \throws Error as PoleParticleFilter::step(); the state is then unchanged.
  LocalizationUpdate step(const PoleScan& frame);

  static constexpr double maxStartDistance = 1000;  ///< m
  /// Standard deviation of the velocity during a first scan that does not state it, m/s.
  static constexpr double unknownSpeed = 5;
  /// Two scans farther apart than this have a gap between them, s.
  static constexpr double gapSeconds = 2;
  /// Above this distance between two scans their poles are not averaged, m.
  static constexpr double sparseMetres = 2;
  /// Poles are seen again over this distance: what chance matches say about the place is new only
  /// after it, m. See NewShares.
  static constexpr double decorrelationMetres = 10;
  /// Poles are used again when motions that are shorter than their own spread have spread the
  /// particles this far, at `leverMetres` from the vehicle, m: at rest, the odometry forgets.
  static constexpr double forgottenMetres = 0.05, leverMetres = 10;
  /// The same for all poles of a coarse map, m. Over longer distances the errors of its poles
  /// remain alike, but the odometry forgets what they said.
  static constexpr double coarseMetres = 6;
  /// A search result within these limits of the estimate counts as the same pose, m and rad.
  static constexpr double sameMetres = 0.5, sameRadians = 0.035;
  /// Re-initialize at the same pose anyway if the new pose matches at least this many more poles.
  static constexpr double betterPoles = 2;
  /// Above these standard deviations the particles may cover several places, m and rad.
  static constexpr double wideMetres = 0.3, wideRadians = 0.1;

  /// \name For drawing
  /// @{
  bool hasPose() const { return m_hasPose; }
  const PoleParticleFilter& filter() const { return m_filter; }  ///< particles only with a pose
  const LocalSubmap& submap() const { return m_submap; }
  const GlobalResult& lastSearch() const { return m_search; }  ///< empty before the first search
  std::size_t searches() const { return m_searches; }  ///< number of searches since the start
  /// \brief Associations of the last frame's poles at the estimate, in the order of the frame;
  /// empty without a pose.
  const std::vector<PoleMatch>& matches() const { return m_matches; }
  const LocalizationMap& map() const { return m_map; }
  /// @}

 private:
  void forgetPose();
  bool isCutOff(const PoleScan& frame) const;
  OdometryCalibration newCalibration() const;
  PoleScan calibrated(PoleScan frame) const;
  void calibrate(const PoseWithCovariance& motion, const LocalizationUpdate& update);
  PoleScan deskewed(PoleScan frame);
  PoleScan checkedMotion(const PoleScan& frame, LocalizationUpdate& update);
  std::vector<PoleDetection> polesForFilter(const Pose2D& motion, const Eigen::Matrix3d& covariance,
                                            const std::vector<PoleDetection>& poles_robot);
  NewShares newShares(double metres) const;
  void track(const PoleScan& frame, double metres, LocalizationUpdate& update);
  void doubtSubmap();
  void requireNearMap(double x, double y, double radius) const;
  bool searchIsDue() const;
  std::optional<SearchArea> searchArea() const;
  void search(const PoleScan& frame, LocalizationUpdate& update);
  bool isNear(const GlobalHypothesis& place, double metres, double radians) const;
  bool fitsBetter(const GlobalHypothesis& place, const PoleScan& frame) const;
  std::vector<PoleMatch> match(const PoleScan& frame, const PoseWithCovariance& pose) const;
  AssociationOptions association() const;
  void adopt(const PoleScan& frame, bool resolved, LocalizationUpdate& update);

  LocalizationMap m_map;
  LocalizationOptions m_options;
  PoleParticleFilter m_filter;
  LocalSubmap m_submap;              ///< for the global search
  std::optional<SearchArea> m_area;  ///< where m_submap began, until a pose is known
  LocalSubmap m_tracks;              ///< for the filter
  LocalMaps m_localMaps;             ///< for the filter with Cadence::section
  OdometryMonitor m_odometryMonitor;
  OdometryCalibration m_calibration;
  HealthMonitor m_monitor;
  WholeSteps m_steps;                      ///< of the motions, for m_meanVelocity
  std::optional<Velocity> m_meanVelocity;  ///< of the last step
  PoleScan m_tracked;                      ///< the last frame with the poles given to the filter
  GlobalResult m_search;
  std::vector<PoleMatch> m_matches;
  PoseWithCovariance m_estimate;
  bool m_hasPose = false, m_started = false, m_stepped = false;
  bool m_isCutOff = false;    ///< a pose was known and had to be forgotten
  double m_forgotten = 0;     ///< variance at rest since poles were used again, m²
  bool m_hadPoles = false;    ///< in an earlier frame
  bool m_isFirst = false;     ///< no frame before this one had poles
  bool m_mistrusted = false;  ///< the submap was restarted because poles did not match
  std::size_t m_searches = 0;
  double m_unseen = 0;      ///< distance since a pole was last matched, m
  double m_time = 0;        ///< time of the last frame, s
  double m_searchedAt = 0;  ///< distance travelled in the submap at the last search, m
  double m_searchTime = 0;  ///< time of the last search, s
};

}  // namespace polemcl
