#pragma once
/// \file PoleLikelihood.h
/// \brief Step D of the paper: detections x pose x index -> log-likelihood, one pose or a batch.

#include <polemcl/core/PoleIndex.h>
#include <polemcl/core/Types.h>

#include <vector>

namespace polemcl {

enum class LikelihoodModel {
  paper,   ///< Eq. 3: product of exp(-d²/(2σ²)), d clipped at `gate` (a pole without a match costs the gate)
  mixture  ///< (1-w)·exp(-d²/(2σ²)) + w per pole, w the outlier share: bounded, not flat
};

/// \brief `[likelihood]` in INI files.
struct LikelihoodOptions {
  LikelihoodModel model = LikelihoodModel::mixture;
  double sigma = 0.15;       ///< σ_d: standard deviation of a detection against its map pole, m
  double outlier = 0.05;     ///< w: share of detections that belong to no map pole, in (0, 1); mixture only
  double gate = 1.0;         ///< d_max: beyond it a pole has no match, m
  bool weighted = false;     ///< true: σ² grows by each detection's covariance, and confidence scales its term
  void validate() const;     ///< \throws Error
};

/// \brief log p(z | pose) up to a constant. Never NaN or infinite; 0 for no detections.
double logLikelihood(const std::vector<PoleDetection>& poles_robot, const Pose2D& pose_map_robot,
                     const PoleIndex& index, const LikelihoodOptions& options);

/// \brief The same for many poses: out[i] belongs to poses[i]; equal to the single call.
void logLikelihoods(const std::vector<PoleDetection>& poles_robot, const std::vector<Pose2D>& poses,
                    const PoleIndex& index, const LikelihoodOptions& options,
                    std::vector<double>& out);

}  // namespace polemcl
