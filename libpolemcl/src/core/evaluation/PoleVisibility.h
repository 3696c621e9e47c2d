#pragma once
/// \file PoleVisibility.h
/// \brief Which poles of a labelled world a scan shows, and where they are in the scan's frame.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/evaluation/DetectionEvaluation.h"

namespace polemcl {

/// \brief A pole that stands in the world, map frame.
struct WorldPole {
  std::uint32_t id = 0;  ///< label of its points
  double x = 0, y = 0;   ///< of its axis, m
  double radius = 0;     ///< m
  double top = 0;        ///< m above ground
};

/// \brief A pole is visible when at least `returns` returns carry its id, the highest is at least
/// `height` above the lowest, and the sensor is not farther away than `range`.
struct VisibilityRule {
  std::size_t returns = 6;
  double height = 0.6;  ///< m
  double range = 40;    ///< in the plane, m
};

/// \brief What one scan shows of one pole.
struct PoleSight {
  std::size_t returns = 0;         ///< that carry its id
  double lowest = 0, highest = 0;  ///< of these, map frame, m; without any the sensor's height
  double sensor = 0;               ///< height of the cloud's origin, map frame, m
  double range = 0;                ///< from the origin of the cloud, in the plane of the map, m
  bool visible = false;
};

/// \brief What a scan shows of each pole, in the order of `poles`.
/// \param points In the cloud frame.
/// \param labels One per point; a pole's returns carry exactly its id. Foliage of the simulator has
///        another bit set, so it does not count.
/// \throws Error when the numbers of points and labels differ, or two poles have one id.
std::vector<PoleSight> sightPoles(const PointsView& points,
                                  const std::vector<std::uint32_t>& labels,
                                  const Eigen::Isometry3d& T_map_cloud,
                                  const std::vector<WorldPole>& poles,
                                  const VisibilityRule& rule = {});

/// \brief The poles where a perfect extractor would see them: axes are upright in the map, not in
/// the frame of a sensor that leans with the road, so each is taken at the height of the sensor,
/// where leaning does not move it.
/// \param T_scan_map From the map to the frame of the detections.
std::vector<TruePoleInScan> polesInScan(const std::vector<WorldPole>& poles,
                                        const std::vector<PoleSight>& sights,
                                        const Eigen::Isometry3d& T_scan_map);

}  // namespace polemcl
