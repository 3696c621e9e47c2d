#pragma once
/// \file ParticleDraws.h
/// \brief Random numbers of the particle filter, from MRPT's generator. Private to the library.

#include <mrpt/random/RandomGenerators.h>

#include <vector>

#include "mrpt/filter/PoleParticleFilter.h"

namespace polemcl {

/// \brief Lends a generator to MRPT's code in this thread. The whole object is swapped, because
/// seeding alone does not discard the spare deviate of its normal distribution.
class GeneratorLoan {
 public:
  explicit GeneratorLoan(mrpt::random::CRandomGenerator& generator);
  ~GeneratorLoan();
  GeneratorLoan(const GeneratorLoan&) = delete;
  GeneratorLoan& operator=(const GeneratorLoan&) = delete;

 private:
  mrpt::random::CRandomGenerator& m_generator;
};

/// \brief Draws from N(0, covariance). The root of the covariance is computed as in MRPT's
/// CPoseRandomSampler. The normal deviates are our own (core/common/SimdMath.h), from 32-bit
/// numbers of MRPT's generator in this thread.
class PoseNoise {
 public:
  explicit PoseNoise(const Eigen::Matrix3d& covariance);
  /// \brief Draws `count` samples. \return x, y, yaw of each, m, m, rad; valid until the next call.
  const std::vector<Eigen::Vector3d>& draw(std::size_t count);

 private:
  Eigen::Matrix3d m_root;
  std::vector<Eigen::Vector3d> m_moves;
};

/// \brief Resamples any number of particles; returns ascending indices. (MRPT's computeResampling()
/// computes thresholds for all particles. Asked for fewer, it uses only the first thresholds and so
/// draws only from the particles in front.)
std::vector<std::size_t> drawIndices(Resampling method, const std::vector<double>& logWeights,
                                     std::size_t count);

/// \brief Number of particles for each hypothesis out of `count`: its rounded share by weight.
/// \throws Error as PoleParticleFilter::start() for invalid hypotheses.
std::vector<std::size_t> particlesPerHypothesis(const std::vector<PoseHypothesis>& hypotheses,
                                                std::size_t count);

}  // namespace polemcl
