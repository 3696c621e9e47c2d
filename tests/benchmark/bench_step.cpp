/// \file bench_step.cpp
/// \brief A whole step of the filter (predict, update, estimate, resample), compared with MRPT's
/// own.
///
/// 1000 particles, 10 observed poles, a map of 2000 poles along streets of 6 km; particles within 1
/// m of the truth, or all over the map. Each step starts with the same particles, so that all steps
/// cost the same. MRPT's step is CMonteCarloLocalization2D with a CPoleMap of the same likelihood,
/// which is evaluated once per particle.

#include <benchmark/benchmark.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cmath>
#include <random>

#include "mrpt/filter/LocalizationPipeline.h"
#include "mrpt/filter/MotionAction.h"
#include "mrpt/filter/PoleParticleFilter.h"

using namespace polemcl;

namespace {

class Scene {
 public:
  Scene() {
    std::vector<MapPole> poles;
    for (int i = 0; i < 2000; ++i) {  // a square of 1.5 km, poles on both sides of its streets
      const double along = uniform(0, 1500), beside = uniform(-15, 15);
      const int side = i % 4;
      MapPole pole;
      pole.x = side == 0 ? beside : side == 1 ? 1500 + beside : along;
      pole.y = side == 2 ? beside : side == 3 ? 1500 + beside : along;
      pole.covariance = Eigen::Matrix2d::Identity() * 4e-4;
      poles.push_back(pole);
    }
    map = std::make_shared<CPoleMap>();
    map->likelihoodOptions.sigma = 0.05;
    map->likelihoodOptions.weighted = true;
    map->setPoles(poles);
    for (const MapPole& pole : poles) observe(pole);
    frame.motion.emplace();
    frame.motion->mean = {0.5, 0.01, 0.005};
    frame.motion->covariance = Eigen::Vector3d(1e-4, 1e-6, 1e-6).asDiagonal();
  }
  double uniform(double low, double high) {
    return low + (high - low) * 0x1p-64 * static_cast<double>(m_random());
  }
  std::vector<mrpt::math::TPose2D> particles(int count, bool overTheMap) {
    std::vector<mrpt::math::TPose2D> result;
    for (int i = 0; i < count; ++i) {
      const MapPole& near = map->poles()[m_random() % map->poles().size()];
      result.emplace_back((overTheMap ? near.x : truth.x) + uniform(-1, 1),
                          (overTheMap ? near.y : truth.y) + uniform(-1, 1),
                          overTheMap ? uniform(-M_PI, M_PI) : truth.yaw + uniform(-0.05, 0.05));
    }
    return result;
  }

  /// Until the scan has `count` poles.
  void addClutter(std::size_t count) {
    while (frame.poles_robot.size() < count) {
      PoleDetection clutter;
      clutter.x = uniform(-50, 50);
      clutter.y = uniform(-50, 50);
      clutter.confidence = 0.5;
      frame.poles_robot.push_back(clutter);
    }
  }

  const Pose2D truth{700, 1, 0.02};
  std::shared_ptr<CPoleMap> map;
  PoleScan frame;

 private:
  void observe(const MapPole& pole) {
    const Pose2D seen = relative(truth, {pole.x, pole.y, 0});
    if (frame.poles_robot.size() == 10 || std::hypot(seen.x, seen.y) > 60) return;
    PoleDetection detection;
    detection.x = seen.x + uniform(-0.05, 0.05);
    detection.y = seen.y + uniform(-0.05, 0.05);
    detection.confidence = 0.9;
    detection.covariance << 0.002, 0.0005, 0.0005, 0.001;
    frame.poles_robot.push_back(detection);
  }
  std::mt19937_64 m_random{1};
};

template <class Filter>
void reset(Filter& filter, const std::vector<mrpt::math::TPose2D>& particles) {
  filter.m_particles.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    filter.m_particles[i].d = particles[i];
    filter.m_particles[i].log_w = 0;
  }
}

/// range(0): particles over the whole map. Both results include resetting the particles, which only
/// the benchmark does; putBack measures it alone.
/// \param tempering As in the options of the filter. 0: one update and one resampling, as in MRPT's
///        step. Otherwise particles spread far wider than the likelihood (as after a start) are
///        weighed and resampled several times within the step.
void step(benchmark::State& state, double tempering) {
  Scene scene;
  const auto particles = scene.particles(1000, state.range(0) != 0);
  FilterOptions options;
  options.tempering = tempering;
  PoleParticleFilter localizer(scene.map, options, 1);
  StartOptions start;
  start.pose = scene.truth;
  localizer.start(start);
  localizer.step(scene.frame);
  double resampled = 0, stages = 0;
  for (auto _ : state) {
    reset(localizer, particles);
    scene.frame.time += 0.1;
    benchmark::DoNotOptimize(localizer.step(scene.frame));
    resampled += localizer.report().resampled;
    stages += localizer.report().temperingStages;
  }
  using benchmark::Counter;
  state.counters["poles"] = static_cast<double>(scene.frame.poles_robot.size());
  state.counters["resampled"] = Counter(resampled, Counter::kAvgIterations);
  state.counters["stages"] = Counter(stages, Counter::kAvgIterations);
}

void stepOfMrpt(benchmark::State& state) {
  Scene scene;
  const auto particles = scene.particles(1000, state.range(0) != 0);
  mrpt::slam::CMonteCarloLocalization2D stock(1000);
  stock.options.metricMap = scene.map;
  mrpt::bayes::CParticleFilter filter;
  filter.m_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfStandardProposal;
  filter.m_options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  filter.m_options.adaptiveSampleSize = false;
  filter.m_options.BETA = 0.5;
  const auto action = makeMotionAction(*scene.frame.motion, {});
  const auto observation = CObservationPoles::Create();
  observation->poles = scene.frame.poles_robot;
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  mrpt::random::getRandomGenerator().randomize(1);
  for (auto _ : state) {
    reset(stock, particles);
    filter.executeOn(stock, action.get(), &frame);
    const auto [covariance, mean] = stock.getCovarianceAndMean();
    benchmark::DoNotOptimize(covariance(0, 0) + mean.x());
  }
}

/// The first two scans after a start pose, the first with as many particles as a start has.
/// \param range(0) Poles in each scan.
void firstScans(benchmark::State& state) {
  Scene scene;
  scene.addClutter(static_cast<std::size_t>(state.range(0)));
  const LocalizationMap map(scene.map);
  StartOptions start;
  start.pose = scene.truth;
  for (auto _ : state) {
    LocalizationPipeline localization(map, {}, 1);
    localization.start(start);
    for (int scan = 0; scan < 2; ++scan) {
      scene.frame.time += 0.1;
      benchmark::DoNotOptimize(localization.step(scene.frame));
    }
  }
}

void putBack(benchmark::State& state) {
  Scene scene;
  const auto particles = scene.particles(1000, false);
  PoleParticleFilter localizer(scene.map, {}, 1);
  for (auto _ : state) {
    reset(localizer, particles);
    benchmark::ClobberMemory();
  }
}

void places(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"overTheMap"})->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);
}
BENCHMARK_CAPTURE(step, once, 0)->Apply(places);
BENCHMARK_CAPTURE(step, tempered, FilterOptions().tempering)->Apply(places);
BENCHMARK(stepOfMrpt)->Apply(places);
BENCHMARK(firstScans)
    ->ArgNames({"poles"})
    ->Arg(10)
    ->Arg(200)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(putBack)->Unit(benchmark::kMicrosecond);

}  // namespace
