#include "mrpt/observation/DepthImage.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cmath>
#include <string>

#include <polemcl/core/common/Types.h>

namespace polemcl {

bool hasPixels(const mrpt::obs::CObservation3DRangeScan& observation) {
  return observation.hasRangeImage && observation.rangeImage.rows() > 0 &&
         observation.rangeImage.cols() > 0;
}

PinholeCamera cameraOf(const mrpt::obs::CObservation3DRangeScan& observation) {
  const auto& intrinsics = observation.cameraParams;
  PinholeCamera camera;
  camera.width = static_cast<int>(observation.rangeImage.cols());
  camera.height = static_cast<int>(observation.rangeImage.rows());
  camera.fx = intrinsics.fx();
  camera.fy = intrinsics.fy();
  camera.cx = intrinsics.cx();
  camera.cy = intrinsics.cy();
  camera.validate();
  if (!(observation.rangeUnits > 0 && std::isfinite(observation.rangeUnits)))
    throw Error("depth camera: rangeUnits = " + std::to_string(observation.rangeUnits) +
                ": allowed are positive numbers, the metres of one unit of depth");
  return camera;
}

std::size_t unproject(const mrpt::obs::CObservation3DRangeScan& observation,
                      const PinholeCamera& camera, const DepthPoints& to) {
  for (auto* axis : {&to.x, &to.y, &to.z}) axis->clear();
  const double units = observation.rangeUnits;
  std::size_t empty = 0;
  for (int row = 0; row < camera.height; ++row) {
    const double up = (camera.cy - row) / camera.fy;
    for (int column = 0; column < camera.width; ++column) {
      const auto depth = observation.rangeImage(row, column);
      if (depth == 0) {
        ++empty;
        continue;
      }
      const double left = (camera.cx - column) / camera.fx;
      const double ahead =
          depth * units / (observation.range_is_depth ? 1 : std::sqrt(1 + left * left + up * up));
      to.x.push_back(static_cast<float>(ahead));
      to.y.push_back(static_cast<float>(ahead * left));
      to.z.push_back(static_cast<float>(ahead * up));
    }
  }
  return empty;
}

}  // namespace polemcl
