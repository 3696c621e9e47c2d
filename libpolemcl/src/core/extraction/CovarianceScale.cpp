#include "core/extraction/CovarianceScale.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace polemcl {
namespace {

struct ScaleWeight {
  CovarianceTerm term;
  double weight;
};
// The table is covariance.csv, which share/experiments/fit_classifier.py wrote.
#define TERM(term, weight) {CovarianceTerm::term, weight},
constexpr ScaleWeight kScaleWeights[] = {
#include "core/extraction/covariance.inc"
};
#undef TERM

constexpr bool scaleInOrder() {
  int expected = 0;
  for (const ScaleWeight& weight : kScaleWeights)
    if (static_cast<int>(weight.term) != expected++) return false;
  return expected == kCovarianceTerms;
}
static_assert(scaleInOrder(), "covariance.csv must list the terms in the order of CovarianceTerm");

}  // namespace

const char* name(CovarianceTerm term) {
  static constexpr const char* names[] = {"one",         "odds",   "residual", "tilt",
                                          "range",       "radius", "clutter",  "scatter",
                                          "hiddenEdges", "columns"};
  static_assert(std::size(names) == kCovarianceTerms);
  return names[static_cast<int>(term)];
}

CovarianceTerms covarianceTerms(const PoleFeatures& f, double odds, double columnAngle) {
  constexpr double kFineColumns = 0.003;  // rad
  return {1,
          std::clamp(odds, 0.0, 7.0),
          std::clamp(f.residual - 0.02, 0.0, 0.05),
          f.tilt,
          f.range / 40,
          f.radius,
          f.clutter,
          f.scatter,
          f.hiddenEdges,
          std::log(columnAngle / kFineColumns)};
}

double covarianceScale(const PoleFeatures& features, double odds, double columnAngle) {
  const CovarianceTerms terms = covarianceTerms(features, odds, columnAngle);
  double logScale = 0;
  for (int i = 0; i < kCovarianceTerms; ++i) logScale += kScaleWeights[i].weight * terms[i];
  return std::exp(logScale);
}

}  // namespace polemcl
