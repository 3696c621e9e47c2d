#include "mrpt/observation/DepthImage.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/vision/pinhole.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <polemcl/core/common/Types.h>
#include "core/sensor/PinholeCamera.h"
#include "mrpt/common/BoundedRead.h"

namespace polemcl {

bool hasPixels(const mrpt::obs::CObservation3DRangeScan& observation) {
  return storedNumber(observation.hasRangeImage) != 0 && observation.rangeImage.rows() > 0 &&
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

namespace {

/// k1, k2, p1, p2, k3; empty if the image is not distorted.
std::vector<double> distortionOf(const mrpt::img::TCamera& camera) {
  using mrpt::img::DistortionModel;
  if (camera.distortion == DistortionModel::none) return {};
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.dist;
  if (camera.distortion != DistortionModel::plumb_bob || k4 != 0 || k5 != 0 || k6 != 0)
    throw Error(
        "depth camera: its lens distortion is " +
        std::string(camera.distortion == DistortionModel::plumb_bob ? "plumb_bob with k4, k5, k6"
                                                                    : "kannala_brandt") +
        ": allowed are none and plumb_bob with k1, k2, p1, p2, k3; undistort the images first");
  std::vector<double> distortion{k1, k2, p1, p2, k3};
  const bool isNone = std::all_of(distortion.begin(), distortion.end(),
                                  [](double coefficient) { return coefficient == 0; });
  return isNone ? std::vector<double>() : distortion;
}

/// The pixel of a distorted image that shows the ray (left, up) at depth 1; -1: none.
int distortedPixel(const mrpt::img::TCamera& lens, const PinholeCamera& camera, double left,
                   double up) {
  mrpt::img::TPixelCoordf at;
  mrpt::vision::pinhole::projectPoint_with_distortion({-left, -up, 1}, lens, at);
  const double column = std::round(at.x), row = std::round(at.y);
  if (!(column >= 0 && row >= 0 && column < camera.width && row < camera.height)) return -1;
  return static_cast<int>(row) * camera.width + static_cast<int>(column);
}

}  // namespace

void UndistortedPixels::prepare(const mrpt::obs::CObservation3DRangeScan& observation,
                                const PinholeCamera& camera) {
  const mrpt::img::TCamera& lens = observation.cameraParams;
  const std::vector<double> distortion = distortionOf(lens);
  if (distortion == m_distortion && camera == m_camera) return;
  m_distortion = distortion;
  m_camera = camera;
  m_source.clear();
  if (distortion.empty()) return;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column)
      m_source.push_back(distortedPixel(lens, camera, (camera.cx - column) / camera.fx,
                                        (camera.cy - row) / camera.fy));
}

std::optional<std::size_t> UndistortedPixels::sourceOf(std::size_t pixel) const {
  if (m_source.empty()) return pixel;
  if (m_source[pixel] < 0) return std::nullopt;
  return static_cast<std::size_t>(m_source[pixel]);
}

std::size_t unproject(const mrpt::obs::CObservation3DRangeScan& observation,
                      const PinholeCamera& camera, const UndistortedPixels& pixels,
                      const DepthPoints& to) {
  for (auto* axis : {&to.x, &to.y, &to.z}) axis->clear();
  const double units = observation.rangeUnits;
  const auto width = static_cast<std::size_t>(camera.width);
  std::size_t empty = 0, pixel = 0;
  const bool isDepth = storedNumber(observation.range_is_depth) != 0;
  for (int row = 0; row < camera.height; ++row) {
    const double up = (camera.cy - row) / camera.fy;
    for (int column = 0; column < camera.width; ++column, ++pixel) {
      const auto source = pixels.sourceOf(pixel);
      const auto depth = source ? observation.rangeImage(static_cast<int>(*source / width),
                                                         static_cast<int>(*source % width))
                                : 0;
      if (depth == 0) {
        ++empty;
        continue;
      }
      const double left = (camera.cx - column) / camera.fx;
      const double ahead = depth * units / (isDepth ? 1 : std::sqrt(1 + left * left + up * up));
      to.x.push_back(static_cast<float>(ahead));
      to.y.push_back(static_cast<float>(ahead * left));
      to.z.push_back(static_cast<float>(ahead * up));
    }
  }
  return empty;
}

}  // namespace polemcl
