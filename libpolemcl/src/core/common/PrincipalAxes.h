#pragma once
/// \file PrincipalAxes.h
/// \brief The axes of a 2x2 covariance, in closed form.

#include <Eigen/Core>
#include <optional>

namespace polemcl {

struct PrincipalAxes {
  double first = 0,
         second = 0;    ///< variances along and across the first axis, first >= second >= 0
  double x = 1, y = 0;  ///< direction of the first axis, length 1
};

/// \brief Nothing if the matrix is no covariance, see isCovariance().
std::optional<PrincipalAxes> principalAxes(const Eigen::Matrix2d& covariance);

}  // namespace polemcl
