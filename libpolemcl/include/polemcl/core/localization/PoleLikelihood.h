#pragma once
/// \file PoleLikelihood.h
/// \brief Step D of the paper: detections x pose x index -> log-likelihood, one pose or a batch.

#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

class Binder;
class PoleIndex;  // private to the library

enum class LikelihoodModel {
  paper,  ///< Eq. 3: product of exp(-d²/(2σ²)), d clipped at `gate` (a pole without a match costs
          ///< the gate)
  mixture,  ///< (1-w)·exp(-d²/(2σ²)) + w·o(d) per pole, w the outlier share: bounded, not flat
  floored   ///< N(d; 0, σ²) + floor per pole, d clipped at `gate` (authors' program)
};

/// \brief `[likelihood]` in INI files.
///
/// With `weighted`, detection i with covariance Σ_i and confidence c_i at the offset e from its map
/// pole (covariance Σ_m) counts with S = (σ² + ½ tr Σ_m)·I + Σ_i and m² = eᵀ S⁻¹ e:
///  - mixture: p·(σ²/√det S)·exp(-m²/2) + (1-p)·o(|e|) with p = (1-w)·c_i. The factor σ²/√det S
///    keeps an uncertain detection from weighing like a certain one; with a confidence of 0 all
///    poses are alike.
///  - paper: exp(-c_i·min(m²/2, cost)), where a pole without a match costs `gate` at the isotropic
///    part of S without Σ_m: cost = gate²/(2σ² + tr Σ_i).
///
/// o(d) = f + (1-f)·c_i·(1-(d/gate)²)³, f without a match. A bad fit beside a map pole is
/// likelier than a detection where the map has no pole. This tells a place where many poles fit
/// roughly from one where few fit well, while no pole pulls harder than an outlier may.
struct POLEMCL_EXPORT LikelihoodOptions {
  LikelihoodModel model = LikelihoodModel::mixture;
  double sigma = 0.05;      ///< σ_d: standard deviation of a detection from its map pole, m
  double outlier = 0.05;    ///< w: share of detections not on the map, in [1e-9, 1); mixture only
  double farOutlier = 0.1;  ///< f: in [1e-3, 1]; 1: all outliers are alike; mixture only
  double floor = 0.2;       ///< added to the density, 1/m, > 0; floored only
  double gate = 1.0;        ///< d_max: beyond it a pole has no match, m
  bool weighted = true;     ///< true: each detection counts by its covariance and confidence; not
                            ///< with `floored`
};

POLEMCL_EXPORT void bind(Binder& binder, LikelihoodOptions& options);  ///< `[likelihood]`

/// \brief log p(z | pose) up to a constant; finite; 0 for no detections.
///
/// Each detection counts for itself, by its nearest map pole within the gate (strictly). The grid
/// of the index finds it if the index is prepared for the gate, else nanoflann's tree, which is
/// slower; the numbers are the same. A detection or pose that is not a number matches nothing.
/// \throws Error on options out of range; with `weighted` also on a detection whose covariance is
///         not symmetric positive semidefinite, or whose confidence is outside [0, 1].
POLEMCL_EXPORT double logLikelihood(const std::vector<PoleDetection>& poles_robot,
                                    const Pose2D& pose_map_robot, const PoleIndex& index,
                                    const LikelihoodOptions& options);

/// \brief The same for many poses: out[i] belongs to poses[i]; the same numbers as the single call.
POLEMCL_EXPORT void logLikelihoods(const std::vector<PoleDetection>& poles_robot,
                                   const std::vector<Pose2D>& poses, const PoleIndex& index,
                                   const LikelihoodOptions& options, std::vector<double>& out);

/// \brief How many sigmas widenedLogLikelihoods() takes at once.
constexpr std::size_t maxWidenings = 8;
/// \brief The same for several sigmas at once, which share the search for the nearest pole:
/// out[k][i] belongs to poses[i] with widenings[k] times `options.sigma`. \throws Error as
/// logLikelihood(), and on more than maxWidenings.
POLEMCL_EXPORT void widenedLogLikelihoods(const std::vector<PoleDetection>& poles_robot,
                                          const std::vector<Pose2D>& poses, const PoleIndex& index,
                                          const LikelihoodOptions& options,
                                          const std::vector<double>& widenings,
                                          std::vector<std::vector<double>>& out);

}  // namespace polemcl
