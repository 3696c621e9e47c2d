#include "core/evaluation/LogisticRegression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {
namespace {

constexpr int kMostSteps = 50;
constexpr double kSmallStep = 1e-9;

void requireSameSize(const Eigen::MatrixXd& terms, const Eigen::VectorXd& values,
                     const Eigen::VectorXd& sampleWeights) {
  if (terms.rows() != values.size() || terms.rows() != sampleWeights.size() || terms.cols() == 0)
    throw Error("regression: " + std::to_string(terms.rows()) + " rows, " +
                std::to_string(values.size()) + " values and " +
                std::to_string(sampleWeights.size()) + " weights; their numbers must be equal");
}

/// Newton's method on a convex cost. `slopes` and `curvatures`: first and second derivative of the
/// cost of each sample with respect to its linear predictor, both weighted.
template <class Derivatives>
Eigen::VectorXd minimize(const Eigen::MatrixXd& terms, double ridge, Derivatives derivatives) {
  Eigen::VectorXd penalty = Eigen::VectorXd::Constant(terms.cols(), ridge);
  penalty[0] = 1e-9;  // keeps the system regular
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(terms.cols());
  Eigen::VectorXd slopes(terms.rows()), curvatures(terms.rows());
  for (int step = 0; step < kMostSteps; ++step) {
    derivatives(Eigen::VectorXd(terms * weights), slopes, curvatures);
    const Eigen::VectorXd gradient = terms.transpose() * slopes + penalty.cwiseProduct(weights);
    Eigen::MatrixXd hessian = terms.transpose() * curvatures.asDiagonal() * terms;
    hessian.diagonal() += penalty;
    Eigen::VectorXd change = hessian.ldlt().solve(gradient);
    const double longest = (terms * change).cwiseAbs().maxCoeff();
    if (longest > 2) change *= 2 / longest;  // far from the minimum, the parabola misleads
    weights -= change;
    if (longest < kSmallStep) break;
  }
  return weights;
}

}  // namespace

Eigen::VectorXd probabilities(const Eigen::VectorXd& logOdds) {
  return (1 + (-logOdds.array()).exp()).inverse();
}

Eigen::VectorXd fitLogistic(const Eigen::MatrixXd& terms, const Eigen::VectorXd& labels,
                            const Eigen::VectorXd& sampleWeights, double ridge) {
  requireSameSize(terms, labels, sampleWeights);
  if (labels.size() == 0 || labels.minCoeff() == labels.maxCoeff())
    throw Error("regression: all samples have one label; both are needed");
  return minimize(
      terms, ridge,
      [&](const Eigen::VectorXd& odds, Eigen::VectorXd& slopes, Eigen::VectorXd& curvatures) {
        const Eigen::VectorXd p = probabilities(odds);
        slopes = sampleWeights.cwiseProduct(p - labels);
        curvatures = (sampleWeights.array() * p.array() * (1 - p.array())).max(1e-12);
      });
}

Eigen::VectorXd fitCovarianceScale(const Eigen::MatrixXd& terms,
                                   const Eigen::VectorXd& squaredErrors,
                                   const Eigen::VectorXd& sampleWeights, double ridge) {
  requireSameSize(terms, squaredErrors, sampleWeights);
  if (squaredErrors.size() == 0) throw Error("regression: no pole with a known error");
  return minimize(
      terms, ridge,
      [&](const Eigen::VectorXd& logScale, Eigen::VectorXd& slopes, Eigen::VectorXd& curvatures) {
        // Cost: log s + e² / (2 s), for two dimensions.
        const Eigen::ArrayXd half = 0.5 * squaredErrors.array() * (-logScale.array()).exp();
        slopes = sampleWeights.array() * (1 - half);
        curvatures = (sampleWeights.array() * half).max(1e-6);
      });
}

double logLoss(const Eigen::VectorXd& logOdds, const Eigen::VectorXd& labels,
               const Eigen::VectorXd& sampleWeights) {
  requireSameSize(logOdds, labels, sampleWeights);
  if (labels.size() == 0) return 0;
  // ln(1 + exp(-m)), m: odds of the true label.
  const Eigen::ArrayXd odds = logOdds.array() * (2 * labels.array() - 1);
  const Eigen::ArrayXd loss = (-odds).max(0) + (1 + (-odds.abs()).exp()).log();
  return (sampleWeights.array() * loss).sum() / sampleWeights.sum();
}

double averagePrecision(const Eigen::VectorXd& logOdds, const Eigen::VectorXd& labels,
                        const Eigen::VectorXd& sampleWeights) {
  requireSameSize(logOdds, labels, sampleWeights);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(labels.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return logOdds[a] > logOdds[b]; });
  const double positives = sampleWeights.dot(labels);
  if (!(positives > 0)) return 0;
  double taken = 0, right = 0, area = 0;
  for (std::size_t first = 0; first < order.size();) {
    double found = 0;
    std::size_t i = first;
    for (; i < order.size() && logOdds[order[i]] == logOdds[order[first]]; ++i) {
      taken += sampleWeights[order[i]];
      found += sampleWeights[order[i]] * labels[order[i]];
    }
    right += found;
    area += found / positives * (right / taken);
    first = i;
  }
  return area;
}

}  // namespace polemcl
