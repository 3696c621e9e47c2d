#pragma once
/// \file ParticleDraws.h
/// \brief Random numbers of the particle filter, from MRPT's generator. Private to the library.

#include <mrpt/random/RandomGenerators.h>

#include <vector>

#include "mrpt/filter/PoleParticleFilter.h"

namespace polemcl {

/// \brief Lends a generator to MRPT's code in this thread. Swapping the whole object matters:
/// seeding alone leaves the spare deviate of its normal distribution in place.
class GeneratorLoan {
 public:
  explicit GeneratorLoan(mrpt::random::CRandomGenerator& generator);
  ~GeneratorLoan();
  GeneratorLoan(const GeneratorLoan&) = delete;
  GeneratorLoan& operator=(const GeneratorLoan&) = delete;

 private:
  mrpt::random::CRandomGenerator& m_generator;
};

/// \brief Draws from N(0, covariance): the root of the covariance as MRPT's CPoseRandomSampler has
/// it, normal deviates of our own (core/SimdMath.h) from 32-bit numbers of MRPT's generator in
/// this thread.
class PoseNoise {
 public:
  explicit PoseNoise(const Eigen::Matrix3d& covariance);
  /// \brief Draws so many. \return x, y, yaw of each, m, m, rad; valid until the next call.
  const std::vector<Eigen::Vector3d>& draw(std::size_t count);

 private:
  Eigen::Matrix3d m_root;
  std::vector<Eigen::Vector3d> m_moves;
};

/// \brief Resamples any number of particles: ascending indices. (MRPT's computeResampling(), asked
/// for fewer than there are, draws only from those in front: the thresholds of all, the first of
/// them used.)
std::vector<std::size_t> drawIndices(Resampling method, const std::vector<double>& logWeights,
                                     std::size_t count);

/// \brief Particles that each hypothesis gets of so many: the rounded share of its weight.
/// \throws Error as PoleParticleFilter::start() does about hypotheses.
std::vector<std::size_t> particlesPerHypothesis(const std::vector<PoseHypothesis>& hypotheses,
                                                std::size_t count);

}  // namespace polemcl
