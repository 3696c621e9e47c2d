#pragma once
/// \file ClassifierTraining.h
/// \brief `pole-eval train`: fits the pole classifier and the scale of the covariances.

#include <filesystem>
#include <optional>
#include <vector>

#include "cli/JsonFile.h"
#include "eval/TrainingCandidates.h"

namespace polemcl::apps {

/// \brief `pole-eval train`.
struct TrainOptions {
  std::vector<std::filesystem::path> candidates;  ///< tables to fit to, one per drive
  std::vector<std::filesystem::path> test;        ///< tables that are only scored
  int products = 20;                              ///< number of products of two terms
  double ridge = 100;                             ///< penalty of the squared weights
  double realWeight = 4;  ///< weight of a candidate of a real drive; one of a simulated drive has 1
  std::filesystem::path classifier;                 ///< table of weights to write (CSV)
  std::optional<std::filesystem::path> covariance;  ///< the same of the scale of covariances
  bool crossValidate = true;                        ///< leave one drive out
  std::optional<std::filesystem::path> json;        ///< report to write
};

/// \brief Log loss and average precision of one drive.
struct DriveScore {
  std::string drive, sensor;
  bool real = false;
  bool leftOut = true;  ///< of the fit that it is scored by; false: a test drive
  std::size_t candidates = 0, poles = 0;
  double builtInLoss = 0, loss = 0;            ///< of the weights built in, and of new ones
  double builtInPrecision = 0, precision = 0;  ///< average precision
};

/// \brief Fits weights to all candidates and writes them. With `crossValidate`, each fitted drive
/// is scored by weights fitted to the others (leave one drive out; drives of one world and several
/// sensors count as several).
/// \throws Error naming the file, or when a fit lacks poles or others.
std::vector<DriveScore> trainClassifier(const TrainOptions& options);

}  // namespace polemcl::apps
