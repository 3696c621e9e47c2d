#pragma once
/// \file LogisticRegression.h
/// \brief Penalized logistic regression, and scores of predicted probabilities.

#include <Eigen/Core>

namespace polemcl {

/// \brief Weights that maximize the weighted likelihood minus ridge / 2 times their squared norm
/// (Newton's method; Hastie, Tibshirani and Friedman 2009, section 4.4). The first weight, that of
/// the constant, is not penalized.
/// \param terms One row per sample, the first column all ones.
/// \param labels 0 or 1. \param sampleWeights Positive, mean about 1.
/// \throws Error when the sizes differ or only one label occurs.
Eigen::VectorXd fitLogistic(const Eigen::MatrixXd& terms, const Eigen::VectorXd& labels,
                            const Eigen::VectorXd& sampleWeights, double ridge);

/// \brief 1 / (1 + exp(-odds)), element by element.
Eigen::VectorXd probabilities(const Eigen::VectorXd& logOdds);

/// \brief Mean of -ln(probability of the true label); 0.693 for a coin.
double logLoss(const Eigen::VectorXd& logOdds, const Eigen::VectorXd& labels,
               const Eigen::VectorXd& sampleWeights);

/// \brief Area under the curve of precision over recall, stepwise; samples of equal odds count
/// together. 1 when all positives lie above all negatives.
double averagePrecision(const Eigen::VectorXd& logOdds, const Eigen::VectorXd& labels,
                        const Eigen::VectorXd& sampleWeights);

/// \brief Coefficients of a log-linear scale s = exp(terms · coefficients) of covariances:
/// maximum likelihood for squared errors that, divided by s, are chi-square of two degrees of
/// freedom. \throws Error when the sizes differ, or without samples.
Eigen::VectorXd fitCovarianceScale(const Eigen::MatrixXd& terms,
                                   const Eigen::VectorXd& squaredErrors,
                                   const Eigen::VectorXd& sampleWeights, double ridge);

}  // namespace polemcl
