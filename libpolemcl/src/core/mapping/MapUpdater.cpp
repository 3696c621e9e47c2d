#include "core/mapping/MapUpdater.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "core/common/Binder.h"
#include "core/common/Covariance.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "core/mapping/MapSession.h"
#include "core/mapping/ObservationClustering.h"
#include "core/mapping/SessionAlignment.h"

namespace polemcl {
namespace {

constexpr double kPresent = 0.9;     // a pole enters the map from this probability on
constexpr double kAbsent = 0.4;      // a pole leaves the map below this; it is remembered
constexpr double kForgotten = 0.05;  // a pole is forgotten below this probability
/// A missed pole that is nearer than this to a new one has been moved there, m. It leaves no ghost.
constexpr double kGhost = 1.5;
/// Scans whose position has a greater standard deviation along any axis change nothing, m.
constexpr double kMaxSigma = 0.25;

constexpr double kFarEllipse = 13.8;        ///< 99.9 % of squared distances, 2 degrees of freedom
constexpr std::uint32_t kWeightedTo = 200;  ///< observations: older ones do not outweigh today's
constexpr double kWithoutHistory = 0.9;     ///< existence of a pole of an old map

/// Counts of files may be any.
void increase(std::uint32_t& count, std::uint32_t more) {
  count += std::min(more, std::numeric_limits<std::uint32_t>::max() - count);
}

void sortByPlace(std::vector<LandmarkRecord>& poles) {
  std::stable_sort(poles.begin(), poles.end(),
                   [](const LandmarkRecord& a, const LandmarkRecord& b) {
                     return std::tie(a.pole.x, a.pole.y) < std::tie(b.pole.x, b.pole.y);
                   });
}

/// The scans whose positions are known well enough.
std::vector<SessionScan> certainScans(const std::vector<SessionScan>& scans) {
  std::vector<SessionScan> certain;
  certain.reserve(scans.size());
  for (const SessionScan& scan : scans) {
    if (!isCovariance(scan.poseCovariance))
      throw Error("the pose of " + nameOf(scan) +
                  " has a matrix that is no covariance; leave the scan out or correct it");
    if (largestSigma(scan.poseCovariance.topLeftCorner<2, 2>()) <= kMaxSigma)
      certain.push_back(scan);
  }
  return certain;
}

/// One session's update, step by step.
class Update {
 public:
  Update(const LandmarkMap& map, const std::vector<SessionScan>& scans,
         const PoleMapOptions& mapping, const MapUpdateOptions& options)
      : m_mapping(mapping), m_options(options), m_session(scans, mapping, options) {
    m_poles = map.poles;
    m_known = m_poles.size();
    m_counts.scans = scans.size();
    for (const SessionScan& scan : scans)
      m_counts.withoutVisibility += scan.visibilityRange.empty();
  }

  LandmarkMap run();
  const MapUpdateCounts& counts() const { return m_counts; }

 private:
  void bringForward();
  void addNew();
  void applyLikelihoods();
  void movePlaces();
  bool movePlace(LandmarkRecord& record, const MapPole& seen) const;
  bool entersMap(const LandmarkRecord& record) const {
    return record.history.existence >= kPresent &&
           record.pole.count >= static_cast<std::uint32_t>(m_options.minSeen);
  }
  void dropGhosts();
  void dropDoubles(const std::vector<Eigen::Vector2d>& before);
  bool seenTogether(std::size_t a, std::size_t b) const;
  std::set<std::uint32_t> scansOf(std::size_t pole) const;
  void decidePresence();

