#pragma once
/// \file PoleParticleFilter.h
/// \brief Step D of the paper: Monte Carlo localization in a pole map, on MRPT's particle filter.

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <polemcl/core/localization/LocalizationUpdate.h>
#include <polemcl/export.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include "core/common/PoseEstimate.h"
#include "mrpt/filter/FilterOptions.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {

/// \brief Share of a frame's information that is new. Frames that follow each other closely see the
/// same poles with the same errors, so they count less than once. Each share is from 0 to 1.
struct NewShares {
  double chance = 1;  ///< poles without a match: power of LikelihoodOptions::farOutlier
  double all = 1;     ///< all poles: factor on their log likelihoods
};

/// \brief A possible pose of the vehicle, with a weight.
struct PoseHypothesis {
  PoseWithCovariance pose;  ///< map frame
  double weight = 1;        ///< 0 or more, in any unit: only ratios matter
};

/// \brief Estimates the pose of the vehicle in a pole map with particles.
///
/// MRPT provides the sequence of steps (CParticleFilter::executeOn), the decision to resample and
/// the drawn indices. The update asks the map (CPoleMap) once for all particles. The prediction by
/// a Gaussian motion also handles all particles at once. Two defects of MRPT 2.5.8 are avoided. Its
/// resampling keeps the old weights; here they are reset. Its getCovarianceAndMean() loses the sign
/// of heading errors in the cross terms; here the covariance is computed by the core.
/// share/doc/filter.md describes each step.
///
/// Random numbers come from MRPT's generator of the calling thread. During start() and step() it is
/// replaced by a generator that belongs to the object. (Seeding MRPT's own generator is not enough:
/// it keeps half of the last pair of normal deviates.) The same seed therefore gives the same
/// results in any thread and beside any other user. Objects may run in parallel and share one map.
class POLEMCL_EXPORT PoleParticleFilter : public mrpt::slam::CMonteCarloLocalization2D {
 public:
  /// Limits of regularization: they prevent smearing of separate places into each other.
  static constexpr double maxJitterMetres = 0.25, maxJitterRadians = 0.035;

  /// Widest likelihood at the start of tempering, as a multiple of `[likelihood] sigma_m`.
  static constexpr double maxWidening = 32;

  /// Distance at which a rotation by one bin moves a pole by one bin, m; see narrowestDense().
  static constexpr double leverMetres = 20;

  /// \throws Error when the map has no poles or an option is out of range.
  PoleParticleFilter(std::shared_ptr<const CPoleMap> map, const FilterOptions& filterOptions,
                     std::uint32_t seed);

  /// \brief Draws the particles around a pose: positions in the disc as `start.positions` says,
  /// headings uniform.
  /// \throws Error when `start.pose` is not set, or an option is out of range.
  void start(const StartOptions& start);

  /// \brief Draws the particles from a mixture of Gaussians. Each hypothesis gets its share by
  /// weight (rounded, so that a share below half a particle gets none).
  /// \param particles Number until the first resampling, which reduces it to the number in the
  ///        options. Smaller values are raised to that number, and so are all if the filter
  ///        resamples in each step.
  /// \throws Error without hypotheses; when a weight is negative or not finite, or all weights are
  ///         0; when a pose is not finite or its covariance not symmetric positive semidefinite;
  ///         when `particles` is not 1 to 1000000. The state is then unchanged.
  void start(const std::vector<PoseHypothesis>& hypotheses, int particles);

  /// \brief Predicts by the motion of the frame, weighs by its poles, estimates, resamples.
  /// The start pose is the pose of the first frame after start(), so its motion is ignored. Frames
  /// without poles only predict.
  /// \return The estimate at FilterOptions::estimateTime, with the covariance of the particles
  ///         used.
  /// \throws Error before start(); when the time is not later than that of the previous frame; when
  ///         the motion is missing, or rejected by makeMotionAction(); as logLikelihoods() of the
  ///         map. The state is then unchanged.
  PoseWithCovariance step(const PoleScan& frame, const NewShares& shares = {});

  std::vector<Pose2D> particles() const;
  std::vector<double> logWeights() const;  ///< natural logarithms, up to a common constant
  const StepReport& report() const { return m_report; }

  /// \name MRPT's interface
  /// @{
  /// \brief Prediction, then the update with all CObservationPoles of the frame by the map's
  /// batched likelihood, times MRPT's `powFactor`. Gaussian motions are predicted for all particles
  /// at once, with MRPT's maths and normal deviates from its generator's numbers. Other motions are
  /// predicted by MRPT.
  void prediction_and_update_pfStandardProposal(
      const mrpt::obs::CActionCollection* action, const mrpt::obs::CSensoryFrame* observation,
      const mrpt::bayes::CParticleFilter::TParticleFilterOptions& mrptOptions) override;
  /// \brief Copies particles by index as MRPT does, then resets the weights, then regularizes. With
  /// FilterOptions::adaptive the indices are drawn again. If there are more particles than wanted
  /// (after the start), every n-th index is used.
  void performSubstitution(const std::vector<size_t>& indices) override;
  /// \brief Effective share of the particles. (MRPT's version does a dynamic cast per particle.)
  double ESS() const override;
  /// \brief Scales the greatest weight to 1. \return Ratio of greatest to smallest weight, as in
  /// MRPT.
  double normalizeWeights(double* out_max_log_w = nullptr) override;
  double getW(size_t i) const override { return m_particles[i].log_w; }
  /// @}

 private:
  void begin(int particles);
  void predict(const mrpt::obs::CActionCollection& action,
               const mrpt::bayes::CParticleFilter::TParticleFilterOptions& mrptOptions);
  void update(const CObservationPoles& scan,
              const mrpt::bayes::CParticleFilter::TParticleFilterOptions& mrptOptions);
  PoseWithCovariance estimate(const std::vector<double>& weights) const;
  void addToLogWeights(const std::vector<double>& values);
  /// \brief Whether enough effective particles remain with these values added to the log weights.
  bool leavesEnough(const std::vector<double>& logLikelihoods) const;
  /// \brief Factors on sigma for the tempering stages, ascending from 1.
  std::vector<double> temperingWidenings() const;
  /// \brief Index of the narrowest likelihood that is not too narrow for the particles: on average
  /// two or more of them share a bin as wide as its bell. Nullopt if all are too narrow.
  std::optional<std::size_t> narrowestDense(const std::vector<double>& widenings) const;
  /// \brief Draws as many indices as KLD sampling asks for.
  std::vector<size_t> drawAdaptively(const std::vector<Pose2D>& poses) const;
  void jitter(const Eigen::Matrix3d& spread);

  std::shared_ptr<const CPoleMap> m_map;
  FilterOptions m_options;
  mrpt::bayes::CParticleFilter m_filter;
  mrpt::random::CRandomGenerator m_generator;
  bool m_started = false;
  std::optional<double> m_time;  ///< time of the last frame since the start, s
  NewShares m_newShares;         ///< of the frame in step()
  PoseWithCovariance m_estimate;
  StepReport m_report;
};

}  // namespace polemcl
