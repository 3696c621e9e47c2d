/// \file bench_likelihood.cpp
/// \brief The likelihood of a batch of particles, compared with the bare searches it contains.
///
/// 2000 poles along a road of 6 km, particles within 1 m of the truth or all over the map.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include <polemcl/core/localization/PoleLikelihood.h>
#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"
#include "core/common/PoleIndex.h"

using namespace polemcl;

namespace {

class Scene {
 public:
  Scene(std::size_t particles, std::size_t detections, bool overTheMap) : m_random(1) {
    for (int i = 0; i < 2000; ++i) {  // a square of 1.5 km, poles on both sides of its streets
      const double along = uniform(0, 1500), beside = uniform(-15, 15);
      const int side = i % 4;
      MapPole pole;
      pole.x = side == 0 ? beside : side == 1 ? 1500 + beside : along;
      pole.y = side == 2 ? beside : side == 3 ? 1500 + beside : along;
      pole.covariance *= 0.04;
      poles.push_back(pole);
    }
    const Pose2D truth{700, 1, 0.02};
    for (const MapPole& pole : poles) {
      if (detected.size() == detections) break;
      const Pose2D seen = relative(truth, {pole.x, pole.y, 0});
      if (std::hypot(seen.x, seen.y) > 60) continue;
      PoleDetection detection;
      detection.x = seen.x + uniform(-0.05, 0.05);
      detection.y = seen.y + uniform(-0.05, 0.05);
      detection.covariance << 0.002, 0.0005, 0.0005, 0.001;
      detected.push_back(detection);
    }
    for (std::size_t i = 0; i < particles; ++i) {
      const MapPole& near = poles[m_random() % poles.size()];
      const Pose2D centre = overTheMap ? Pose2D{near.x, near.y, 0} : truth;
      particlePoses.push_back(
          {centre.x + uniform(-1, 1), centre.y + uniform(-1, 1),
           overTheMap ? uniform(-M_PI, M_PI) : truth.yaw + uniform(-0.05, 0.05)});
    }
  }
  std::vector<MapPole> poles;
  std::vector<PoleDetection> detected;
  std::vector<Pose2D> particlePoses;

 private:
  double uniform(double low, double high) {
    return low + (high - low) * 0x1p-64 * static_cast<double>(m_random());
  }
  std::mt19937_64 m_random;
};

/// range(0): detections, range(1): particles over the whole map.
void batch(benchmark::State& state, LikelihoodModel model, bool weighted) {
  const Scene scene(1000, state.range(0), state.range(1) != 0);
  LikelihoodOptions options;
  options.model = model;
  options.sigma = 0.15;
  options.weighted = weighted;
  const PoleIndex index(scene.poles, options.gate);
  std::vector<double> out;
  for (auto _ : state) {
    logLikelihoods(scene.detected, scene.particlePoses, index, options, out);
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["detections"] = static_cast<double>(scene.detected.size());
}

template <bool grid>
void search(benchmark::State& state) {
  const Scene scene(1000, state.range(0), state.range(1) != 0);
  const PoleIndex index(scene.poles, 1.0);
  for (auto _ : state) {
    double sum = 0;
    for (const Pose2D& pose : scene.particlePoses) {
      for (const PoleDetection& d : scene.detected) {
        const double x = pose.x + d.x, y = pose.y + d.y;
        sum += (grid ? index.grid().nearest(x, y, 1.0) : index.tree().nearest(x, y, 1.0))
                   .squaredDistance;
      }
    }
    benchmark::DoNotOptimize(sum);
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"detections", "overTheMap"})
      ->ArgsProduct({{10, 30}, {0, 1}})
      ->Unit(benchmark::kMicrosecond);
}

BENCHMARK_CAPTURE(batch, mixture, LikelihoodModel::mixture, false)->Apply(sizes);
BENCHMARK_CAPTURE(batch, mixtureWeighted, LikelihoodModel::mixture, true)->Apply(sizes);
BENCHMARK_CAPTURE(batch, paper, LikelihoodModel::paper, false)->Apply(sizes);
BENCHMARK_TEMPLATE(search, true)->Apply(sizes);
BENCHMARK_TEMPLATE(search, false)->Apply(sizes);

void buildIndex(benchmark::State& state) {
  const Scene scene(1, 10, false);
  for (auto _ : state) benchmark::DoNotOptimize(PoleIndex(scene.poles, 1.0).size());
}
BENCHMARK(buildIndex)->Unit(benchmark::kMicrosecond);

}  // namespace
