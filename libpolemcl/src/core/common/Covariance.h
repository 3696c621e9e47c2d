#pragma once
/// \file Covariance.h
/// \brief What counts as a covariance matrix, in all parts of polemcl, and its axes. Eigen's
/// solvers take long to compile: they are in the source file.

#include <Eigen/Core>
#include <optional>

namespace polemcl {

/// \brief Whether the matrix is finite, symmetric and positive semidefinite. Rounding may break
/// symmetry and sign by 1e-9 of the largest element. The zero matrix is a covariance.
bool isCovariance(const Eigen::Matrix2d& matrix);
bool isCovariance(const Eigen::Matrix3d& matrix);

/// \brief Greater sums of a pole's variances are errors, m². Products of smaller ones do not
/// overflow.
constexpr double kGreatestVariance = 1e12;

/// \brief Whether the matrix is a covariance that can be inverted.
bool isDefiniteCovariance(const Eigen::Matrix2d& matrix);
bool isDefiniteCovariance(const Eigen::Matrix3d& matrix);

/// \brief Standard deviation along the worst axis; 0 for a matrix without a positive eigenvalue,
/// infinite for one that is not finite.
double largestSigma(const Eigen::Matrix2d& covariance);

struct PrincipalAxes {
  double first = 0,
         second = 0;    ///< variances along and across the first axis, first >= second >= 0
  double x = 1, y = 0;  ///< direction of the first axis, length 1
};

/// \brief Nothing if the matrix is no covariance, see isCovariance().
std::optional<PrincipalAxes> principalAxes(const Eigen::Matrix2d& covariance);

}  // namespace polemcl
