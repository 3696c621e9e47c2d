#pragma once
/// \file Covariance.h
/// \brief What counts as a covariance matrix, in all parts of polemcl.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace polemcl {

/// \brief Whether the matrix is finite, symmetric and positive semidefinite. Rounding may break
/// symmetry and sign by 1e-9 of the largest element. The zero matrix is a covariance.
template <int size>
bool isCovariance(const Eigen::Matrix<double, size, size>& matrix) {
  if (!matrix.allFinite()) return false;
  const double tolerance = 1e-9 * matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > tolerance) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, size, size>> solver(
      matrix, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] >= -tolerance;
}

/// \brief Whether the matrix is a covariance that can be inverted.
template <int size>
bool isDefiniteCovariance(const Eigen::Matrix<double, size, size>& matrix) {
  return isCovariance(matrix) &&
         Eigen::LLT<Eigen::Matrix<double, size, size>>(matrix).info() == Eigen::Success;
}

}  // namespace polemcl
