#pragma once
/// \file CircleFit.h
/// \brief Algebraic circle fits to points in the plane.

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace polemcl {

struct Circle {
  double x = 0, y = 0, radius = 0;  ///< m
};

/// \brief Kåsa's fit (1976): least squares on x² + y² + Bx + Cy + D. Biased small on short arcs.
/// \return Nothing for fewer than 3 points or points on a line.
std::optional<Circle> fitCircleKasa(const std::vector<Eigen::Vector2d>& points);

/// \brief Kåsa's centre with the mean distance of the points to it as radius, as the paper's
/// authors compute it. Points nearly on a line give a very large circle. \param singlePrecision
/// true: offsets from the mean and their products are computed in float, sums in double. \return
/// Nothing for no points, and where the system is exactly singular.
std::optional<Circle> fitCircleKasaMean(const std::vector<Eigen::Vector2d>& points,
                                        bool singlePrecision);

}  // namespace polemcl
