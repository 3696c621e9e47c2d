#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <polemcl/core/PoleLikelihood.h>
#include <polemcl/mrpt/PoleLocalizer.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace polemcl {

using mrpt::bayes::CParticleFilter;
using mrpt::random::CRandomGenerator;
using mrpt::random::getRandomGenerator;

namespace {

/// Lends a generator to MRPT's code in this thread. Swapping the whole object matters: seeding
/// alone leaves the spare deviate of its normal distribution in place.
class GeneratorLoan {
 public:
  explicit GeneratorLoan(CRandomGenerator& generator) : m_generator(generator) {
    std::swap(getRandomGenerator(), m_generator);
  }
  ~GeneratorLoan() { std::swap(getRandomGenerator(), m_generator); }
  GeneratorLoan(const GeneratorLoan&) = delete;
  GeneratorLoan& operator=(const GeneratorLoan&) = delete;

 private:
  CRandomGenerator& m_generator;
};

CParticleFilter::TParticleFilterOptions toMrpt(const FilterOptions& options) {
  CParticleFilter::TParticleFilterOptions result;
  result.PF_algorithm = CParticleFilter::pfStandardProposal;
  result.adaptiveSampleSize = false;
  result.sampleSize = options.particles;
  result.BETA = options.resampleBelow;
  switch (options.resampling) {
    case Resampling::systematic:
      result.resamplingMethod = CParticleFilter::prSystematic;
      break;
    case Resampling::stratified:
      result.resamplingMethod = CParticleFilter::prStratified;
      break;
    case Resampling::multinomial:
      result.resamplingMethod = CParticleFilter::prMultinomial;
      break;
  }
  return result;
}

/// Every n-th of the indices, evenly spaced: of systematically drawn, sorted ones that is a
/// systematic draw again.
std::vector<size_t> thinned(const std::vector<size_t>& indices, size_t count) {
  if (indices.size() <= count) return indices;
  std::vector<size_t> result(count);
  for (size_t i = 0; i < count; ++i) result[i] = indices[i * indices.size() / count];
  return result;
}

[[noreturn]] void refuse(const PoseHypothesis& hypothesis, const std::string& what) {
  throw Error("the start hypothesis at x " + std::to_string(hypothesis.pose.mean.x) + " m, y " +
              std::to_string(hypothesis.pose.mean.y) + " m has " + what);
}

/// Shares of the weight up to and with each hypothesis; the last is exactly 1.
std::vector<double> cumulatedShares(const std::vector<PoseHypothesis>& hypotheses) {
  if (hypotheses.empty()) throw Error("no hypothesis to start from; there must be at least one");
  std::vector<double> result;
  double sum = 0;
  for (const PoseHypothesis& hypothesis : hypotheses) {
    if (!(hypothesis.weight >= 0) || !std::isfinite(hypothesis.weight))
      refuse(hypothesis, "the weight " + std::to_string(hypothesis.weight) +
                             "; it must be a finite number, 0 or more");
    result.push_back(sum += hypothesis.weight);
  }
  if (!(sum > 0) || !std::isfinite(sum))
    throw Error("the weights of the start hypotheses sum up to " + std::to_string(sum) +
                "; the sum must be finite and above 0");
  for (double& share : result) share /= sum;
  return result;
}

/// A matrix R with R·Rᵀ the covariance.
Eigen::Matrix3d rootOf(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

Eigen::Matrix3d checkedRootOf(const PoseHypothesis& hypothesis) {
  const Pose2D& mean = hypothesis.pose.mean;
  const Eigen::Matrix3d& covariance = hypothesis.pose.covariance;
  if (!std::isfinite(mean.x) || !std::isfinite(mean.y) || !std::isfinite(mean.yaw))
    refuse(hypothesis, "a pose that is not finite");
  if (!covariance.allFinite()) refuse(hypothesis, "a covariance that is not finite");
  const double tolerance = 1e-9 * covariance.cwiseAbs().maxCoeff();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > tolerance ||
      solver.eigenvalues()[0] < -tolerance)
    refuse(hypothesis, "a covariance that is not symmetric positive semidefinite");
  return rootOf(covariance);
}

Eigen::Vector3d drawNormals() {
  Eigen::Vector3d normals;
  for (int i = 0; i < 3; ++i) normals[i] = getRandomGenerator().drawGaussian1D_normalized();
  return normals;
}

}  // namespace

