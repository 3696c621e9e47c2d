#include "mrpt/filter/ParticleDraws.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "core/common/Covariance.h"
#include "core/common/SimdMath.h"

namespace polemcl {

using mrpt::random::getRandomGenerator;

namespace {

[[noreturn]] void refuse(const PoseHypothesis& hypothesis, const std::string& what) {
  throw Error("the start hypothesis at x " + std::to_string(hypothesis.pose.mean.x) + " m, y " +
              std::to_string(hypothesis.pose.mean.y) + " m has " + what);
}

void check(const PoseHypothesis& hypothesis) {
  const Pose2D& mean = hypothesis.pose.mean;
  const Eigen::Matrix3d& covariance = hypothesis.pose.covariance;
  if (!(hypothesis.weight >= 0) || !std::isfinite(hypothesis.weight))
    refuse(hypothesis, "the weight " + std::to_string(hypothesis.weight) +
                           "; it must be a finite number, 0 or more");
  if (!std::isfinite(mean.x) || !std::isfinite(mean.y) || !std::isfinite(mean.yaw))
    refuse(hypothesis, "a pose that is not finite");
  if (!covariance.allFinite()) refuse(hypothesis, "a covariance that is not finite");
  if (!isCovariance(covariance))
    refuse(hypothesis, "a covariance that is not symmetric positive semidefinite");
}

}  // namespace

GeneratorLoan::GeneratorLoan(mrpt::random::CRandomGenerator& generator) : m_generator(generator) {
  std::swap(getRandomGenerator(), m_generator);
}

GeneratorLoan::~GeneratorLoan() {
  std::swap(getRandomGenerator(), m_generator);
}

PoseNoise::PoseNoise(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  m_root = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

const std::vector<Eigen::Vector3d>& PoseNoise::draw(std::size_t count) {
  const std::size_t pairs = (3 * count + 1) / 2;
  std::vector<std::uint32_t> uniform(2 * pairs);
  auto& generator = getRandomGenerator();
  for (auto& number : uniform) number = generator.drawUniform32bit();
  std::vector<double> normals(2 * pairs);
  normalDeviates(uniform.data(), pairs, normals.data());
  m_moves.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    m_moves[i] = m_root * Eigen::Map<const Eigen::Vector3d>(&normals[3 * i]);
  return m_moves;
}

std::vector<std::size_t> drawIndices(Resampling method, const std::vector<double>& logWeights,
                                     std::size_t count) {
  const double greatest = *std::max_element(logWeights.begin(), logWeights.end());
  std::vector<double> sums = logWeights;
  for (double& sum : sums) sum -= greatest;
  exponentials(sums.data(), sums.size());
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  auto& generator = getRandomGenerator();
  const double common = generator.drawUniform(0.0, 1.0);
  std::vector<double> places(count);  // positions in the cumulated weight, as shares
  for (std::size_t i = 0; i < count; ++i) {
    const double own = method == Resampling::systematic ? common : generator.drawUniform(0.0, 1.0);
    places[i] = method == Resampling::multinomial
                    ? own
                    : (static_cast<double>(i) + own) / static_cast<double>(count);
  }
  std::sort(places.begin(), places.end());
  std::vector<std::size_t> result(count);
  std::size_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (next + 1 < sums.size() && sums[next] <= places[i] * sums.back()) ++next;
    result[i] = next;
  }
  return result;
}

std::vector<std::size_t> particlesPerHypothesis(const std::vector<PoseHypothesis>& hypotheses,
                                                std::size_t count) {
  if (hypotheses.empty()) throw Error("no hypothesis to start from; there must be at least one");
  double sum = 0;
  for (const PoseHypothesis& hypothesis : hypotheses) {
    check(hypothesis);
    sum += hypothesis.weight;
  }
  if (!(sum > 0) || !std::isfinite(sum))
    throw Error("the weights of the start hypotheses sum up to " + std::to_string(sum) +
                "; the sum must be finite and above 0");
  std::vector<std::size_t> result;
  double before = 0;
  std::size_t given = 0;
  for (const PoseHypothesis& hypothesis : hypotheses) {
    before += hypothesis.weight;
    const auto end =
        static_cast<std::size_t>(std::llround(before / sum * static_cast<double>(count)));
    result.push_back(end - given);
    given = end;
  }
  return result;
}

}  // namespace polemcl
