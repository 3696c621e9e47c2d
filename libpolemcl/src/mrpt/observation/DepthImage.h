#pragma once
/// \file DepthImage.h
/// \brief Points and pinhole of a CObservation3DRangeScan. Private to the library.

#include <vector>

#include "core/sensor/PinholeCamera.h"

namespace mrpt::obs {
class CObservation3DRangeScan;
}

namespace polemcl {

/// \brief The points of an image, camera axes (x ahead, y left, z up), m.
struct DepthPoints {
  std::vector<float>&x, &y, &z;
};

/// \brief True when the observation holds pixels in memory.
bool hasPixels(const mrpt::obs::CObservation3DRangeScan& observation);
/// \brief The camera of the image; its attitude is left as identity.
/// \throws Error on intrinsics that are out of range, and units that are not positive.
PinholeCamera cameraOf(const mrpt::obs::CObservation3DRangeScan& observation);
/// \brief One point per pixel with a depth; depths along the ray or along x, as `range_is_depth`
/// says. \return How many pixels have none (0).
std::size_t unproject(const mrpt::obs::CObservation3DRangeScan& observation,
                      const PinholeCamera& camera, const DepthPoints& to);

}  // namespace polemcl
