#pragma once
/// \file Simulation.h
/// \brief A drive through a simulated world, written as a folder of scans.

#include <polemcl/sim/SimulationOptions.h>

#include <filesystem>
#include <functional>

namespace polemcl::sim {

/// \brief What was written.
struct SimulationSummary {
  std::size_t scans = 0, points = 0, poles = 0;
  double length = 0;  ///< driven, m
};

/// \brief Writes velodyne/*.bin, labels/*.label, times.txt, poses.txt, odometry.txt, poles_gt.csv
/// into `directory`, which must exist. Scans are cast in parallel; the bytes do not depend on it.
/// \param progress Called after each scan with (done, total), from one thread at a time.
/// \throws Error when an option is out of range or a file cannot be written.
SimulationSummary simulate(const SimulationOptions& options, const std::filesystem::path& directory,
                           const std::function<void(std::size_t, std::size_t)>& progress = {});

}  // namespace polemcl::sim
