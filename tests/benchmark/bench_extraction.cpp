/// \file bench_extraction.cpp
/// \brief From points in memory to poles, one core. A real KITTI scan if POLEMCL_DATA is set,
/// otherwise a simulated HDL-64E scan.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include <polemcl/core/extraction/PoleExtractor.h>
#include <polemcl/io/data/Cloud.h>
#include "sim/drive/Drive.h"
#include "sim/lidar/Scanner.h"

using namespace polemcl;

namespace {

struct Scan {
  std::vector<float> x, y, z;
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// \param columns Firing steps per revolution; 0: those of the sensor.
Scan simulated(const std::string& sensor, double height, int columns = 0) {
  sim::SimulationOptions options;
  options.world.length = 120;
  options.sensor = sensor;
  options.height = height;
  const sim::World world = sim::makeWorld(options.world);
  const sim::Drive drive = sim::makeDrive(world, options);
  sim::LidarModel lidar = sim::makeLidar(sensor);
  if (columns > 0) lidar.columns = columns;
  const auto scan = sim::Scanner(world, lidar).scan(drive.T_map_sensor[100], 1);
  return {scan.x, scan.y, scan.z};
}

const Scan& kittiScan() {
  static const Scan scan = [] {
    const char* data = std::getenv("POLEMCL_DATA");
    if (!data) return simulated("hdl64e", 1.73);
    const auto cloud =
        io::readKittiBin(std::string(data) + "/kitti_raw_0005/velodyne/0000000040.bin");
    return Scan{cloud.x, cloud.y, cloud.z};
  }();
  return scan;
}

/// The same points in another order.
Scan ordered(const Scan& scan, const std::vector<std::size_t>& order) {
  Scan other;
  for (const std::size_t i : order) {
    other.x.push_back(scan.x[i]);
    other.y.push_back(scan.y[i]);
    other.z.push_back(scan.z[i]);
  }
  return other;
}

/// Column by column, as a LiDAR that turns clockwise fires.
Scan inFiringOrder(const Scan& scan) {
  constexpr double kColumns = 2083;
  std::vector<std::tuple<int, float, std::size_t>> keys;
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    const double turn = (M_PI - std::atan2(scan.y[i], scan.x[i])) / (2 * M_PI);
    keys.emplace_back(static_cast<int>(turn * kColumns),
                      -scan.z[i] / std::hypot(scan.x[i], scan.y[i]), i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> order;
  for (const auto& key : keys) order.push_back(std::get<2>(key));
  return ordered(scan, order);
}

Scan shuffled(const Scan& scan) {
  std::vector<std::size_t> order(scan.x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937_64(1));
  return ordered(scan, order);
}

/// An HDL-32E scan with as many points as NCLT's scans have after their driver's filter.
const Scan& ncltSizedScan() {
  static const Scan scan = [] {
    Scan thin = simulated("hdl32e", 1.0);
    for (auto* axis : {&thin.x, &thin.y, &thin.z})
      axis->resize(std::min<std::size_t>(30000, axis->size()));
    return thin;
  }();
  return scan;
}

void extract(benchmark::State& state, const Scan& scan, const std::string& model, double height,
             ExtractionMethod method, int columns = 0) {
  SensorOptions sensor;
  sensor.columns = columns;
  sensor.model = model;
  sensor.height = height;
  ExtractionOptions options;
  options.method = method;
  PoleExtractor extractor(sensor, options);
  std::size_t poles = 0;
  for (auto _ : state) benchmark::DoNotOptimize(poles = extractor.extract(scan.view()).size());
  state.counters["points"] = static_cast<double>(scan.x.size());
  state.counters["poles"] = static_cast<double>(poles);
}

void nativeKitti(benchmark::State& state) {
  extract(state, kittiScan(), "hdl64e", 1.73, ExtractionMethod::scanLine);
}
void nativeKittiFirings(benchmark::State& state) {
  extract(state, inFiringOrder(kittiScan()), "hdl64e", 1.73, ExtractionMethod::scanLine);
}
void nativeKittiShuffled(benchmark::State& state) {
  extract(state, shuffled(kittiScan()), "hdl64e", 1.73, ExtractionMethod::scanLine);
}
void paperKitti(benchmark::State& state) {
  extract(state, kittiScan(), "hdl64e", 1.73, ExtractionMethod::rangeImage);
}
void nativeNcltSized(benchmark::State& state) {
  extract(state, ncltSizedScan(), "hdl32e", 1.0, ExtractionMethod::scanLine);
}

/// Lower bound: reads every point once and computes its range.
void readOnly(benchmark::State& state) {
  const PointsView points = kittiScan().view();
  for (auto _ : state) {
    float farthest = 0;
    for (std::size_t i = 0; i < points.size; ++i)
      farthest =
          std::max(farthest, std::sqrt(points.x[i] * points.x[i] + points.y[i] * points.y[i] +
                                       points.z[i] * points.z[i]));
    benchmark::DoNotOptimize(farthest);
  }
}

/// The same street seen by 64 beams; the firing rate gives about this number of points per
/// revolution.
void nativePoints(benchmark::State& state) {
  const int columns = static_cast<int>(state.range(0) / 64);
  const Scan scan = simulated("hdl64e_kitti", 1.73, columns);
  extract(state, scan, "hdl64e", 1.73, ExtractionMethod::scanLine, columns);
  state.SetComplexityN(static_cast<benchmark::IterationCount>(scan.x.size()));
}

}  // namespace

BENCHMARK(readOnly)->Unit(benchmark::kMillisecond);
BENCHMARK(nativeKitti)->Unit(benchmark::kMillisecond);
BENCHMARK(nativeKittiFirings)->Unit(benchmark::kMillisecond);
BENCHMARK(nativeKittiShuffled)->Unit(benchmark::kMillisecond);
BENCHMARK(paperKitti)->Unit(benchmark::kMillisecond);
BENCHMARK(nativeNcltSized)->Unit(benchmark::kMillisecond);
BENCHMARK(nativePoints)
    ->RangeMultiplier(4)
    ->Range(10000, 2000000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
