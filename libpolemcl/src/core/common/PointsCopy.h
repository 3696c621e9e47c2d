#pragma once
/// \file PointsCopy.h
/// \brief Some points of a cloud, copied. Private to the library.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

struct PointsCopy {
  std::vector<float> x, y, z;  ///< m
  void add(const PointsView& points, std::size_t i) {
    x.push_back(points.x[i]);
    y.push_back(points.y[i]);
    z.push_back(points.z[i]);
  }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

}  // namespace polemcl
