#pragma once
/// \file Cloud.h
/// \brief Point clouds from KITTI `.bin` files.

#include <filesystem>
#include <vector>

#include "core/common/Types.h"

namespace polemcl::io {

/// \brief A cloud, structure of arrays, all of one length. Sensor frame, m.
struct Cloud {
  std::vector<float> x, y, z;
  std::vector<float> intensity;  ///< as stored; KITTI: 0 … 1
  std::size_t invalid = 0;       ///< points dropped on reading: NaN, infinite, or at the sensor

  std::size_t size() const { return x.size(); }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// \brief Reads float32 little-endian x y z intensity. An empty file is an empty cloud.
/// \throws Error when it cannot be read, or its size is no multiple of 16 bytes (cut short).
Cloud readKittiBin(const std::filesystem::path& file);

}  // namespace polemcl::io
