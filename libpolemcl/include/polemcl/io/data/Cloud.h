#pragma once
/// \file Cloud.h
/// \brief Point clouds from KITTI `.bin` files.

#include <filesystem>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl::io {

/// \brief Point cloud as arrays of equal length. Sensor frame, m.
struct POLEMCL_EXPORT Cloud {
  std::vector<float> x, y, z;
  std::vector<float> intensity;  ///< as stored; KITTI: 0 … 1
  std::size_t invalid = 0;       ///< points dropped when reading: NaN, infinite, or at the origin

  /// \brief Appends a point, or counts it as invalid. \return Whether it was appended.
  bool add(double px, double py, double pz, double pointIntensity);
  std::size_t size() const { return x.size(); }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// \brief Reads little-endian float32 x y z intensity. An empty file gives an empty cloud.
/// \throws Error when the file cannot be read, or its size is not a multiple of 16 bytes
///         (truncated).
POLEMCL_EXPORT Cloud readKittiBin(const std::filesystem::path& file);

}  // namespace polemcl::io
