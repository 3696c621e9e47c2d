#pragma once
/// \file PoleParticleFilter.h
/// \brief Step D of the paper: Monte Carlo localization in a pole map, on MRPT's particle filter.

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "core/common/PoseEstimate.h"
#include "mrpt/filter/FilterOptions.h"
#include "mrpt/filter/MotionAction.h"
#include "mrpt/map/CPoleMap.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {

/// \brief What one step did.
struct StepReport {
  std::size_t poles = 0;      ///< observed
  std::size_t particles = 0;  ///< before resampling
  double effectiveShare = 1;  ///< of the particles, after the update and before resampling
  int temperingStages = 0;    ///< resamplings inside the update (see FilterOptions::tempering)
  bool resampled = false;     ///< after the update
};

/// \brief A pose the vehicle may have, and how much speaks for it.
struct PoseHypothesis {
  PoseWithCovariance pose;  ///< map frame
  double weight = 1;        ///< 0 or more, in any unit: only ratios count
};

/// \brief Where the vehicle is in a pole map, by particles.
///
/// MRPT's are the sequence (CParticleFilter::executeOn), the decision to resample and the indices
/// drawn; the update asks the map (CPoleMap) once for all particles, as does the prediction by a
/// Gaussian motion. Two defects of MRPT 2.5.8 are worked round: resampling keeps the old weights
/// (here they are reset), and getCovarianceAndMean() loses the sign of heading errors in the cross
/// terms (here the covariance is the core's). share/doc/architecture.md has each step.
///
/// Random numbers come from MRPT's generator of the calling thread, which during start() and step()
/// is replaced by one that belongs to the object. (Seeding MRPT's own does not suffice: it keeps
/// half of the last pair of normal deviates.) So the same seed gives the same results in any thread
/// and beside any other user. Objects may run in parallel and share one map.
class PoleParticleFilter : public mrpt::slam::CMonteCarloLocalization2D {
 public:
  /// Limits of regularization: so that places far apart are not smeared into each other.
  static constexpr double maxJitterMetres = 0.25, maxJitterRadians = 0.035;

  /// The widest likelihood that tempering begins with, as a multiple of `[likelihood] sigma_m`.
  static constexpr double maxWidening = 32;

  /// Distance of poles at which turning by a bin moves them by a bin, m; see narrowestDense().
  static constexpr double leverMetres = 20;

  /// \throws Error when the map has no poles or an option is out of range.
  PoleParticleFilter(std::shared_ptr<const CPoleMap> map, const FilterOptions& filterOptions,
                     std::uint32_t seed);

  /// \brief Draws the particles round a pose: positions uniform in the area of the disc, headings
  /// uniform.
  /// \throws Error when `start.pose` is not set, or an option is out of range.
  void start(const StartOptions& start);

  /// \brief Draws the particles from a mixture of Gaussians, each hypothesis its share by weight
  /// (rounded, so that one below half a particle gets none).
  /// \param particles Until the first resampling, which keeps as many as the options say; smaller
  ///        numbers mean that one.
  /// \throws Error, and changes nothing, without hypotheses; when a weight is negative or not
  ///         finite or all are 0; when a pose is not finite or its covariance not symmetric
  ///         positive semidefinite; when `particles` is not 1 to 1000000.
  void start(const std::vector<PoseHypothesis>& hypotheses, int particles);

  /// \brief Predicts by the motion of the frame, weighs by its poles, estimates, resamples.
  /// The first frame after start() is where the start pose is: its motion is not used. Frames
  /// without poles only predict.
  /// \return The estimate, of FilterOptions::estimateTime, with the covariance of the particles it
  /// is made of.
  /// \throws Error, and changes nothing, before start(); when the time is not later than that of
  ///         the frame before; when the motion is missing, or refused by makeMotionAction().
  PoseWithCovariance step(const PoleFrame& frame);

  std::vector<Pose2D> particles() const;
  std::vector<double> logWeights() const;  ///< natural logarithms, any offset
  const StepReport& report() const { return m_report; }

  /// \name MRPT's interface
  /// @{
  /// \brief Prediction, then the update with all CObservationPoles of the frame by the map's
  /// batched likelihood, times MRPT's `powFactor`. Gaussian motions are predicted in a batch, with
  /// MRPT's maths and normal deviates made of the numbers of its generator; others by MRPT.
  void prediction_and_update_pfStandardProposal(
      const mrpt::obs::CActionCollection* action, const mrpt::obs::CSensoryFrame* observation,
      const mrpt::bayes::CParticleFilter::TParticleFilterOptions& mrptOptions) override;
  /// \brief Copies by index as MRPT's does (with FilterOptions::adaptive by indices of its own;
  /// after a start with more particles by every n-th), then equal weights, then regularization.
  void performSubstitution(const std::vector<size_t>& indices) override;
  /// \brief The effective share of the particles. (MRPT's casts dynamically for each particle.)
  double ESS() const override;
  /// \brief Greatest weight 1. \return Greatest over least, as MRPT's.
  double normalizeWeights(double* out_max_log_w = nullptr) override;
  double getW(size_t i) const override { return m_particles[i].log_w; }
  /// @}

 private:
  void begin(int particles);
  void predict(const mrpt::obs::CActionCollection& action,
               const mrpt::bayes::CParticleFilter::TParticleFilterOptions& mrptOptions);
  void update(const CObservationPoles& scan,
              const mrpt::bayes::CParticleFilter::TParticleFilterOptions& mrptOptions);
  /// \brief The same; what it throws is kept for step().
  void updateRemembering(const CObservationPoles& scan,
                         const mrpt::bayes::CParticleFilter::TParticleFilterOptions& options);
  PoseWithCovariance estimate(const std::vector<double>& weights) const;
  void addToLogWeights(const std::vector<double>& values);
  /// \brief Whether the particles stay many enough with these added to their weights.
  bool leavesEnough(const std::vector<double>& logLikelihoods) const;
  /// \brief Factors on sigma that tempering steps through, ascending from 1.
  std::vector<double> temperingWidenings() const;
  /// \brief Index of the narrowest that does not fall between the particles: where two or more of
  /// them share a bin as wide as its bell. None: all of them do.
  std::optional<std::size_t> narrowestDense(const std::vector<double>& widenings) const;
  /// \brief Indices, as many as KLD sampling asks for.
  std::vector<size_t> drawAdaptively(const std::vector<Pose2D>& poses) const;
  void jitter(const Eigen::Matrix3d& spread);

  std::shared_ptr<const CPoleMap> m_map;
  FilterOptions m_options;
  mrpt::bayes::CParticleFilter m_filter;
  mrpt::random::CRandomGenerator m_generator;
  bool m_started = false, m_stepped = false;
  double m_time = 0;  ///< of the last frame, s
  PoseWithCovariance m_estimate;
  StepReport m_report;
  std::exception_ptr m_failure;
};

}  // namespace polemcl
