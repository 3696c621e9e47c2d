#include "mrpt/filter/PoleParticleFilter.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/common/Binder.h"
#include "core/common/SimdMath.h"
#include "mrpt/common/MrptReason.h"
#include "mrpt/filter/MotionAction.h"
#include "mrpt/filter/ParticleDraws.h"

namespace polemcl {

using mrpt::bayes::CParticleFilter;
using mrpt::random::CRandomGenerator;
using mrpt::random::getRandomGenerator;

namespace {

constexpr int kMostParticles = 1000000;

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

/// Every n-th of the indices, evenly spaced. Thinned systematic draws (sorted) are again a
/// systematic draw.
std::vector<size_t> thinned(const std::vector<size_t>& indices, size_t count) {
  if (indices.size() <= count) return indices;
  std::vector<size_t> result(count);
  for (size_t i = 0; i < count; ++i) result[i] = indices[i * indices.size() / count];
  return result;
}

/// Bins as wide as a bell with this sigma, in x, y and heading.
KldOptions binsOf(double sigma) {
  KldOptions bins;
  bins.bin = 2 * sigma;
  bins.binYaw = bins.bin / PoleParticleFilter::leverMetres;
  return bins;
}

/// Whether on average two or more particles share a bin as wide as a bell with this sigma. With
/// sparser particles the bell falls between them, and the result depends on chance.
bool areDense(const std::vector<Pose2D>& poses, double sigma) {
  std::vector<std::size_t> all(poses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return 2 * occupiedBins(poses, all, binsOf(sigma)) <= all.size();
}

/// Sufficient and faster check: particles are dense if their bounding box holds few enough bins.
bool lieWithinFewBins(const std::vector<Pose2D>& poses, double sigma) {
  Eigen::Array3d low = Eigen::Array3d::Constant(INFINITY), high = -low;
  for (const Pose2D& pose : poses) {
    const Eigen::Array3d place(pose.x, pose.y, pose.yaw);
    low = low.min(place);
    high = high.max(place);
  }
  const KldOptions bins = binsOf(sigma);
  const Eigen::Array3d size(bins.bin, bins.bin, bins.binYaw);
  return 2 * ((high - low) / size + 2).prod() <= static_cast<double>(poses.size());
}

/// The Gaussian motion of an action; null without a motion or with another distribution.
std::shared_ptr<const mrpt::poses::CPosePDFGaussian> gaussianMotion(
    const mrpt::obs::CActionCollection& action) {
  const auto movement = action.getBestMovementEstimation();
  if (!movement || !movement->poseChange) return nullptr;
  return std::dynamic_pointer_cast<const mrpt::poses::CPosePDFGaussian>(
      movement->poseChange.get_ptr());
}

}  // namespace

PoleParticleFilter::PoleParticleFilter(std::shared_ptr<const CPoleMap> map,
                                       const FilterOptions& filterOptions, std::uint32_t seed)
    : m_map(std::move(map)), m_options(filterOptions), m_generator(seed) {
  checkOptions(m_options);
  if (!m_map || m_map->poles().empty())
    throw Error("the map has no poles: nothing can be localized in it");
  m_filter.m_options = toMrpt(m_options);
}

void PoleParticleFilter::start(const StartOptions& start) {
  checkOptions(start);
  if (!start.pose)
    throw Error(
        "no start pose: set position_m and yaw_deg in [start], or give a pose or the truth");
  begin(start.particles);
  const GeneratorLoan loan(m_generator);
  CRandomGenerator& random = getRandomGenerator();
  for (auto& particle : m_particles) {
    const double share = random.drawUniform(0.0, 1.0);
    // The square root makes the density uniform over the area instead of denser at the centre.
    const bool crowded = start.positions == StartPositions::radius;
    const double distance = start.radius * (crowded ? share : std::sqrt(share));
    const double direction = random.drawUniform(-M_PI, M_PI);
    particle.d.x = start.pose->x + distance * std::cos(direction);
    particle.d.y = start.pose->y + distance * std::sin(direction);
    particle.d.phi = wrapAngle(start.pose->yaw + random.drawUniform(-start.heading, start.heading));
  }
}

void PoleParticleFilter::start(const std::vector<PoseHypothesis>& hypotheses, int particles) {
  particlesPerHypothesis(hypotheses, 1);  // rejects invalid hypotheses before any change
  if (particles < 1 || particles > kMostParticles)
    throw Error("the filter cannot start with " + std::to_string(particles) + " particles; 1 to " +
                std::to_string(kMostParticles) + " are allowed");
  begin(particles);
  const GeneratorLoan loan(m_generator);
  const auto counts = particlesPerHypothesis(hypotheses, m_particles.size());
  auto next = m_particles.begin();
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Pose2D& mean = hypotheses[i].pose.mean;
    PoseNoise noise(hypotheses[i].pose.covariance);
    for (const Eigen::Vector3d& move : noise.draw(counts[i]))
      (next++)->d = {mean.x + move.x(), mean.y + move.y(), wrapAngle(mean.yaw + move.z())};
  }
}

void PoleParticleFilter::begin(int particles) {
  const bool thinsOut = m_options.resampleBelow > 0;
  const int least = m_options.adaptive ? m_options.kld.minParticles : m_options.particles;
  m_particles.resize(thinsOut ? std::max(particles, least) : least);
  for (auto& particle : m_particles) particle.log_w = 0;
  m_started = true;
  m_time.reset();
}

PoseWithCovariance PoleParticleFilter::step(const PoleScan& frame, const NewShares& shares) {
  if (!m_started) throw Error("the filter has no particles yet: call start() first");
  requireStep(frame, m_time);
  const auto observation = CObservationPoles::Create();
  observation->poles = frame.poles_robot;  // sensorPose stays identity: robot frame
  mrpt::obs::CSensoryFrame scan;
  scan.insert(observation);
  const auto action = m_time ? makeMotionAction(*frame.motion, m_options) : nullptr;
  m_newShares = shares;
  const GeneratorLoan loan(m_generator);
  try {
    m_filter.executeOn(*this, action.get(), &scan);
  } catch (const std::exception& error) {  // MRPT's own, with the call stack
    throw Error(mrptReason(error.what()));
  }
  m_time = frame.time;
  return m_estimate;
}

void PoleParticleFilter::prediction_and_update_pfStandardProposal(
    const mrpt::obs::CActionCollection* action, const mrpt::obs::CSensoryFrame* observation,
    const CParticleFilter::TParticleFilterOptions& mrptOptions) {
  if (action) predict(*action, mrptOptions);
  m_report = {};
  if (observation)
    for (const auto& part : *observation)
      if (const auto* poles = dynamic_cast<const CObservationPoles*>(part.get()))
        update(*poles, mrptOptions);
  // Estimate now: executeOn() resamples next, which erases the weights.
  const std::vector<double> weights = logWeights();
  m_report.effectiveShare = effectiveShare(weights);
  m_report.particles = m_particles.size();
  m_report.resampled = false;
  m_estimate = estimate(weights);
}

PoseWithCovariance PoleParticleFilter::estimate(const std::vector<double>& weights) const {
  return m_options.estimate == PoseEstimator::bestShare
             ? bestShareMean(particles(), weights, m_options.bestShare)
             : weightedMean(particles(), weights);
}

void PoleParticleFilter::predict(const mrpt::obs::CActionCollection& action,
                                 const CParticleFilter::TParticleFilterOptions& mrptOptions) {
  const auto motion = gaussianMotion(action);
  if (!motion)  // MRPT knows many more kinds
    return CMonteCarloLocalization2D::prediction_and_update_pfStandardProposal(&action, nullptr,
                                                                               mrptOptions);
  std::vector<double> yaw;
  yaw.reserve(m_particles.size());
  for (const auto& particle : m_particles) yaw.push_back(particle.d.phi);
  std::vector<double> sine(yaw.size()), cosine(yaw.size());
  sinesAndCosines(yaw.data(), yaw.size(), sine.data(), cosine.data());
  PoseNoise noise(Eigen::Matrix3d(motion->cov.asEigen()));
  const auto& moves = noise.draw(yaw.size());
  std::size_t i = 0;
  for (auto& particle : m_particles) {
    const double x = motion->mean.x() + moves[i].x(), y = motion->mean.y() + moves[i].y();
    particle.d.x += cosine[i] * x - sine[i] * y;
    particle.d.y += sine[i] * x + cosine[i] * y;
    particle.d.phi = wrapAngle(yaw[i] + (motion->mean.phi() + moves[i].z()));
    ++i;
  }
}

void PoleParticleFilter::update(const CObservationPoles& scan,
                                const CParticleFilter::TParticleFilterOptions& mrptOptions) {
  if (scan.poles.empty()) return;  // says nothing: tempering would only spread the particles
  m_report.poles += scan.poles.size();
  LikelihoodOptions likelihood = m_map->likelihoodOptions;
  likelihood.farOutlier = std::pow(likelihood.farOutlier, m_newShares.chance);
  const double power = mrptOptions.powFactor * m_newShares.all;
  std::vector<std::vector<double>> values;  // by widening
  const auto evaluate = [&](const std::vector<double>& widenings) {
    m_map->widenedLogLikelihoods(scan, likelihood, particles(), widenings, values);
    if (power == 1) return;
    for (auto& ofOneWidening : values)
      for (double& value : ofOneWidening) value *= power;
  };
  const auto weigh = [&](std::vector<double> ratios, const std::vector<double>& before) {
    for (std::size_t i = 0; i < before.size(); ++i) ratios[i] -= before[i];
    return ratios;
  };
  const auto addAtOnce = [&](bool always) {
    evaluate({1});
    const bool adds = always || leavesEnough(values[0]);
    if (adds) addToLogWeights(values[0]);
    return adds;
  };
  if (m_options.tempering == 0) return void(addAtOnce(true));
  // Goes from the prior to the posterior over posteriors of wider likelihoods. The weights of a
  // stage are the ratio of its likelihood to the likelihood already applied to the particles.
  const std::vector<double> widenings = temperingWidenings();
  std::optional<std::size_t> weighed;
  while (true) {
    const std::optional<std::size_t> dense = narrowestDense(widenings);
    // Narrower likelihoods would fall between the particles; later scans will decide.
    if (weighed && (!dense || *dense >= *weighed)) return;
    const std::size_t widest = weighed.value_or(widenings.size() - 1);
    const std::size_t narrowest = dense.value_or(widest);
    if (!weighed && narrowest == 0 && addAtOnce(false)) return;
    evaluate({widenings.begin() + narrowest, widenings.begin() + widest + 1});
    const std::vector<double> before =
        weighed ? values.back() : std::vector<double>(m_particles.size(), 0.0);
    const std::size_t most = widest - narrowest - (weighed ? 1 : 0);
    std::size_t k = 0;
    while (k < most && !leavesEnough(weigh(values[k], before))) ++k;
    addToLogWeights(weigh(values[k], before));
    if (narrowest + k == 0 || !dense) return;
    performResampling(mrptOptions);
    ++m_report.temperingStages;
    weighed = narrowest + k;
  }
}

std::vector<double> PoleParticleFilter::temperingWidenings() const {
  const LikelihoodOptions& likelihood = m_map->likelihoodOptions;
  // A bell wider than half the gate is cut off at the gate and attracted by chance matches.
  const double widestSigma = std::max(8 * likelihood.sigma, 0.5 * likelihood.gate);
  std::vector<double> widenings;
  for (double widening = 1;
       widening <= maxWidening && widening * likelihood.sigma <= widestSigma * (1 + 1e-9);
       widening *= 2)
    widenings.push_back(widening);
  return widenings;
}

std::optional<std::size_t> PoleParticleFilter::narrowestDense(
    const std::vector<double>& widenings) const {
  const std::vector<Pose2D> poses = particles();
  const double sigma = m_map->likelihoodOptions.sigma;
  if (lieWithinFewBins(poses, sigma * widenings[0])) return 0;
  std::size_t k = widenings.size();
  while (k > 0 && areDense(poses, sigma * widenings[k - 1])) --k;
  return k < widenings.size() ? std::optional(k) : std::nullopt;
}

void PoleParticleFilter::addToLogWeights(const std::vector<double>& values) {
  std::size_t i = 0;
  for (auto& particle : m_particles) particle.log_w += values[i++];
}

bool PoleParticleFilter::leavesEnough(const std::vector<double>& logLikelihoods) const {
  std::vector<double> weights = logWeights();
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] += logLikelihoods[i];
  // Relative to the number that the filter keeps: after the start there may be many more.
  const auto all = static_cast<double>(weights.size());
  const auto kept = std::min(all, static_cast<double>(m_options.particles));
  return effectiveShare(weights) * all >= m_options.tempering * kept;
}

