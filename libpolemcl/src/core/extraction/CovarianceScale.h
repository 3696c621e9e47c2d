#pragma once
/// \file CovarianceScale.h
/// \brief What the covariance of a fit does not know: a fitted scale. Private to the library.

#include <array>

#include "core/extraction/PoleClassifier.h"

namespace polemcl {

/// \brief Terms of the log-linear scale.
enum class CovarianceTerm {
  one,
  odds,
  residual,
  tilt,
  range,
  radius,
  clutter,
  scatter,
  hiddenEdges,
  columns,
  count_  ///< number of terms
};
constexpr int kCovarianceTerms = static_cast<int>(CovarianceTerm::count_);
using CovarianceTerms = std::array<double, kCovarianceTerms>;

/// \brief Name as in covariance.csv.
const char* name(CovarianceTerm term);
/// \param odds Log odds of the candidate. \param columnAngle One firing step, rad.
CovarianceTerms covarianceTerms(const PoleFeatures& features, double odds, double columnAngle);

/// \brief Scale of the covariance of a fit, to be multiplied.
///
/// Crooked, half hidden and doubtful things lie farther off. Columns are the same for all beams, so
/// that more segments do not make up for wide ones.
double covarianceScale(const PoleFeatures& features, double odds, double columnAngle);

}  // namespace polemcl
