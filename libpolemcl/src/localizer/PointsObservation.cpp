#include "localizer/PointsObservation.h"

#include <mrpt/maps/CSimplePointsMap.h>

namespace polemcl {

mrpt::obs::CObservationPointCloud observationOf(double time, const PointsView& points) {
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
