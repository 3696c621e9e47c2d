#include "core/sensor/PinholeCamera.h"

#include <cmath>
#include <string>

#include <polemcl/core/common/Types.h>

namespace polemcl {

void PinholeCamera::validate() const {
  constexpr int kLargest = 16384;
  if (width < 2 || height < 2 || width > kLargest || height > kLargest)
    throw Error("depth camera: an image of " + std::to_string(width) + " x " +
                std::to_string(height) + " pixels: allowed are 2 to 16384 each way");
  for (const double f : {fx, fy})
    if (!(f > 0 && std::isfinite(f)))
      throw Error("depth camera: focal lengths fx = " + std::to_string(fx) +
                  ", fy = " + std::to_string(fy) +
                  " pixels: allowed are positive numbers; set the camera's calibration");
  if (!std::isfinite(cx) || !std::isfinite(cy))
    throw Error("depth camera: principal point cx = " + std::to_string(cx) + ", cy = " +
                std::to_string(cy) + ": allowed are finite numbers; set the camera's calibration");
}

bool PinholeCamera::operator==(const PinholeCamera& other) const {
  return width == other.width && height == other.height && fx == other.fx && fy == other.fy &&
         cx == other.cx && cy == other.cy && R_lidar_camera == other.R_lidar_camera;
}

}  // namespace polemcl