PoleLocalizer::PoleLocalizer(std::shared_ptr<const CPoleMap> map,
                             const FilterOptions& filterOptions, std::uint32_t seed)
    : m_map(std::move(map)), m_options(filterOptions), m_generator(seed) {
  m_options.validate();
  if (!m_map || m_map->poles().empty())
    throw Error("the map has no poles: nothing can be localized in it");
  m_filter.m_options = toMrpt(m_options);
}

void PoleLocalizer::start(const StartOptions& start) {
  start.validate();
  if (!start.pose)
    throw Error("no start pose: set position_m and yaw_deg in [start], or give the truth");
  begin(start.particles);
  const GeneratorLoan loan(m_generator);
  CRandomGenerator& random = getRandomGenerator();
  for (auto& particle : m_particles) {
    // The root makes the density uniform in area instead of crowded at the centre.
    const double distance = start.radius * std::sqrt(random.drawUniform(0.0, 1.0));
    const double direction = random.drawUniform(-M_PI, M_PI);
    particle.d.x = start.pose->x + distance * std::cos(direction);
    particle.d.y = start.pose->y + distance * std::sin(direction);
    particle.d.phi = wrapAngle(start.pose->yaw + random.drawUniform(-start.heading, start.heading));
  }
}

void PoleLocalizer::start(const std::vector<PoseHypothesis>& hypotheses, int particles) {
  const std::vector<double> shares = cumulatedShares(hypotheses);
  std::vector<Eigen::Matrix3d> roots;
  for (const PoseHypothesis& hypothesis : hypotheses) roots.push_back(checkedRootOf(hypothesis));
  if (particles < 1 || particles > 1000000)
    throw Error("the filter cannot start with " + std::to_string(particles) +
                " particles; 1 to 1000000 are allowed");
  begin(particles);
  const GeneratorLoan loan(m_generator);
  const double count = static_cast<double>(m_particles.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Pose2D& mean = hypotheses[i].pose.mean;
    for (const double end = std::floor(shares[i] * count + 0.5); next < end; ++next) {
      const Eigen::Vector3d move = roots[i] * drawNormals();
      m_particles[next].d = {mean.x + move.x(), mean.y + move.y(), wrapAngle(mean.yaw + move.z())};
    }
  }
}

void PoleLocalizer::begin(int particles) {
  const bool thinsOut = m_options.resampleBelow > 0;
  m_particles.resize(thinsOut ? std::max(particles, m_options.particles) : m_options.particles);
  for (auto& particle : m_particles) particle.log_w = 0;
  m_started = true;
  m_stepped = false;
}

PoseWithCovariance PoleLocalizer::step(const PoleFrame& frame) {
  if (!m_started) throw Error("the filter has no particles yet: call start() first");
  const std::string when = std::to_string(frame.time) + " s";
  if (!std::isfinite(frame.time) || (m_stepped && frame.time <= m_time))
    throw Error("time does not move on: a scan at " + when + " comes after one at " +
                std::to_string(m_time) + " s");
  mrpt::obs::CActionCollection::Ptr action;
  if (m_stepped) {
    if (!frame.motion)
      throw Error("no motion leads to the scan at " + when + ": the filter needs odometry");
    try {
      action = makeMotionAction(*frame.motion, m_options);
    } catch (const Error& error) {
      throw Error("scan at " + when + ": " + error.what());
    }
  }
  const auto observation = CObservationPoles::Create();
  observation->poles = frame.poles_robot;  // sensorPose stays identity: the robot frame
  mrpt::obs::CSensoryFrame scan;
  scan.insert(observation);

  const GeneratorLoan loan(m_generator);
  m_filter.executeOn(*this, action.get(), &scan);
  m_stepped = true;
  m_time = frame.time;
  return m_estimate;
}

