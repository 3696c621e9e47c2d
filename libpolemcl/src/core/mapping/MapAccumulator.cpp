#include "core/mapping/MapAccumulator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "core/common/Binder.h"
#include "core/common/KdTree2D.h"

namespace polemcl {
namespace {

KdTree2D scanPlaces(const std::vector<AddedSession>& sessions) {
  std::vector<Eigen::Vector2d> places;
  for (const AddedSession& session : sessions)
    for (const SessionScan& scan : session.scans)
      places.emplace_back(scan.pose_map_robot.x, scan.pose_map_robot.y);
  return KdTree2D(std::move(places));
}

void requireFinitePoses(const AddedSession& session) {
  for (std::size_t i = 0; i < session.scans.size(); ++i) {
    const Pose2D& pose = session.scans[i].pose_map_robot;
    if (!std::isfinite(pose.x + pose.y + pose.yaw))
      throw Error("session " + session.name + ": the pose of scan " + std::to_string(i) +
                  " is not finite; leave the scan out or correct its pose");
  }
}

Eigen::AlignedBox2d boxOf(const AddedSession& session) {
  Eigen::AlignedBox2d box;
  for (const SessionScan& scan : session.scans)
    box.extend(Eigen::Vector2d(scan.pose_map_robot.x, scan.pose_map_robot.y));
  return box;
}

/// Sessions of one map lie near each other; one in another frame mostly does not.
void requireOneDatum(const AddedSession& session, const std::vector<AddedSession>& before) {
  constexpr double farthest = 10000;  // m
  const Eigen::AlignedBox2d box = boxOf(session);
  double gap = std::numeric_limits<double>::infinity();
  for (const AddedSession& other : before)
    if (!other.scans.empty()) gap = std::min(gap, box.exteriorDistance(boxOf(other)));
  if (box.isEmpty() || std::isinf(gap) || gap <= farthest) return;
  throw Error("session " + session.name + ": its poses are " +
              std::to_string(std::lround(gap / 1000)) +
              " km from those of all sessions before (10 km are allowed): do they share a datum? " +
              "Bring all into one frame, or map them apart");
}

}  // namespace

std::size_t AddedSession::usedCount() const {
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
}

double AddedSession::usedShare() const {
  return scans.empty() ? 0 : static_cast<double>(usedCount()) / static_cast<double>(scans.size());
}

std::size_t AddedSessions::scans() const {
  std::size_t count = 0;
  for (const AddedSession& session : sessions) count += session.scans.size();
  return count;
}

MapAccumulator::MapAccumulator(const PoleMapOptions& mapping, const MapUpdateOptions& upkeep)
    : m_mapping(mapping), m_upkeep(upkeep) {
  checkOptions(mapping);
  checkOptions(upkeep);
  m_added.unvisited = mapping.unvisited;
}

MapAccumulator::MapAccumulator(const PoleMapOptions& mapping, const MapUpdateOptions& upkeep,
                               AddedSessions before)
    : MapAccumulator(mapping, upkeep) {
  if (before.unvisited != mapping.unvisited) {
    std::ostringstream text;
    text << "[map] unvisited_m = " << mapping.unvisited
         << ", but the scans of the map were chosen with " << before.unvisited
         << "; set that, or build the map from all sessions again";
    throw Error(text.str());
  }
  m_added = std::move(before);
}

const AddedSession& MapAccumulator::add(std::string name, std::vector<SessionScan> scans,
                                        std::vector<Eigen::Matrix3d> covariances) {
  AddedSession session{std::move(name), std::move(scans), {}, std::move(covariances)};
  requireFinitePoses(session);
  requireOneDatum(session, m_added.sessions);
  session.used.assign(session.scans.size(), true);
  if (m_added.unvisited > 0) {
    const KdTree2D visited = scanPlaces(m_added.sessions);
    // The search leaves out what is exactly at its radius; used is what is farther.
    const double radius =
        std::nextafter(m_added.unvisited, std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < session.scans.size(); ++i) {
      SessionScan& scan = session.scans[i];
      if (!visited.nearest(scan.pose_map_robot.x, scan.pose_map_robot.y, radius)) continue;
      session.used[i] = false;
      SessionScan bare;
      bare.time = scan.time;
      bare.pose_map_robot = scan.pose_map_robot;
      scan = std::move(bare);
    }
  }
  m_added.sessions.push_back(std::move(session));
  return m_added.sessions.back();
}

PoleMapResult MapAccumulator::build() const {
  std::vector<MappingScan> scans;
  scans.reserve(m_added.scans());
  for (std::uint32_t drive = 0; drive < m_added.sessions.size(); ++drive) {
    const AddedSession& session = m_added.sessions[drive];
    for (std::size_t i = 0; i < session.scans.size(); ++i)
      scans.push_back(
          {session.scans[i].pose_map_robot, session.scans[i].poles_robot, drive, session.used[i]});
  }
  return buildPoleMap(scans, m_mapping);
}

LandmarkMap MapAccumulator::withHistories(const std::vector<MapPole>& poles) const {
  std::vector<SessionScan> scans;
  for (const AddedSession& session : m_added.sessions)
    for (std::size_t i = 0; i < session.scans.size(); ++i)
      if (session.used[i]) scans.push_back(session.scans[i]);
  return withHistory(poles, scans, m_mapping, m_upkeep);
}

}  // namespace polemcl
