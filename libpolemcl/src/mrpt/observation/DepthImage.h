#pragma once
/// \file DepthImage.h
/// \brief Points and pinhole camera of a CObservation3DRangeScan. Private to the library.

#include <optional>
#include <vector>

#include "core/sensor/PinholeCamera.h"

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

/// \brief The undistorted image, with the same focal lengths, centre and size: what a camera
/// without lens distortion sees. A depth is that of the nearest pixel, because a mean of pixels
/// would lie between a pole and what stands behind it.
class UndistortedPixels {
 public:
  /// \brief Computed anew when the camera changes.
  /// \throws Error on distortion models other than none and plumb_bob with k1, k2, p1, p2, k3.
  void prepare(const mrpt::obs::CObservation3DRangeScan& observation, const PinholeCamera& camera);
  /// \brief Pixel of the image (row * width + column) that shows a pixel of the undistorted one;
  /// none: it is not in the image.
  std::optional<std::size_t> sourceOf(std::size_t pixel) const;

 private:
  std::vector<double> m_distortion;  ///< k1, k2, p1, p2, k3 of m_source; empty: none
  PinholeCamera m_camera;
  std::vector<int> m_source;  ///< -1: none
};

/// \brief Computes one point per pixel of the undistorted image with a depth. Depths are along the
/// ray or along x, depending on `range_is_depth`.
/// \return Number of pixels without a depth (0, or not in the image).
std::size_t unproject(const mrpt::obs::CObservation3DRangeScan& observation,
                      const PinholeCamera& camera, const UndistortedPixels& pixels,
                      const DepthPoints& to);

}  // namespace polemcl
