/// \file bench_extraction.cpp
/// \brief Points in memory to poles out, one core. A real KITTI scan where POLEMCL_DATA names the
/// data, else a simulated HDL-64E one.

#include <benchmark/benchmark.h>
#include <polemcl/core/PoleExtractor.h>
#include <polemcl/io/Cloud.h>
#include <polemcl/sim/Drive.h>
#include <polemcl/sim/Scanner.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

using namespace polemcl;

namespace {

struct Scan {
  std::vector<float> x, y, z;
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

Scan simulated(const std::string& sensor, double height) {
  sim::SimulationOptions options;
  options.world.length = 120;
  options.sensor = sensor;
  options.height = height;
  const sim::World world = sim::makeWorld(options.world);
  const sim::Drive drive = sim::makeDrive(world, options);
  const auto scan = sim::scan(world, drive.T_map_sensor[100], sim::makeLidar(sensor), 1);
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

/// An HDL-32E scan with as many points as NCLT's have after their driver's filter.
const Scan& ncltSizedScan() {
  static const Scan scan = [] {
    Scan thin = simulated("hdl32e", 1.0);
    for (auto* axis : {&thin.x, &thin.y, &thin.z})
      axis->resize(std::min<std::size_t>(30000, axis->size()));
    return thin;
  }();
  return scan;
}

/// `count` points: copies of one scan, each turned a little, so that rows fill up evenly.
Scan turnedCopies(std::size_t count) {
  const Scan& base = kittiScan();
  Scan scan;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = i % base.x.size();
    const float angle = 0.0007f * static_cast<float>(i / base.x.size());
    const float c = std::cos(angle), s = std::sin(angle);
    scan.x.push_back(c * base.x[k] - s * base.y[k]);
    scan.y.push_back(s * base.x[k] + c * base.y[k]);
    scan.z.push_back(base.z[k]);
  }
  return scan;
}

void extract(benchmark::State& state, const Scan& scan, const std::string& model, double height,
             ExtractionMethod method) {
  SensorOptions sensor;
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
  extract(state, kittiScan(), "hdl64e", 1.73, ExtractionMethod::native);
}
void paperKitti(benchmark::State& state) {
  extract(state, kittiScan(), "hdl64e", 1.73, ExtractionMethod::paper);
}
void nativeNcltSized(benchmark::State& state) {
  extract(state, ncltSizedScan(), "hdl32e", 1.0, ExtractionMethod::native);
}

/// The limit: every point read once, its range computed.
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

void nativePoints(benchmark::State& state) {
  const Scan scan = turnedCopies(static_cast<std::size_t>(state.range(0)));
  extract(state, scan, "hdl64e", 1.73, ExtractionMethod::native);
  state.SetComplexityN(state.range(0));
}

}  // namespace

BENCHMARK(readOnly)->Unit(benchmark::kMillisecond);
BENCHMARK(nativeKitti)->Unit(benchmark::kMillisecond);
BENCHMARK(paperKitti)->Unit(benchmark::kMillisecond);
BENCHMARK(nativeNcltSized)->Unit(benchmark::kMillisecond);
BENCHMARK(nativePoints)
    ->RangeMultiplier(4)
    ->Range(10000, 2000000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
