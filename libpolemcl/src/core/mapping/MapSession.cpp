#include "core/mapping/MapSession.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "core/extraction/VisibilityRange.h"
#include "core/mapping/LandmarkFusion.h"

namespace polemcl {
namespace {

constexpr std::uint32_t kNoHit = PointHit::none;

void checkVisibilityRange(const SessionScan& scan, const std::string& where) {
  for (const float range : scan.visibilityRange)
    if (!(std::isfinite(range) && range >= 0))
      throw Error("a visibility range of " + where +
                  " is negative or not finite; extract the scan again");
}

}  // namespace

std::string nameOf(const SessionScan& scan) {
  return "the scan at " + std::to_string(scan.time) + " s";
}

Session::Session(const std::vector<SessionScan>& scans, const PoleMapOptions& mapping,
                 const MapUpdateOptions& options)
    : m_scans(scans), m_mapping(mapping), m_options(options), m_firstOfScan{0} {
  double along = 0;
  for (std::uint32_t number = 0; number < scans.size(); ++number) {
    const SessionScan& scan = scans[number];
    const std::string where = nameOf(scan);
    checkScan(scan.pose_map_robot, scan.poles_robot, where);
    checkVisibilityRange(scan, where);
    if (number > 0) {
      const Pose2D &a = scans[number - 1].pose_map_robot, &b = scan.pose_map_robot;
      along += std::hypot(b.x - a.x, b.y - a.y);
    }
    m_along.push_back(along);
    m_firstTime = number == 0 ? scan.time : std::min(m_firstTime, scan.time);
    m_lastTime = number == 0 ? scan.time : std::max(m_lastTime, scan.time);
    const PoseTrust trust{mapping.poseSigma, mapping.headingSigma, scan.poseCovariance};
    for (const PoleDetection& pole : scan.poles_robot) {
      if (pole.confidence <= 0 || pole.confidence < mapping.minConfidence) continue;
      m_observations.push_back(landmarkObservation(pole, scan.pose_map_robot, number, trust));
    }
    m_firstOfScan.push_back(m_observations.size());
  }
}

void Session::observe(const std::vector<LandmarkRecord>& poles) {
  m_owner.assign(m_observations.size(), kNoHit);
  m_poles.assign(poles.size(), {});
  const KdTree2D tree(centresOf(poles));
  for (std::size_t number = 0; number < m_scans.size(); ++number) {
    assign(number, tree);
    expect(number, tree, poles);
  }
}

/// Assigns the observations of one scan to the poles in their gates, nearest pair first.
void Session::assign(std::size_t number, const KdTree2D& tree) {
  struct Pair : AssignedPair {
    double x, y;
    bool operator<(const Pair& other) const {
      return std::tie(distance, x, y, second) <
             std::tie(other.distance, other.x, other.y, other.second);
    }
  };
  const std::size_t begin = m_firstOfScan[number];
  std::vector<Pair> pairs;
  std::vector<PointHit> hits;
  for (std::size_t i = begin; i < m_firstOfScan[number + 1]; ++i) {
    const PoleDetection& seen = m_observations[i].pole;
    tree.within(seen.x, seen.y, m_mapping.mergeDistance, hits);
    for (const PointHit& hit : hits)
      pairs.push_back({{i - begin, hit.index, hit.squaredDistance}, seen.x, seen.y});
  }
  for (const Pair& pair : chooseClosest(std::move(pairs))) {
    m_owner[begin + pair.first] = static_cast<std::uint32_t>(pair.second);
    m_poles[pair.second].observations.push_back(static_cast<std::uint32_t>(begin + pair.first));
  }
}

/// Counts the poles in range that one scan found or did not find.
void Session::expect(std::size_t number, const KdTree2D& tree,
                     const std::vector<LandmarkRecord>& poles) {
  const SessionScan& scan = m_scans[number];
  const Pose2D sensor = compose(scan.pose_map_robot, scan.pose_robot_sensor);
  std::vector<PointHit> near;
  tree.within(sensor.x, sensor.y, m_options.range, near);
  for (const PointHit& hit : near) {
    SessionPole& own = m_poles[hit.index];
    const bool found =
        !own.observations.empty() && m_observations[own.observations.back()].scan == number;
    const bool unknown = scan.visibilityRange.empty();
    own.wasNear |= unknown && hit.squaredDistance <= kNearby * kNearby;
    if (unknown && !found) continue;
    own.likelihood.add(found, m_along[number], detectionChance(poles[hit.index].history),
                       !unknown && !isInView(scan.visibilityRange, sensor, poles[hit.index].pole));
  }
}

std::vector<LandmarkObservation> Session::loose() const {
  std::vector<LandmarkObservation> loose;
  for (std::size_t i = 0; i < m_observations.size(); ++i)
    if (m_owner[i] == kNoHit) loose.push_back(m_observations[i]);
  return loose;
}

}  // namespace polemcl
