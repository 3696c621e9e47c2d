#pragma once
/// \file LikelihoodKernels.h
/// \brief The likelihood of many poses at once, vectorised and chosen at run time. Private to the
/// library.

#include <vector>

#include <polemcl/core/localization/PoleLikelihood.h>
#include "core/common/Covariance.h"

namespace polemcl {

/// \brief One detection, with all that does not depend on the pose.
struct LikelihoodTerm {
  double x, y;         ///< centre, robot frame
  double share;        ///< p: probability of belonging to a map pole
  double floor;        ///< 1 - p, without the rounding of that difference
  double confidence;   ///< c; 1 unless weighted
  PrincipalAxes axes;  ///< of its covariance, robot frame; nothing unless weighted
};

struct LikelihoodBatch {
  std::vector<LikelihoodTerm> terms;
  const PoleIndex& index;
  const LikelihoodOptions& options;
  const std::vector<double>& widenings;  ///< factors on sigma
};

/// \brief out[k][i]: log-likelihood of poses[i] with the sigma times widenings[k].
void likelihoods(const LikelihoodBatch& batch, const std::vector<Pose2D>& poses,
                 std::vector<std::vector<double>>& out);

}  // namespace polemcl
