#pragma once
// Simulated streets for tests.

#include <map>

#include "sim/world/World.h"

namespace polemcl::tests {

inline sim::WorldOptions streetOptions(std::uint64_t seed, int day = 0, double length = 400) {
  sim::WorldOptions options;
  options.seed = seed;
  options.day = day;
  options.length = length;
  return options;
}

inline std::map<std::uint32_t, sim::TruePole> polesById(const sim::World& world) {
  std::map<std::uint32_t, sim::TruePole> poles;
  for (const sim::TruePole& pole : world.poles()) poles[pole.id] = pole;
  return poles;
}

}  // namespace polemcl::tests
