#pragma once
/// \file DepthImage.h
/// \brief Points and pinhole camera of a CObservation3DRangeScan. Private to the library.

#include <vector>

#include <polemcl/core/sensor/PinholeCamera.h>

namespace mrpt::obs {
class CObservation3DRangeScan;
}

namespace polemcl {

/// \brief The points of an image, camera axes (x forward, y left, z up), m.
struct DepthPoints {
  std::vector<float>&x, &y, &z;
};

/// \brief Whether the observation holds pixels in memory.
bool hasPixels(const mrpt::obs::CObservation3DRangeScan& observation);
/// \brief The camera of the image; its attitude is identity.
/// \throws Error on intrinsics that are out of range, and depth units that are not positive.
PinholeCamera cameraOf(const mrpt::obs::CObservation3DRangeScan& observation);
/// \brief Computes one point per pixel with a depth. Depths are along the ray or along x, depending
/// on `range_is_depth`. \return Number of pixels without a depth (0).
std::size_t unproject(const mrpt::obs::CObservation3DRangeScan& observation,
                      const PinholeCamera& camera, const DepthPoints& to);

}  // namespace polemcl
