#pragma once
/// \file ConsistencyEval.h
/// \brief `pole-eval consistency`: are the covariances of `pole-localize` right?

#include <filesystem>
#include <optional>
#include <vector>

#include "core/evaluation/Consistency.h"

namespace polemcl::apps {

struct EvalConsistencyOptions {
  std::vector<std::filesystem::path> truth;   ///< TUM; one for all runs, or one for each
  std::vector<std::filesystem::path> cov;     ///< `run_NN_cov.csv`, see LocalizeApp.h
  std::vector<std::filesystem::path> health;  ///< `run_NN_health.csv` of each run, or empty:
                                              ///< with them, only scans that are `ok` count
  /// Standard deviations of the truth, m and rad, added to the covariances.
  double truthSigma = 0, truthSigmaYaw = 0;
  double skipSeconds = 0;  ///< left out since the first pose, s
  double skipMetres = 20;  ///< and along the true path, m
  std::optional<std::filesystem::path> json;
};

struct ConsistencyResult {
  ConsistencyScore all;                ///< all samples of all runs, each counting the same
  std::vector<ConsistencyScore> runs;  ///< in the order of `cov`
  std::size_t notOk = 0;               ///< poses left out because they are not `ok`
  std::size_t unmatched = 0;           ///< poses left out because the truth does not reach them
};

/// \brief Poses with covariance against the truth, after convergence (core/Consistency.h).
/// \throws Error naming the file: other columns, no pose left, a covariance that is not positive
///         definite; numbers of files that do not fit together.
ConsistencyResult evalConsistency(const EvalConsistencyOptions& options);

}  // namespace polemcl::apps
