/// \file bench_map_builder.cpp
/// \brief Building a map from drives of different length: the time must grow linearly with the
/// detections. Inserting one scan into maps of different size: the time must not grow.
///
/// A road with a pole every 10 m on both sides, a scan every 0.5 m that detects 60 % of the poles
/// within 40 m, and one false detection per scan.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/mapping/IncrementalMerge.h"

using namespace polemcl;

namespace {

std::vector<MappingScan> drive(std::size_t scans) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * 0x1p-64 * static_cast<double>(random());
  };
  std::vector<MappingScan> result(scans);
  for (std::size_t i = 0; i < scans; ++i) {
    const double way = 0.5 * static_cast<double>(i);
    result[i].pose_map_robot = {way, 0, 0};
    const auto see = [&](double x, double y) {
      PoleDetection pole;
      pole.x = x + uniform(-0.05, 0.05);
      pole.y = y + uniform(-0.05, 0.05);
      pole.covariance = Eigen::Matrix2d::Identity() * 0.001;
      result[i].poles_robot.push_back(pole);
    };
    for (double x = std::ceil((way - 40) / 10) * 10; x <= way + 40; x += 10) {
      if (uniform(0, 1) < 0.6) see(x - way, 6);
      if (uniform(0, 1) < 0.6) see(x - way + 3, -7);
    }
    see(uniform(-30, 30), uniform(-30, 30));
  }
  return result;
}

void buildMap(benchmark::State& state) {
  const std::vector<MappingScan> scans = drive(state.range(0));
  PoleMapOptions options;
  options.everyScan = state.range(1) != 0;
  options.minCount = 3;
  options.minShare = 0;
  PoleMapResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = buildPoleMap(scans, options));
  state.counters["detections"] = static_cast<double>(result.detections);
  state.counters["poles"] = static_cast<double>(result.poles.size());
  state.SetComplexityN(static_cast<std::int64_t>(result.detections));
}
/// A scan of ten poles into a map of poles 10 m apart.
void insertScan(benchmark::State& state) {
  const auto side = static_cast<int>(std::sqrt(state.range(0)));
  std::vector<MapPole> poles(static_cast<std::size_t>(side * side));
  for (int i = 0; i < side * side; ++i) {
    poles[static_cast<std::size_t>(i)].x = 10 * (i % side);
    poles[static_cast<std::size_t>(i)].y = 10 * (i / side);
    poles[static_cast<std::size_t>(i)].count = 1;
  }
  IncrementalMerge merge(poles, 0.5);
  std::vector<PoleDetection> scan(10);
  for (std::size_t i = 0; i < scan.size(); ++i) scan[i].x = 10.1 * static_cast<double>(i);
  for (auto _ : state) merge.insertScan(poles, scan);
}
BENCHMARK(insertScan)->ArgName("poles")->Arg(100)->Arg(100000)->Unit(benchmark::kMicrosecond);

BENCHMARK(buildMap)
    ->ArgNames({"scans", "everyScan"})
    ->ArgsProduct({{1000, 4000, 16000}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