double PoleParticleFilter::ESS() const {
  return effectiveShare(logWeights());
}

double PoleParticleFilter::normalizeWeights(double* out_max_log_w) {
  double least = INFINITY, greatest = -INFINITY;
  for (const auto& particle : m_particles) {
    least = std::min(least, particle.log_w);
    greatest = std::max(greatest, particle.log_w);
  }
  for (auto& particle : m_particles) particle.log_w -= greatest;
  if (out_max_log_w) *out_max_log_w = greatest;
  return std::exp(greatest - least);
}

void PoleParticleFilter::performSubstitution(const std::vector<size_t>& indices) {
  const std::vector<Pose2D> before = particles();
  std::vector<size_t> chosen =
      m_options.adaptive ? drawAdaptively(before) : thinned(indices, m_options.particles);
  std::sort(chosen.begin(), chosen.end());
  const Eigen::Matrix3d spread = weightedMean(before, logWeights()).covariance;
  m_particles.resize(chosen.size());
  auto next = chosen.begin();
  for (auto& particle : m_particles) {
    const Pose2D& pose = before[*next++];
    particle.d = {pose.x, pose.y, pose.yaw};
    particle.log_w = 0;
  }
  if (m_options.regularization > 0) jitter(spread);
  if (m_options.estimateTime == EstimateTime::afterResampling) m_estimate = estimate(logWeights());
  m_report.resampled = true;
}

