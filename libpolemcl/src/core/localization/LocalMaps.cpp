#include "core/localization/LocalMaps.h"

#include <cmath>

#include "core/common/Binder.h"
#include "core/common/Transform.h"
#include "core/mapping/ObservationClustering.h"

namespace polemcl {

void bind(Binder& b, LocalMapOptions& o) {
  b.section("tracking", "Which detections the filter is given", Tier::expert);
  b.number("section_length_m", o.sectionLength, Range::above(0), "m",
           "cadence = section: length of a section");
  b.integer("local_maps", o.maps, Range::atLeast(1), "",
            "cadence = section: number of newest sections that confirm poles");
  b.integer("local_hits", o.minHits, Range::atLeast(1), "",
            "cadence = section: least number of overlapping poles in them, itself included");
}

LocalMaps::LocalMaps(const LocalMapOptions& options)
    : m_options(options), m_marks(options.sectionLength) {
  checkOptions(options);
}

void LocalMaps::clear() {
  *this = LocalMaps(m_options);
}

std::vector<PoleDetection> LocalMaps::add(const Pose2D& motion,
                                          const std::vector<PoleDetection>& poles_robot) {
  if (m_started) {
    m_pose = compose(m_pose, motion);
    m_way += std::hypot(motion.x, motion.y);
  }
  m_started = true;
  m_marks.pass(m_way);
  if (m_marks.middle()) m_maps.push_back({m_pose, poles_robot});
  if (!m_marks.end()) return {};
  const std::size_t newest = m_marks.ends() - 1 - m_first;
  std::vector<PoleDetection> poles_now;
  const Pose2D T_now_middle = relative(m_pose, m_maps[newest].pose_odometry_robot);
  for (const PoleDetection& pole : confirmed(newest))
    poles_now.push_back(moved(T_now_middle, pole));
  while (m_first + static_cast<std::size_t>(m_options.maps) <= m_marks.ends()) {
    m_maps.pop_front();
    ++m_first;
  }
  return poles_now;
}

/// The newest map's poles that enough of the maps up to it show; in its robot frame.
std::vector<PoleDetection> LocalMaps::confirmed(std::size_t newest) const {
  if (m_options.minHits == 1) return m_maps[newest].poles_robot;
  std::vector<LandmarkObservation> observations;  // the newest map's first
  for (std::size_t k = newest + 1; k-- > 0;)
    for (const PoleDetection& pole : m_maps[k].poles_robot)
      observations.push_back({moved(m_maps[k].pose_odometry_robot, pole), 0});
  std::vector<bool> taken(m_maps[newest].poles_robot.size());
  for (const std::vector<std::uint32_t>& group : joinOverlappingBoxes(observations))
    if (group.size() >= static_cast<std::size_t>(m_options.minHits))
      for (const std::uint32_t member : group)
        if (member < taken.size()) taken[member] = true;
  std::vector<PoleDetection> poles;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (taken[i]) poles.push_back(m_maps[newest].poles_robot[i]);
  return poles;
}

}  // namespace polemcl
