#include "localizer/PointsObservation.h"

#include <mrpt/maps/CSimplePointsMap.h>

#include <string>

namespace polemcl {

mrpt::obs::CObservationPointCloud observationOf(double time, const PointsView& points) {
  constexpr double kLatest = 1e11;  // s; MRPT's clock ends some centuries later
  if (!(time >= 0 && time < kLatest))
    throw Error("a scan at " + std::to_string(time) +
                " s: the time of points must be at least 0 and below 1e11 s");
  if (points.size > 0 && !(points.x && points.y && points.z))
    throw Error("points without x, y or z: each must be an array of " +
                std::to_string(points.size) + " numbers");
  const auto map = mrpt::maps::CSimplePointsMap::Create();
  map->resize(points.size);
  for (std::size_t i = 0; i < points.size; ++i)
    map->setPointFast(i, points.x[i], points.y[i], points.z[i]);
  mrpt::obs::CObservationPointCloud scan;
  scan.pointcloud = map;
  scan.timestamp = mrpt::Clock::fromDouble(time);
  return scan;
}

}  // namespace polemcl
