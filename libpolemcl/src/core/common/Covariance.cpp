#include "core/common/Covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl {
namespace {

template <class Matrix>
bool isSemidefinite(const Matrix& matrix) {
  if (!matrix.allFinite()) return false;
  const double tolerance = 1e-9 * matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > tolerance) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] >= -tolerance;
}

template <class Matrix>
bool isDefinite(const Matrix& matrix) {
  return isSemidefinite(matrix) && Eigen::LLT<Matrix>(matrix).info() == Eigen::Success;
}

}  // namespace

bool isCovariance(const Eigen::Matrix2d& matrix) {
  return isSemidefinite(matrix);
}
bool isCovariance(const Eigen::Matrix3d& matrix) {
  return isSemidefinite(matrix);
}
bool isDefiniteCovariance(const Eigen::Matrix2d& matrix) {
  return isDefinite(matrix);
}
bool isDefiniteCovariance(const Eigen::Matrix3d& matrix) {
  return isDefinite(matrix);
}

double largestSigma(const Eigen::Matrix2d& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
}

std::optional<PrincipalAxes> principalAxes(const Eigen::Matrix2d& covariance) {
  if (!isCovariance(covariance)) return std::nullopt;
  const double xx = covariance(0, 0), yy = covariance(1, 1), xy = covariance(0, 1);
  const double mean = 0.5 * (xx + yy), spread = std::hypot(0.5 * (xx - yy), xy);
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return PrincipalAxes{mean + spread, std::max(0.0, mean - spread), std::cos(angle),
                       std::sin(angle)};
}

}  // namespace polemcl
