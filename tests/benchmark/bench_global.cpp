/// \file bench_global.cpp
/// \brief Global localization in a whole city: a query, its preparation, and a frame of the submap.
/// One thread.

#include <benchmark/benchmark.h>

#include "core/global_localization/GlobalLocalizer.h"
#include "core/global_localization/PreparedMap.h"
#include "support/PoleCity.h"

using namespace polemcl;
using namespace polemcl::tests;

namespace {

CityOptions cityOf(int streets, bool regular) {
  CityOptions options;
  options.seed = 501;
  options.streets = streets;
  options.regular = regular;
  return options;
}

std::vector<LocalSubmap> submaps(const PoleCity& city, double metres) {
  sim::Random random(7);
  std::vector<LocalSubmap> all(20);
  for (LocalSubmap& submap : all)
    for (const Frame& frame :
         drive(city.surroundings(), city.randomWay(random, metres), {}, random))
      submap.add(frame.motion, frame.poles_robot);
  return all;
}

/// range(0): streets in each direction, range(1): metres travelled, range(2): only lamps, every 25
/// m.
void query(benchmark::State& state) {
  const PoleCity city(cityOf(static_cast<int>(state.range(0)), state.range(2) != 0));
  const GlobalLocalizer localizer(city.map());
  const std::vector<LocalSubmap> all = submaps(city, static_cast<double>(state.range(1)));
  double poles = 0, candidates = 0, resolved = 0, queries = 0;
  for (auto _ : state) {
    const GlobalResult result =
        localizer.localize(all[static_cast<std::size_t>(queries) % all.size()]);
    ++queries;
    poles += static_cast<double>(result.poles);
    candidates += static_cast<double>(result.candidates);
    resolved += result.verdict == GlobalVerdict::resolved;
  }
  state.counters["mapPoles"] = static_cast<double>(city.map().size());
  state.counters["poles"] = poles / queries;
  state.counters["candidates"] = candidates / queries;
  state.counters["resolved"] = resolved / queries;
}
BENCHMARK(query)
    ->ArgNames({"streets", "metres", "regular"})
    ->Args({9, 20, 0})
    ->Args({9, 60, 0})
    ->Args({27, 60, 0})
    ->Args({12, 60, 1})
    ->Args({38, 60, 1})
    ->Unit(benchmark::kMillisecond);

void prepareMap(benchmark::State& state) {
  const PoleCity city(cityOf(static_cast<int>(state.range(0)), false));
  for (auto _ : state) benchmark::DoNotOptimize(PreparedMap(city.map(), {}).pairs.size());
  state.counters["mapPoles"] = static_cast<double>(city.map().size());
}
BENCHMARK(prepareMap)->ArgName("streets")->Arg(9)->Arg(27)->Unit(benchmark::kMillisecond);

void submapFrame(benchmark::State& state) {
  const PoleCity city(cityOf(9, false));
  sim::Random random(8);
  const std::vector<Frame> frames =
      drive(city.surroundings(), city.randomWay(random, 200), {}, random);
  for (auto _ : state) {
    LocalSubmap submap;
    for (const Frame& frame : frames) submap.add(frame.motion, frame.poles_robot);
    benchmark::DoNotOptimize(submap.poles().data());
  }
  state.counters["frames"] = static_cast<double>(frames.size());
}
BENCHMARK(submapFrame)->Unit(benchmark::kMillisecond);

}  // namespace
