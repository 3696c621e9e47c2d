#include "mrpt/filter/LocalizationPipeline.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/common/Binder.h"
#include "core/common/DetectionCheck.h"
#include "core/common/PoleIndex.h"
#include "core/common/Statistics.h"
#include "core/localization/PoseModes.h"
#include "mrpt/filter/MotionAction.h"

namespace polemcl {
namespace {

constexpr double kSearchEvery = 4;         // distance travelled between two searches, m
constexpr double kSearchEverySeconds = 5;  // time between two searches of a vehicle that stands, s
/// Distance travelled until an ambiguous answer is used, m; until then the next metres may tell.
constexpr double kPatience = 30;
constexpr int kSearchParticles = 4000;  // drawn round the places of an answer
/// An answer as near to the pose is a correction of it, m and rad.
constexpr double kNear = 2, kNearTurn = 0.2;

const LocalizationOptions& checked(const LocalizationOptions& options) {
  checkOptions(options);
  return options;
}

/// Converts a result of the search to a hypothesis of the filter.
PoseHypothesis toFilter(const GlobalHypothesis& place) {
  return {{place.pose_map_robot, place.covariance}, place.weight};
}

/// Velocity at the end of the last of two motions of constant acceleration.
Velocity extrapolated(const Velocity& before, const Velocity& last) {
  return {last.x + (last.x - before.x) / 2, last.y + (last.y - before.y) / 2,
          last.yaw + (last.yaw - before.yaw) / 2};
}

void requireFinite(const Pose2D& start) {
  if (std::isfinite(start.x) && std::isfinite(start.y) && std::isfinite(start.yaw)) return;
  std::ostringstream text;
  text << "the start pose x y yaw = " << start.x << ' ' << start.y << ' ' << start.yaw
       << " is not finite; position_m and yaw_deg in [start], or the pose given, must be numbers";
  throw Error(text.str());
}

void requireRadius(double radius) {
  if (!(radius >= 0 && std::isfinite(radius)))
    throw Error("the radius round the start, " + std::to_string(radius) +
                " m, must be a number of at least 0");
}

bool isWide(const Eigen::Matrix3d& covariance) {
  const double square = LocalizationPipeline::wideMetres * LocalizationPipeline::wideMetres;
  return covariance(0, 0) > square || covariance(1, 1) > square ||
         covariance(2, 2) > LocalizationPipeline::wideRadians * LocalizationPipeline::wideRadians;
}

/// Variance that a motion adds in the filter to where poles are seen, m².
double spreadBy(const Eigen::Matrix3d& motion, const FilterOptions& filter) {
  const double yaw = motion(2, 2) + filter.extraSigmaYaw * filter.extraSigmaYaw,
               lever = LocalizationPipeline::leverMetres;
  return std::max(motion(0, 0), motion(1, 1)) + filter.extraSigma * filter.extraSigma +
         lever * lever * yaw;
}

/// Median of the standard deviations of the poles' places along an axis, m.
double medianSigma(const std::vector<MapPole>& poles) {
  std::vector<double> sigmas;
  sigmas.reserve(poles.size());
  for (const MapPole& pole : poles) sigmas.push_back(std::sqrt(pole.covariance.trace() / 2));
  return elementOfRank(sigmas, sigmas.size() / 2);
}

}  // namespace

LocalizationMap::LocalizationMap(std::shared_ptr<const CPoleMap> poleMap)
    : poles(std::move(poleMap)) {
  if (!poles || poles->poles().empty())
    throw Error("the map has no poles: nothing can be localized in it");
  search = std::make_shared<GlobalLocalizer>(poles->poles());
  const LikelihoodOptions& likelihood = poles->likelihoodOptions;
  const double sigma = medianSigma(poles->poles());
  if (!likelihood.weighted || !(sigma > coarseness * likelihood.sigma)) return;
  const auto widened = std::make_shared<CPoleMap>(*poles);
  widened->likelihoodOptions.sigma = sigma;
  poles = widened;
  coarse = true;
}

LocalizationPipeline::LocalizationPipeline(LocalizationMap map, const LocalizationOptions& options,
                                           std::uint32_t seed)
    : m_map(std::move(map)),
      m_options(checked(options)),
      m_filter(m_map.poles, options.filter, seed),
      m_localMaps(options.tracking.localMaps),
      m_odometryMonitor(options.monitorOdometry),
      m_calibration(newCalibration()),
      m_monitor(options.maxGap) {}

void LocalizationPipeline::start(const StartOptions& start) {
  if (start.pose) {
    requireFinite(*start.pose);
    requireRadius(start.radius);
    requireNearMap(start.pose->x, start.pose->y, start.radius);
  }
  m_filter.start(start);
  initializeGlobally();
  m_hasPose = true;
  m_monitor.begin();
}

void LocalizationPipeline::requireNearMap(double x, double y, double radius) const {
  const auto nearest = m_map.poles->index().nearest(x, y, INFINITY);
  const double distance = nearest ? nearest->distance - radius : INFINITY;
  if (distance <= maxStartDistance) return;
  std::ostringstream text;
  text << "the start at " << x << ' ' << y << " m lies " << distance
       << " m from the nearest pole of the map, allowed are " << maxStartDistance
       << " m: is it in the frame of this map?";
  throw Error(text.str());
}

void LocalizationPipeline::initializeGlobally(const std::optional<SearchArea>& area) {
  if (area) {
    requireFinite({area->centre_map.x(), area->centre_map.y(), 0});
    requireRadius(area->radius);
    requireNearMap(area->centre_map.x(), area->centre_map.y(), area->radius);
  }
  forgetPose();
  m_area = area;
  m_calibration = newCalibration();
  m_searches = 0;
  m_started = true;
  m_isCutOff = false;
}

/// The next frame is a first one. What was learnt of the odometry stays.
void LocalizationPipeline::forgetPose() {
  m_isCutOff |= m_hasPose;
  m_area.reset();
  m_submap.clear();
  m_tracks.clear();
  m_localMaps.clear();
  m_odometryMonitor.clear();
  m_steps = {};
  m_meanVelocity.reset();
  m_monitor.reset();
  m_search = {};
  m_searchedAt = 0;
  m_matches.clear();
  m_unseen = 0;
  m_hasPose = m_stepped = m_hadPoles = m_mistrusted = false;
}

/// Whether there was a gap of the scans, and the odometry hardly says where the vehicle went in it.
bool LocalizationPipeline::isCutOff(const PoleScan& frame) const {
  if (!m_stepped || !frame.motion || !(frame.time - m_time > gapSeconds)) return false;
  return isBeyondLimits(*frame.motion) || isBeyondLimits(*calibrated(frame).motion);
}

LocalizationUpdate LocalizationPipeline::step(const PoleScan& seen) {
  if (!m_started)
    throw Error(
        "the localization has not been started: call start() or initializeGlobally() first");
  if (isCutOff(seen)) {
    requireStep(seen, std::nullopt);
    forgetPose();
  }
  // Both before anything changes: a correction makes a motion less certain.
  const auto before = m_stepped ? std::optional(m_time) : std::nullopt;
  requireStep(seen, before);
  const PoleScan corrected = calibrated(seen);
  requireStep(corrected, before);
  LocalizationUpdate update;
  update.time = seen.time;
  const PoleScan frame = checkedMotion(deskewed(corrected), update);
  const Pose2D motion = m_stepped ? frame.motion->mean : Pose2D();
  const double metres = std::hypot(motion.x, motion.y);
  Eigen::Matrix3d covariance = walkCovariance(motion, m_submap.options());
  if (m_stepped) covariance += frame.motion->covariance;
  m_submap.add(motion, covariance, frame.poles_robot);
  m_tracked = frame;
  const double spread = m_stepped ? spreadBy(frame.motion->covariance, m_options.filter) : 0;
  if (metres * metres < spread) m_forgotten += spread;
  m_isFirst = !m_hadPoles;
  m_hadPoles |= !frame.poles_robot.empty();
  m_tracked.poles_robot = polesForFilter(motion, covariance, frame.poles_robot);
  if (m_stepped && update.motion != OdometryVerdict::contradicted)
    m_tracked.motion->covariance += m_calibration.unseenCovariance(motion, m_unseen);

  update.poles = frame.poles_robot.size();
  if (m_hasPose) track(frame, metres, update);
  if (!m_stepped) m_searchTime = frame.time;
  m_stepped = true;
  m_time = frame.time;
  doubtSubmap();
  if (searchIsDue()) search(frame, update);
  update.health = m_monitor.health();
  if (before) calibrate(*seen.motion, update);
  update.odometryErrors = m_calibration.errors();
  return update;
}

/// The frame with its motion and velocity corrected for the known errors of the odometry.
PoleScan LocalizationPipeline::calibrated(PoleScan frame) const {
  if (frame.velocity) {
    const Pose2D second = motionAfter(*frame.velocity, 1);
    frame.velocity = velocityOf(m_calibration.correct(second, Eigen::Matrix3d::Zero()).motion, 1);
  }
  if (!m_stepped) return frame;
  const CorrectedMotion motion =
      m_calibration.correct(frame.motion->mean, frame.motion->covariance);
  frame.motion = PoseWithCovariance{motion.motion, motion.covariance};
  return frame;
}

/// On a coarse map, comparisons are too uncertain to tell whether the odometry errs.
OdometryCalibration LocalizationPipeline::newCalibration() const {
  return OdometryCalibration(m_options.calibrateOdometry, !m_map.coarse);
}

/// Learns the errors of the odometry while the pose is certain.
void LocalizationPipeline::calibrate(const PoseWithCovariance& motion,
                                     const LocalizationUpdate& update) {
  const bool certain = update.estimate && update.health.state == HealthState::ok &&
                       !update.relocalized && update.motion != OdometryVerdict::contradicted;
  m_calibration.add(motion.mean, motion.covariance, certain ? &*update.estimate : nullptr);
}

std::vector<PoleDetection> LocalizationPipeline::polesForFilter(
    const Pose2D& motion, const Eigen::Matrix3d& covariance,
    const std::vector<PoleDetection>& poles_robot) {
  const TrackingOptions& tracking = m_options.tracking;
  if (tracking.cadence == Cadence::section) return m_localMaps.add(motion, poles_robot);
  if (!tracking.average) return poles_robot;
  // Poles of a scan far from the one before had no chance to be seen twice.
  if (m_isFirst || std::hypot(motion.x, motion.y) > sparseMetres) m_tracks.clear();
  m_tracks.add(motion, covariance, poles_robot);
  // The first scan with poles is used as it is: there is nothing to average yet.
  if (m_tracks.frames() == 1) {
    m_forgotten = 0;
    return poles_robot;
  }
  const bool forgot = m_forgotten >= forgottenMetres * forgottenMetres;
  if (forgot) m_forgotten = 0;
  return m_tracks.take(static_cast<std::uint32_t>(tracking.minHits), forgot ? 0 : tracking.every);
}

/// The frame with its poles, not too many, as seen from the pose at its time stamp. Unless the
/// frame states it, the velocity is that of the motion to it, extrapolated by half of its change
/// since the motion before. Stamps close together tell none: then the velocity is the one before.
PoleScan LocalizationPipeline::deskewed(PoleScan frame) {
  std::optional<Velocity> velocity = frame.velocity;
  if (m_stepped) {
    const auto step = m_steps.add(frame.motion->mean, frame.time - m_time);
    const auto mean = step ? velocityOf(step->motion, step->seconds) : m_meanVelocity;
    if (!velocity) velocity = step && m_meanVelocity ? extrapolated(*m_meanVelocity, *mean) : mean;
    m_meanVelocity = mean;
  }
  keepMostConfident(frame.poles_robot);
  for (PoleDetection& pole : frame.poles_robot) {
    const double unknown = velocity ? 0 : unknownSpeed * pole.timeOffset;
    pole.covariance += unknown * unknown * Eigen::Matrix2d::Identity();
  }
  deskew(frame.poles_robot, velocity.value_or(Velocity()));
  return frame;
}

/// The frame; its motion is replaced if the poles contradict the odometry.
PoleScan LocalizationPipeline::checkedMotion(const PoleScan& frame, LocalizationUpdate& update) {
  const PoseWithCovariance odometry = m_stepped ? *frame.motion : PoseWithCovariance();
  const MonitoredMotion checked =
      m_odometryMonitor.add(frame.time, odometry.mean, odometry.covariance, frame.poles_robot);
  update.motion = checked.verdict;
  PoleScan result = frame;
  if (checked.replaced) result.motion = PoseWithCovariance{checked.motion, checked.covariance};
  return result;
}

NewShares LocalizationPipeline::newShares(double metres) const {
  NewShares shares;
  // No frame before the first one with poles said anything by chance.
  if (!m_isFirst) shares.chance = std::min(1.0, metres / decorrelationMetres);
  const double apart = m_options.tracking.average ? m_options.tracking.every : 0;
  if (m_map.coarse) shares.all = std::min(1.0, std::max(metres, apart) / coarseMetres);
  return shares;
}

void LocalizationPipeline::track(const PoleScan& frame, double metres, LocalizationUpdate& update) {
  PoseWithCovariance estimate = m_filter.step(m_tracked, newShares(metres));
  double modeShare = 1;
  if (isWide(estimate.covariance)) {
    const PoseMode mode = heaviestMode(m_filter.particles(), m_filter.logWeights());
    if (m_options.filter.heaviestPlace) estimate = mode.estimate;
    modeShare = mode.share;
  }
  m_estimate = estimate;
  update.estimate = estimate;
  update.step = m_filter.report();

  HealthInput input;
  input.time = frame.time;
  input.metres = metres;
  m_matches = match(frame, estimate);
  const bool seen = std::any_of(m_matches.begin(), m_matches.end(),
                                [](const PoleMatch& match) { return match.matched; });
  m_unseen = seen ? 0 : m_unseen + metres;
  input.matches = m_matches;
  if (!m_map.coarse) {
    const PoleIndex& index = m_map.poles->index();
    input.rival = findRival(frame.poles_robot, m_matches, estimate.mean, index, association());
    input.near = nearPoles(frame, m_matches, estimate.mean, index, m_map.poles->poles());
  }
  input.estimate = estimate;
  input.effectiveParticles =
      m_filter.report().effectiveShare * static_cast<double>(m_filter.report().particles);
  input.modeShare = modeShare;
  input.odometryContradicted = update.motion == OdometryVerdict::contradicted;
  m_monitor.update(input);
}

/// After a jump, the submap still holds poles from before it, which match the old place only.
void LocalizationPipeline::doubtSubmap() {
  const bool mismatch = m_hasPose && m_monitor.health().reason == HealthReason::mismatch;
  if (mismatch && !m_mistrusted) {
    m_submap.clear();
    m_area.reset();
    m_searchedAt = 0;
    m_searchTime = m_time;
  }
  m_mistrusted = mismatch;
}

bool LocalizationPipeline::searchIsDue() const {
  if (!m_options.recover && (m_hasPose || m_isCutOff)) return false;
  if (m_hasPose) {
    const Health& health = m_monitor.health();
    const bool doubtful =
        health.state == HealthState::lost || health.reason == HealthReason::mismatch ||
        health.reason == HealthReason::ambiguous || health.reason == HealthReason::spread ||
        (health.reason == HealthReason::converging && m_monitor.isInFullDoubt());
    if (!doubtful) return false;
  }
  return m_submap.driven() - m_searchedAt >= kSearchEvery ||
         m_time - m_searchTime >= kSearchEverySeconds;
}

/// Round a vehicle that has left the map: it is where the odometry says, and poles that are not on
/// the map fit a place elsewhere by chance.
std::optional<SearchArea> LocalizationPipeline::searchArea() const {
  constexpr double kSigmas = 4, kBeside = 10;  // m
  if (!m_hasPose || !m_monitor.hasLeftMap()) return m_area;
  const Eigen::Vector2d centre(m_estimate.mean.x, m_estimate.mean.y);
  return SearchArea{centre, kSigmas * m_monitor.health().spread + kBeside};
}

void LocalizationPipeline::search(const PoleScan& frame, LocalizationUpdate& update) {
  m_searchedAt = m_submap.driven();
  m_searchTime = m_time;
  ++m_searches;
  m_search = m_map.search->localize(m_submap, searchArea());
  if (m_search.verdict == GlobalVerdict::none) return;
  const bool resolved = m_search.verdict == GlobalVerdict::resolved;
  const bool here = resolved && isNear(m_search.hypotheses[0], sameMetres, sameRadians);
  if (!resolved) {
    // The filter already covers several places, or a few more metres may resolve the ambiguity.
    const bool isKnown = m_monitor.health().state != HealthState::lost || m_monitor.hasLeftMap();
    if (m_hasPose && isKnown) return;
    if (m_submap.driven() < kPatience) return;
  } else if (here && !fitsBetter(m_search.hypotheses[0], frame)) {
    return;
  }
  const bool wasElsewhere = m_hasPose && !here;
  adopt(frame, resolved, update);
  if (wasElsewhere) m_monitor.reportElsewhere();
}

/// Whether an answer is near the estimate. Without an estimate it is not.
bool LocalizationPipeline::isNear(const GlobalHypothesis& place, double metres,
                                  double radians) const {
  const Pose2D apart = relative(m_estimate.mean, place.pose_map_robot);
  return m_hasPose && std::hypot(apart.x, apart.y) <= metres && std::abs(apart.yaw) <= radians;
}

/// A filter that converged to a wrong pose on matching poles is too certain to leave it by itself.
bool LocalizationPipeline::fitsBetter(const GlobalHypothesis& place, const PoleScan& frame) const {
  const auto sum = [](const std::vector<PoleMatch>& matches) {
    double matched = 0;
    for (const PoleMatch& match : matches) matched += match.matched ? match.confidence : 0;
    return matched;
  };
  const PoseWithCovariance pose{place.pose_map_robot, place.covariance};
  return sum(match(frame, pose)) > sum(m_matches) + betterPoles;
}

std::vector<PoleMatch> LocalizationPipeline::match(const PoleScan& frame,
                                                   const PoseWithCovariance& pose) const {
  return associate(frame.poles_robot, pose, m_map.poles->index(), association());
}

AssociationOptions LocalizationPipeline::association() const {
  AssociationOptions options;
  options.sigma = m_map.poles->likelihoodOptions.sigma;
  return options;
}

void LocalizationPipeline::adopt(const PoleScan& frame, bool resolved, LocalizationUpdate& update) {
  std::vector<PoseHypothesis> places;
  for (const GlobalHypothesis& place : m_search.hypotheses) {
    places.push_back(toFilter(place));
    if (resolved) break;
  }
  m_filter.start(places, kSearchParticles);
  PoseSource source = PoseSource::given;
  if (resolved)
    source = isNear(m_search.hypotheses[0], kNear, kNearTurn) ? PoseSource::foundNear
                                                              : PoseSource::found;
  m_monitor.begin(source);
  m_hasPose = true;
  if (resolved) m_area.reset();
  track(frame, 0, update);
  update.relocalized = true;
}

}  // namespace polemcl
