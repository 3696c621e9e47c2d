#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <polemcl/core/mapping/MapUpdater.h>

#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "core/mapping/MapSession.h"
#include "core/mapping/ObservationClustering.h"

namespace polemcl {
namespace {

constexpr double kFarEllipse = 13.8;        ///< 99.9 % of squared distances, 2 degrees of freedom
constexpr std::uint32_t kWeightedTo = 200;  ///< sightings: a long past does not outweigh today
constexpr double kWithoutHistory = 0.9;     ///< existence of a pole of an old map

Eigen::Vector2d centreOf(const MapPole& pole) {
  return {pole.x, pole.y};
}

void sortByPlace(std::vector<LandmarkRecord>& poles) {
  std::stable_sort(poles.begin(), poles.end(),
                   [](const LandmarkRecord& a, const LandmarkRecord& b) {
                     return std::tie(a.pole.x, a.pole.y) < std::tie(b.pole.x, b.pole.y);
                   });
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
    for (const SessionScan& scan : scans) m_counts.withoutFreeRange += scan.visibilityRange.empty();
  }

  LandmarkMap run();
  const MapUpdateCounts& counts() const { return m_counts; }

 private:
  void bringForward();
  void addNew();
  void applyEvidence();
  void movePlaces();
  bool movePlace(LandmarkRecord& kept, const MapPole& seen) const;
  void dropGhosts();
  void dropDoubles();
  bool seenTogether(std::size_t a, std::size_t b) const;
  std::set<std::uint32_t> viewsOf(std::size_t pole) const;
  void decidePresence();
  std::vector<Eigen::Vector2d> places() const;

  const PoleMapOptions& m_mapping;
  const MapUpdateOptions& m_options;
  Session m_session;
  std::vector<LandmarkRecord> m_poles;  ///< those of before, then new ones
  std::vector<bool> m_gone;
  std::size_t m_known = 0;  ///< of before
  MapUpdateCounts m_counts;
};

/// To the time of the session: nothing stands for ever. All of the map is as of the last session,
/// of which some pole was seen last.
void Update::bringForward() {
  double last = 0;
  for (const LandmarkRecord& kept : m_poles) last = std::max(last, kept.history.lastSeen);
  if (!isDate(last) || !isDate(m_session.firstTime())) return;
  for (LandmarkRecord& kept : m_poles)
    kept.history.existence =
        survived(kept.history.existence, m_session.firstTime() - last, m_options.existence);
}

/// What no kept pole took, merged to new ones.
void Update::addNew() {
  const std::vector<LandmarkObservation> loose = m_session.loose();
  const auto groups = clusterObservations(loose, {m_mapping.mergeDistance, m_mapping.apartShare});
  for (const auto& group : groups) {
    if (group.size() < 2) continue;  // once is chance
    LandmarkRecord kept;
    kept.pole = fuse(loose, group);
    kept.pole.count = 0;  // its sightings are counted with everybody's
    kept.history.existence = m_options.existence.prior;
    m_poles.push_back(kept);
  }
}

void Update::applyEvidence() {
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    LandmarkRecord& kept = m_poles[i];
    const SessionPole& today = m_session.poles()[i];
    const ExistenceEvidence& evidence = today.evidence;
    m_counts.expectedOnMap += kept.present && evidence.found() + evidence.missed() > 0;
    m_counts.foundOnMap += kept.present && evidence.found() > 0;
    kept.history.existence =
        updated(kept.history.existence, evidence.logRatio(), m_options.existence);
    kept.history.seen += evidence.found();
    kept.history.missed += evidence.missed();
    for (const std::uint32_t sighting : today.sightings)
      noteSeen(kept.history, m_session.time(m_session.sightings()[sighting].view));
  }
}

/// The place after a session, with what all its scans share added to its covariance.
/// \return Whether the pole has been moved.
bool Update::movePlace(LandmarkRecord& kept, const MapPole& seen) const {
  MapPole& pole = kept.pole;
  const double shared = m_options.sessionSigma * m_options.sessionSigma;
  const Eigen::Matrix2d today = seen.covariance + shared * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d step = centreOf(seen) - centreOf(pole);
  const Eigen::Matrix2d gain = pole.covariance * (pole.covariance + today).inverse();
  const double squared = step.dot((pole.covariance + today).inverse() * step);
  const bool moved = pole.count > 0 &&
                     seen.count >= static_cast<std::uint32_t>(m_options.minSeen) &&
                     step.norm() > m_options.moved && squared > kFarEllipse;
  const std::uint32_t before = moved ? 0 : std::min(pole.count, kWeightedTo);
  const double share = static_cast<double>(seen.count) / (before + seen.count);
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
  pole.count += seen.count;
  return moved;
}

void Update::movePlaces() {
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    const auto& members = m_session.poles()[i].sightings;
    if (members.empty()) continue;
    const bool moved = movePlace(m_poles[i], fuse(m_session.sightings(), members));
    if (moved) m_poles[i].history.firstSeen = 0;
    if (moved) noteSeen(m_poles[i].history, m_session.firstTime());
    m_counts.moved += moved && m_poles[i].present;
  }
}

std::vector<Eigen::Vector2d> Update::places() const {
  std::vector<Eigen::Vector2d> places;
  for (const LandmarkRecord& kept : m_poles) places.push_back(centreOf(kept.pole));
  return places;
}