  const PoleMapOptions& m_mapping;
  const MapUpdateOptions& m_options;
  Session m_session;
  std::vector<LandmarkRecord> m_poles;  ///< those of before, then new ones
  std::vector<bool> m_gone;
  std::size_t m_known = 0;  ///< of before
  MapUpdateCounts m_counts;
};

/// Ages the existence of all poles from the last session to this one. The last session is the
/// latest time at which any pole was seen.
void Update::bringForward() {
  double last = 0;
  for (const LandmarkRecord& record : m_poles) last = std::max(last, record.history.lastSeen);
  if (!isDate(last) || !isDate(m_session.firstTime())) return;
  for (LandmarkRecord& record : m_poles)
    record.history.existence =
        survived(record.history.existence, m_session.firstTime() - last, m_options.lifetimeDays);
}

/// Clusters the observations without a pole and makes new poles of them.
void Update::addNew() {
  const std::vector<LandmarkObservation> loose = m_session.loose();
  const auto groups = clusterObservations(loose, {m_mapping.mergeDistance, m_mapping.apartShare});
  for (const auto& group : groups) {
    if (group.size() < 2) continue;  // a single observation may be chance
    LandmarkRecord record;
    record.pole = fuse(loose, group);
    record.pole.count = 0;  // movePlaces() counts its observations
    record.history.existence = kPrior;
    m_poles.push_back(record);
  }
}

void Update::applyLikelihoods() {
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    LandmarkRecord& record = m_poles[i];
    const SessionPole& today = m_session.poles()[i];
    const ExistenceLikelihood& likelihood = today.likelihood;
    m_counts.expectedOnMap += record.present && likelihood.found() + likelihood.missed() > 0;
    m_counts.nearOnMap += record.present && today.wasNear;
    m_counts.foundOnMap += record.present && likelihood.found() > 0;
    record.history.existence = updated(record.history.existence, likelihood.logRatio());
    increase(record.history.seen, likelihood.found());
    increase(record.history.missed, likelihood.missed());
    for (const std::uint32_t observation : today.observations)
      noteSeen(record.history, m_session.time(m_session.observations()[observation].scan));
  }
}

/// Updates the centre of a pole after a session. The covariance gets the error that all scans of
/// the session share.
/// \return Whether the pole has been moved.
bool Update::movePlace(LandmarkRecord& record, const MapPole& seen) const {
  MapPole& pole = record.pole;
  const double shared = m_options.sessionSigma * m_options.sessionSigma;
  const Eigen::Matrix2d today = seen.covariance + shared * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d step = centreOf(seen) - centreOf(pole);
  const Eigen::Matrix2d gain = pole.covariance * (pole.covariance + today).inverse();
  const double squared = step.dot((pole.covariance + today).inverse() * step);
  const bool moved = pole.count > 0 &&
                     seen.count >= static_cast<std::uint32_t>(m_options.minSeen) &&
                     step.norm() > m_options.moved && squared > kFarEllipse;
  const std::uint32_t before = moved ? 0 : std::min(pole.count, kWeightedTo);
  const double share = seen.count / (static_cast<double>(before) + seen.count);
  const auto blend = [&](double& value, double now) { value += share * (now - value); };
  blend(pole.radius, seen.radius);
  blend(pole.bottom, seen.bottom);
  blend(pole.top, seen.top);
  blend(pole.confidence, seen.confidence);
  pole.confidence = std::clamp(pole.confidence, 0.0, 1.0);
  const bool takeOver = moved || pole.count == 0;
  const Eigen::Vector2d place = takeOver ? centreOf(seen) : centreOf(pole) + gain * step;
  const Eigen::Matrix2d covariance = takeOver ? today : pole.covariance - gain * pole.covariance;
  pole.x = place.x();
  pole.y = place.y();
  pole.covariance = symmetrized(covariance);
  increase(pole.count, seen.count);
  return moved;
}

void Update::movePlaces() {
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    const auto& members = m_session.poles()[i].observations;
    if (members.empty()) continue;
    const bool moved = movePlace(m_poles[i], fuse(m_session.observations(), members));
    if (moved) m_poles[i].history.firstSeen = 0;
    if (moved) noteSeen(m_poles[i].history, m_session.firstTime());
    m_counts.moved += moved && m_poles[i].present;
  }
}

/// Drops a pole that was never found if a pole that enters the map stands beside it.
void Update::dropGhosts() {
  const KdTree2D tree(centresOf(m_poles));
  std::vector<PointHit> near;
  for (std::size_t i = 0; i < m_known; ++i) {
    const ExistenceLikelihood& likelihood = m_session.poles()[i].likelihood;
    if (!m_session.poles()[i].observations.empty() || likelihood.missed() == 0) continue;
    tree.within(m_poles[i].pole.x, m_poles[i].pole.y, kGhost, near);
    m_gone[i] = std::any_of(near.begin(), near.end(), [&](const PointHit& hit) {
      return !m_poles[hit.index].present && entersMap(m_poles[hit.index]);
    });
    m_counts.moved += m_gone[i] && m_poles[i].present;
  }
}

std::set<std::uint32_t> Update::scansOf(std::size_t pole) const {
  std::set<std::uint32_t> scans;
  for (const std::uint32_t observation : m_session.poles()[pole].observations)
    scans.insert(m_session.observations()[observation].scan);
  return scans;
}

/// Whether scans show both poles, as ObservationClustering decides it.
bool Update::seenTogether(std::size_t a, std::size_t b) const {
  const auto first = scansOf(a), second = scansOf(b);
  std::size_t both = 0;
  for (const std::uint32_t scan : first) both += second.count(scan);
  return static_cast<double>(both) >=
         m_mapping.apartShare * static_cast<double>(std::max(first.size(), second.size()));
}