void PoleLocalizer::prediction_and_update_pfStandardProposal(
    const mrpt::obs::CActionCollection* action, const mrpt::obs::CSensoryFrame* observation,
    const CParticleFilter::TParticleFilterOptions& mrptOptions) {
  CMonteCarloLocalization2D::prediction_and_update_pfStandardProposal(action, nullptr, mrptOptions);
  m_report = {};
  if (observation)
    for (const auto& part : *observation)
      if (const auto* poles = dynamic_cast<const CObservationPoles*>(part.get()))
        update(poles->polesInRobotFrame(), mrptOptions);
  // Now, since executeOn() resamples next, which erases the weights.
  m_report.effectiveShare = effectiveShare(logWeights());
  m_report.particles = m_particles.size();
  m_report.resampled = false;
  m_estimate = m_options.estimate == PoseEstimator::bestShare
                   ? bestShareMean(particles(), logWeights(), m_options.bestShare)
                   : weightedMean(particles(), logWeights());
}

void PoleLocalizer::update(const std::vector<PoleDetection>& poles_robot,
                           const CParticleFilter::TParticleFilterOptions& mrptOptions) {
  m_report.poles += poles_robot.size();
  const auto likelihoods = [&](double widening) {
    LikelihoodOptions widened = m_map->likelihoodOptions;
    widened.sigma *= widening;
    std::vector<double> result;
    logLikelihoods(poles_robot, particles(), m_map->index(), widened, result);
    return result;
  };
  // From the prior to the posterior over posteriors of wider likelihoods. The weights of a stage
  // are the ratio of its likelihood to the one the particles have been weighed by already.
  std::vector<double> before(m_particles.size(), 0.0);
  for (double last = 2 * maxWidening;;) {
    double widening = 1;
    std::vector<double> values = likelihoods(widening);
    while (2 * widening < last && !leavesEnough(values, before))
      values = likelihoods(widening *= 2);
    for (std::size_t i = 0; i < values.size(); ++i) m_particles[i].log_w += values[i] - before[i];
    if (widening == 1) return;
    performResampling(mrptOptions);
    ++m_report.temperingStages;
    before = likelihoods(widening);
    last = widening;
  }
}

bool PoleLocalizer::leavesEnough(const std::vector<double>& logLikelihoods,
                                 const std::vector<double>& before) const {
  std::vector<double> weights = logWeights();
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] += logLikelihoods[i] - before[i];
  // Measured by what the filter keeps: after the start there may be many more.
  return effectiveShare(weights) * weights.size() >= m_options.tempering * m_options.particles;
}

void PoleLocalizer::performSubstitution(const std::vector<size_t>& indices) {
  const Eigen::Matrix3d spread = weightedMean(particles(), logWeights()).covariance;
  CMonteCarloLocalization2D::performSubstitution(thinned(indices, m_options.particles));
  for (auto& particle : m_particles) particle.log_w = 0;
  if (m_options.regularization > 0) jitter(spread);
  m_report.resampled = true;
}

void PoleLocalizer::jitter(const Eigen::Matrix3d& spread) {
  const double metres = std::sqrt(std::max(spread(0, 0), spread(1, 1)));
  const double radians = std::sqrt(spread(2, 2));
  double scale = m_options.regularization;
  if (scale * metres > maxJitterMetres) scale = maxJitterMetres / metres;
  if (scale * radians > maxJitterRadians) scale = maxJitterRadians / radians;
  const Eigen::Matrix3d root = scale * rootOf(spread);
  for (auto& particle : m_particles) {
    const Eigen::Vector3d move = root * drawNormals();
    particle.d.x += move.x();
    particle.d.y += move.y();
    particle.d.phi = wrapAngle(particle.d.phi + move.z());
  }
}

std::vector<Pose2D> PoleLocalizer::particles() const {
  std::vector<Pose2D> result;
  result.reserve(m_particles.size());
  for (const auto& particle : m_particles)
    result.push_back({particle.d.x, particle.d.y, particle.d.phi});
  return result;
}

std::vector<double> PoleLocalizer::logWeights() const {
  std::vector<double> result;
  getWeights(result);
  return result;
}

}  // namespace polemcl