/// What was missed all session beside a new pole that earned its place has become that pole.
void Update::dropGhosts() {
  const KdTree2D tree(places());
  std::vector<PointHit> near;
  for (std::size_t i = 0; i < m_known; ++i) {
    const ExistenceEvidence& evidence = m_session.poles()[i].evidence;
    if (!m_session.poles()[i].sightings.empty() || evidence.missed() == 0) continue;
    tree.within(m_poles[i].pole.x, m_poles[i].pole.y, m_options.ghost, near);
    m_gone[i] = std::any_of(near.begin(), near.end(), [&](const PointHit& hit) {
      return hit.index >= m_known && m_poles[hit.index].history.existence >= m_options.present;
    });
    m_counts.moved += m_gone[i] && m_poles[i].present;
  }
}

std::set<std::uint32_t> Update::viewsOf(std::size_t pole) const {
  std::set<std::uint32_t> views;
  for (const std::uint32_t sighting : m_session.poles()[pole].sightings)
    views.insert(m_session.sightings()[sighting].view);
  return views;
}

/// As ObservationClustering has it: two that stand in one gate are two poles when scans show both.
bool Update::seenTogether(std::size_t a, std::size_t b) const {
  const auto first = viewsOf(a), second = viewsOf(b);
  std::size_t both = 0;
  for (const std::uint32_t view : first) both += second.count(view);
  return static_cast<double>(both) >=
         m_mapping.apartShare * static_cast<double>(std::max(first.size(), second.size()));
}

/// Two kept poles may have come to stand in one gate: the one seen less today goes.
void Update::dropDoubles() {
  const KdTree2D tree(places());
  std::vector<PointHit> near;
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    tree.within(m_poles[i].pole.x, m_poles[i].pole.y, m_mapping.mergeDistance, near);
    for (const PointHit& hit : near) {
      const std::size_t j = hit.index;
      if (j <= i || m_gone[i] || m_gone[j]) continue;
      const std::size_t a = m_session.poles()[i].sightings.size(),
                        b = m_session.poles()[j].sightings.size();
      if (a + b == 0 || seenTogether(i, j)) continue;
      m_gone[a < b ? i : j] = true;
    }
  }
}

/// Who is on the map, who stays beside it, who is forgotten.
void Update::decidePresence() {
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    LandmarkRecord& kept = m_poles[i];
    const bool was = kept.present;
    const double existence = kept.history.existence;
    const bool seenEnough = kept.pole.count >= static_cast<std::uint32_t>(m_options.minSeen);
    if (existence < m_options.absent) kept.present = false;
    if (existence >= m_options.present && seenEnough) kept.present = true;
    m_counts.entered += kept.present && !was && !m_gone[i];
    m_counts.left += was && !kept.present && !m_gone[i];
    if (m_gone[i]) continue;
    m_gone[i] = existence < m_options.forget || kept.pole.count == 0;
    m_counts.forgotten += m_gone[i];
    m_counts.candidates += !kept.present && !m_gone[i];
  }
}

LandmarkMap Update::run() {
  bringForward();
  m_session.observe(m_poles);
  addNew();
  m_session.observe(m_poles);
  m_gone.assign(m_poles.size(), false);
  applyEvidence();
  movePlaces();
  dropGhosts();
  dropDoubles();
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
    LandmarkRecord kept{pole, {}, true};
    kept.history.seen = pole.count;
    kept.history.existence = kWithoutHistory;
    map.poles.push_back(kept);
  }
  sortByPlace(map.poles);
  return map;
}

LandmarkMap withHistory(const std::vector<MapPole>& poles, const std::vector<SessionScan>& scans,
                        const PoleMapOptions& mapping, const MapUpdateOptions& upkeep) {
  mapping.validate();
  upkeep.validate();
  LandmarkMap map;
  for (const MapPole& pole : poles) map.poles.push_back({pole, {}, true});
  Session session(scans, mapping, upkeep);
  session.observe(map.poles);
  for (std::size_t i = 0; i < map.poles.size(); ++i) {
    PoleHistory& history = map.poles[i].history;
    const SessionPole& seen = session.poles()[i];
    history.seen = seen.evidence.found();
    history.missed = seen.evidence.missed();
    history.existence =
        std::max(upkeep.present, updated(0.5, seen.evidence.logRatio(), upkeep.existence));
    for (const std::uint32_t sighting : seen.sightings)
      noteSeen(history, session.time(session.sightings()[sighting].view));
  }
  return map;
}

LandmarkMap updateMap(const LandmarkMap& map, const std::vector<SessionScan>& scans,
                      const PoleMapOptions& mapping, const MapUpdateOptions& upkeep,
                      MapUpdateCounts* counts) {
  mapping.validate();
  upkeep.validate();
  Update update(map, scans, mapping, upkeep);
  LandmarkMap result = update.run();
  if (counts) *counts = update.counts();
  return result;
}

std::vector<MapPole> presentPoles(const LandmarkMap& map) {
  std::vector<MapPole> poles;
  for (const LandmarkRecord& kept : map.poles)
    if (kept.present) poles.push_back(kept.pole);
  return poles;
}

}  // namespace polemcl