/// Drops the pole seen less often today when two poles have moved into one gate; one on the map
/// only for one that is on the map then. Of two poles that the map had there already, both must
/// have been seen. \param before Places of the known poles.
void Update::dropDoubles(const std::vector<Eigen::Vector2d>& before) {
  const KdTree2D tree(centresOf(m_poles));
  std::vector<PointHit> near;
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    tree.within(m_poles[i].pole.x, m_poles[i].pole.y, m_mapping.mergeDistance, near);
    for (const PointHit& hit : near) {
      const std::size_t j = hit.index;
      if (j <= i || m_gone[i] || m_gone[j]) continue;
      const std::size_t a = m_session.poles()[i].observations.size(),
                        b = m_session.poles()[j].observations.size();
      const bool wereHere = j < m_known && (before[i] - before[j]).norm() < m_mapping.mergeDistance;
      if (a + b == 0 || (wereHere && std::min(a, b) == 0) || seenTogether(i, j)) continue;
      const auto stays = [&](std::size_t k) { return m_poles[k].present || entersMap(m_poles[k]); };
      std::size_t gone = a < b ? i : j, other = a < b ? j : i;
      if (m_poles[gone].present && !stays(other)) std::swap(gone, other);
      m_gone[gone] = true;
      m_counts.left += m_poles[gone].present;
    }
  }
}

/// Decides which poles are on the map, which are candidates and which are forgotten.
void Update::decidePresence() {
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    LandmarkRecord& record = m_poles[i];
    const bool was = record.present;
    const double existence = record.history.existence;
    if (existence < kAbsent) record.present = false;
    if (entersMap(record)) record.present = true;
    m_counts.entered += record.present && !was && !m_gone[i];
    m_counts.left += was && !record.present && !m_gone[i];
    if (m_gone[i]) continue;
    m_gone[i] = existence < kForgotten || record.pole.count == 0;
    m_counts.forgotten += m_gone[i];
    m_counts.candidates += !record.present && !m_gone[i];
  }
}

LandmarkMap Update::run() {
  bringForward();
  m_session.observe(m_poles);
  addNew();
  m_session.observe(m_poles);
  m_gone.assign(m_poles.size(), false);
  applyLikelihoods();
  const auto before = centresOf(m_poles);
  movePlaces();
  dropGhosts();
  dropDoubles(before);
  decidePresence();
  LandmarkMap result;
  for (std::size_t i = 0; i < m_poles.size(); ++i)
    if (!m_gone[i]) result.poles.push_back(m_poles[i]);
  sortByPlace(result.poles);
  return result;
}

}  // namespace

LandmarkMap landmarksFrom(const std::vector<MapPole>& poles) {
  LandmarkMap map;
  for (const MapPole& pole : poles) {
    LandmarkRecord record{pole, {}, true};
    record.history.seen = pole.count;
    record.history.existence = kWithoutHistory;
    map.poles.push_back(record);
  }
  sortByPlace(map.poles);
  return map;
}

LandmarkMap withHistory(const std::vector<MapPole>& poles, const std::vector<SessionScan>& scans,
                        const PoleMapOptions& mapping, const MapUpdateOptions& options) {
  checkOptions(mapping);
  checkOptions(options);
  LandmarkMap map;
  for (const MapPole& pole : poles) map.poles.push_back({pole, {}, true});
  Session session(scans, mapping, options);
  session.observe(map.poles);
  for (std::size_t i = 0; i < map.poles.size(); ++i) {
    PoleHistory& history = map.poles[i].history;
    const SessionPole& seen = session.poles()[i];
    history.seen = seen.likelihood.found();
    history.missed = seen.likelihood.missed();
    history.existence = std::max(kPresent, updated(0.5, seen.likelihood.logRatio()));
    for (const std::uint32_t observation : seen.observations)
      noteSeen(history, session.time(session.observations()[observation].scan));
  }
  return map;
}

LandmarkMap updateMap(const LandmarkMap& map, const std::vector<SessionScan>& scans,
                      const PoleMapOptions& mapping, const MapUpdateOptions& options,
                      MapUpdateCounts* counts) {
  checkOptions(mapping);
  checkOptions(options);
  std::vector<SessionScan> used = certainScans(scans);
  AlignmentSummary alignment;
  if (options.alignSigma > 0) used = alignedSession(used, map, mapping, options, &alignment);
  Update update(map, used, mapping, options);
  LandmarkMap result = update.run();
  if (!counts) return result;
  *counts = update.counts();
  counts->uncertain = scans.size() - used.size();
  counts->alignment = alignment;
  return result;
}

std::vector<MapPole> presentPoles(const LandmarkMap& map) {
  std::vector<MapPole> poles;
  for (const LandmarkRecord& record : map.poles)
    if (record.present) poles.push_back(record.pole);
  return poles;
}

}  // namespace polemcl
