#pragma once
/// \file KldSampleSize.h
/// \brief How many particles a posterior needs (KLD sampling: Fox, "Adapting the sample size in
/// particle filters through KLD-sampling", IJRR 2003).

#include <cstddef>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include "core/common/Binder.h"

namespace polemcl {

/// \brief KLD sampling. The numbers of particles are settings of `[filter]`.
struct POLEMCL_EXPORT KldOptions {
  double epsilon = 0.05;  ///< greatest Kullback-Leibler distance to the posterior in bins, nat
  double delta = 0.01;    ///< probability of a greater distance, in (0, 0.5]
  double bin = 0.1;       ///< size of a bin in x and y, m
  double binYaw = 0.017453292519943296;  ///< in heading, rad (1°)
  int minParticles = 200;
  int maxParticles = 10000;
};

POLEMCL_EXPORT void bind(Binder& binder, KldOptions& options);  ///< `[filter]`

/// \brief Bins that hold at least one of the chosen particles. Poses must be finite.
POLEMCL_EXPORT std::size_t occupiedBins(const std::vector<Pose2D>& particles,
                                        const std::vector<std::size_t>& chosen,
                                        const KldOptions& options);

/// \brief n = χ²(k-1, 1-δ) / (2ε), by the approximation of Wilson and Hilferty, rounded up and
/// within the limits of the options. \param bins k; 0 and 1 need no more than the least number.
POLEMCL_EXPORT std::size_t kldSampleSize(std::size_t bins, const KldOptions& options);

}  // namespace polemcl
