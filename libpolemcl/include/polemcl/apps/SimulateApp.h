#pragma once
/// \file SimulateApp.h
/// \brief `pole-simulate`: a drive through a simulated street, as a folder of scans.

#include <polemcl/sim/Simulation.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace polemcl::apps {

/// \brief What the command line says; unset values are those of the configuration.
struct SimulateOptions {
  std::filesystem::path config;       ///< INI
  std::filesystem::path output;       ///< folder to write
  std::optional<std::uint64_t> seed;  ///< `[world] seed`
  std::optional<int> day;             ///< `[world] day`
  std::optional<double> length;       ///< `[world] length_m`, m
  std::optional<std::string> sensor;  ///< `[sensor] model`
};

/// \brief Simulates, and writes the folder layout with truth, labels and `config.ini`, the
/// effective settings. An earlier simulation in the same place is replaced once the new one is
/// complete. \param quiet No progress bar. \throws Error when a setting is out of range, the
/// configuration's LiDAR is none the simulator
///         knows, or something else than an earlier simulation is in the place of the output.
sim::SimulationSummary simulateDrive(const SimulateOptions& options, bool quiet);

/// \brief The program. \return An ExitCode.
int simulateMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
