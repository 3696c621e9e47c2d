#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <polemcl/core/common/Types.h>
#include "core/evaluation/LogisticRegression.h"

namespace polemcl::test_logistic_regression {

using namespace polemcl;

namespace {

/// Rows of a one and two normal deviates.
Eigen::MatrixXd randomTerms(int rows, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd terms(rows, 3);
  for (int i = 0; i < rows; ++i) terms.row(i) << 1, normal(random), normal(random);
  return terms;
}

}  // namespace

TEST(LogisticRegression, FindsTheWeightsThatDrewTheLabels) {
  std::mt19937 random(1);
  const Eigen::MatrixXd terms = randomTerms(40000, random);
  const Eigen::Vector3d truth(-0.5, 2, -1);
  const Eigen::VectorXd p = probabilities(terms * truth);
  std::uniform_real_distribution<double> uniform;
  Eigen::VectorXd labels(p.size());
  for (Eigen::Index i = 0; i < p.size(); ++i) labels[i] = uniform(random) < p[i];
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(p.size());
  const Eigen::VectorXd fitted = fitLogistic(terms, labels, ones, 1e-6);
  EXPECT_LT((fitted - truth).norm(), 0.06);  // the standard error is about 0.03
  // At the optimum the gradient is zero.
  EXPECT_LT((terms.transpose() * (probabilities(terms * fitted) - labels)).norm(), 1e-3);
  const Eigen::VectorXd shrunk = fitLogistic(terms, labels, ones, 1e4);
  EXPECT_LT(shrunk.tail(2).norm(), 0.7 * fitted.tail(2).norm());
}

TEST(LogisticRegression, AWeightOfTwoCountsAsTwoSamples) {
  Eigen::MatrixXd twice(5, 2), once(4, 2);
  twice << 1, 0, 1, 1, 1, 2, 1, 3, 1, 3;
  once << 1, 0, 1, 1, 1, 2, 1, 3;
  Eigen::VectorXd labels5(5), labels4(4), weights(4);
  labels5 << 0, 1, 0, 1, 1;
  labels4 << 0, 1, 0, 1;
  weights << 1, 1, 1, 2;
  EXPECT_LT((fitLogistic(twice, labels5, Eigen::VectorXd::Ones(5), 0.1) -
             fitLogistic(once, labels4, weights, 0.1))
                .norm(),
            1e-9);
}

TEST(LogisticRegression, RefusesOneLabelAndDifferentSizes) {
  const Eigen::MatrixXd terms = Eigen::MatrixXd::Ones(3, 1);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(3);
  EXPECT_THROW(fitLogistic(terms, ones, ones, 1), Error);
  EXPECT_THROW(fitLogistic(terms, Eigen::VectorXd::Zero(2), ones, 1), Error);
}

TEST(LogisticRegression, SeparableLabelsStayFinite) {
  Eigen::MatrixXd terms(4, 2);
  terms << 1, -2, 1, -1, 1, 1, 1, 2;
  Eigen::VectorXd labels(4);
  labels << 0, 0, 1, 1;
  const Eigen::VectorXd fitted = fitLogistic(terms, labels, Eigen::VectorXd::Ones(4), 0.1);
  EXPECT_TRUE(fitted.allFinite());
  EXPECT_GT(fitted[1], 1);
}

TEST(LogisticRegression, ScoresByHand) {
  Eigen::VectorXd odds(4), labels(4);
  odds << 3, 1, 0, -2;
  labels << 1, 0, 1, 0;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(4);
  const double loss =
      std::log1p(std::exp(-3)) + std::log1p(std::exp(1)) + std::log(2) + std::log1p(std::exp(-2));
  EXPECT_NEAR(logLoss(odds, labels, ones), loss / 4, 1e-12);
  EXPECT_NEAR(averagePrecision(odds, labels, ones), 0.5 * 1 + 0.5 * 2 / 3, 1e-12);
  // The order of samples with equal odds must not matter.
  EXPECT_NEAR(averagePrecision(Eigen::VectorXd::Zero(4), labels, ones), 0.5, 1e-12);
}

TEST(LogisticRegression, NothingToScoreIsZeroAndNothingToFitIsRefused) {
  const Eigen::VectorXd none(0), three = Eigen::VectorXd::Ones(3);
  EXPECT_EQ(logLoss(none, none, none), 0);
  EXPECT_EQ(averagePrecision(three, Eigen::VectorXd::Zero(3), three), 0);
  EXPECT_THROW(fitCovarianceScale(Eigen::MatrixXd(0, 3), none, none, 1), Error);
}

TEST(LogisticRegression, FindsTheScaleOfSquaredErrors) {
  std::mt19937 random(2);
  const Eigen::MatrixXd terms = randomTerms(40000, random);
  const Eigen::Vector3d truth(-1, 0.5, 0.2);
  std::exponential_distribution<double> exponential(0.5);  // chi-square of two degrees of freedom
  Eigen::VectorXd errors(terms.rows());
  for (Eigen::Index i = 0; i < errors.size(); ++i)
    errors[i] = std::exp(terms.row(i) * truth) * exponential(random);
  const Eigen::VectorXd fitted =
      fitCovarianceScale(terms, errors, Eigen::VectorXd::Ones(errors.size()), 1e-6);
  EXPECT_LT((fitted - truth).norm(), 0.03);
}

}  // namespace polemcl::test_logistic_regression