std::vector<size_t> PoleParticleFilter::drawAdaptively(const std::vector<Pose2D>& poses) const {
  const std::vector<double> weights = logWeights();
  std::vector<size_t> chosen;
  std::size_t wanted = m_options.kld.minParticles;
  // Fox draws one by one until the number is sufficient for the bins met so far. Systematic
  // resampling needs the number in advance, so it draws again with the number for the bins of the
  // last draw.
  do {
    chosen = drawIndices(m_options.resampling, weights, wanted);
    wanted = kldSampleSize(occupiedBins(poses, chosen, m_options.kld), m_options.kld);
  } while (wanted > chosen.size());
  return chosen;
}

void PoleParticleFilter::jitter(const Eigen::Matrix3d& spread) {
  const double metres = std::sqrt(std::max(spread(0, 0), spread(1, 1)));
  const double radians = std::sqrt(spread(2, 2));
  double scale = m_options.regularization;
  if (scale * metres > maxJitterMetres) scale = maxJitterMetres / metres;
  if (scale * radians > maxJitterRadians) scale = maxJitterRadians / radians;
  PoseNoise noise(scale * scale * spread);
  auto move = noise.draw(m_particles.size()).begin();
  for (auto& particle : m_particles) {
    particle.d.x += move->x();
    particle.d.y += move->y();
    particle.d.phi = wrapAngle(particle.d.phi + move->z());
    ++move;
  }
}

std::vector<Pose2D> PoleParticleFilter::particles() const {
  std::vector<Pose2D> result;
  result.reserve(m_particles.size());
  for (const auto& particle : m_particles)
    result.push_back({particle.d.x, particle.d.y, particle.d.phi});
  return result;
}

std::vector<double> PoleParticleFilter::logWeights() const {
  std::vector<double> result;
  getWeights(result);
  return result;
}

}  // namespace polemcl
