#pragma once
/// \file FilterOptions.h
/// \brief Settings of the particle filter and of its start, with units, defaults and sources.

#include <cstdint>
#include <optional>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include "core/common/Binder.h"
#include "core/global_localization/GlobalLocalizer.h"
#include "core/localization/KldSampleSize.h"

namespace polemcl {

enum class Resampling { systematic, stratified, multinomial };
enum class PoseEstimator { mean, bestShare };
/// \brief Time at which the estimate of a scan is computed.
enum class EstimateTime {
  beforeResampling,
  /// After resampling, if the scan led to it. All weights are then equal, so `best_share` takes an
  /// arbitrary part of the particles (authors' program).
  afterResampling
};

/// \brief `[filter]` in INI files. The paper's filter: `estimate = best_share`, heaviest_place
/// false, and regularization, tempering and the extra sigmas 0.
struct POLEMCL_EXPORT FilterOptions {
  int particles = 1000;  ///< (paper: 1000 NCLT; authors' program: 500 to 2000)
  /// true: resampling keeps the number of particles that the posterior needs, by the bins it
  /// covers: many while it is spread, few once it has converged. `particles` then only serves
  /// `tempering`.
  bool adaptive = false;
  KldOptions kld;              ///< settings of `adaptive`
  double resampleBelow = 0.5;  ///< resample when the effective share falls below; 0: never (paper)
  Resampling resampling = Resampling::systematic;
  /// `mean`: weighted mean of all particles. `best_share`: of the best by weight (paper: 10 %),
  /// which forgets what earlier scans said about the others.
  PoseEstimator estimate = PoseEstimator::mean;
  double bestShare = 0.1;                                      ///< in (0, 1]; only for `best_share`
  EstimateTime estimateTime = EstimateTime::beforeResampling;  ///< `estimate_time`
  /// Where the particles are spread wide (LocalizationPipeline::wideMetres), the estimate is the
  /// mean of the heaviest of the places they are in, instead of the above. Used by
  /// LocalizationPipeline.
  bool heaviestPlace = true;
  /// After resampling, particles are moved by a Gaussian whose standard deviations are this share
  /// of those of the whole set (a regularized filter: Musso, Oudjane, Le Gland 2001), at most
  /// PoleParticleFilter::maxJitterMetres and maxJitterRadians. 0: copies stay where they are.
  double regularization = 0.2;
  /// A scan that would leave an effective share below this is used in steps: first with a wider
  /// likelihood (2 to 32 times the sigma) that leaves this share, resampling, then a narrower
  /// one, down to the likelihood itself, or to the narrowest that does not fall between the
  /// particles (PoleParticleFilter::narrowestDense). It is what finds the way from the start disc,
  /// where few particles are near the truth. 0: at once.
  double tempering = 0.2;
  /// Noise added to each motion, standard deviations in x and y (m) and heading (rad): odometry
  /// whose error grows with the motion knows (nearly) no error across the driving direction.
  double extraSigma = 0.003;
  double extraSigmaYaw = 0.00034906585039887;  ///< 0.02° (`extra_sigma_deg`)
};

/// \brief Distribution of the start positions in the disc.
enum class StartPositions {
  area,   ///< uniform over the area
  radius  ///< uniform in distance from the centre, so denser there (authors' program)
};

/// \brief Where the filter starts. `[start]` in INI files.
struct POLEMCL_EXPORT StartOptions {
  bool anywhere = false;           ///< true: no start pose, the global search finds it (`anywhere`)
  std::optional<SearchArea> area;  ///< with `anywhere`: only there; no key of INI files
  std::optional<Pose2D> pose;      ///< map frame (`position_m`, `yaw_deg`); none: from the truth
  static constexpr double maxRadius = 10000;  ///< m; farther off the search (`anywhere`) is better
  double radius = 2.5;                        ///< radius of the disc of positions, m (paper)
  StartPositions positions = StartPositions::area;
  double heading = 0.08726646259971647;  ///< headings uniform in ± this, rad (paper: 5°)
  /// Number until the first resampling, which keeps FilterOptions::particles of them. The start
  /// needs more, since few of them are near the truth. Smaller numbers mean that one.
  int particles = 30000;
};

/// \brief Repeated localizations of the same drive. `[runs]` in INI files.
struct POLEMCL_EXPORT RunOptions {
  int runs = 1;            ///< (paper: 10)
  std::uint32_t seed = 1;  ///< seed of the first run; run i uses seed + i
};

POLEMCL_EXPORT void bind(Binder& binder, FilterOptions& options);  ///< `[filter]`
POLEMCL_EXPORT void bind(Binder& binder, StartOptions& options);   ///< `[start]`
POLEMCL_EXPORT void bind(Binder& binder, RunOptions& options);     ///< `[runs]`

}  // namespace polemcl
