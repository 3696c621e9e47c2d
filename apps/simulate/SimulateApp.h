#pragma once
/// \file SimulateApp.h
/// \brief `pole-simulate`: a drive through a simulated street, as a folder of scans or a rawlog of
/// poles.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "sim/drive/Simulation.h"
#include "simulate/SimulatedPoles.h"

namespace polemcl::apps {

/// \brief What the command line says; unset values are those of the configuration.
struct SimulateOptions {
  std::filesystem::path config;  ///< INI
  std::vector<std::string> set;  ///< `section.key=value`, see loadSettings()
  /// Folder of scans to write, when given; with `poles` as well, the same scans give both.
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> poles;  ///< rawlog of poles to write, when given
  std::optional<std::uint64_t> seed;           ///< `[world] seed`
  std::optional<int> day;                      ///< `[world] day`
  std::optional<double> length;                ///< `[world] length_m`, m
  std::optional<std::string> sensor;           ///< `[sensor] model`
};

/// \brief Simulates, and writes the folder layout with truth, labels and `config.ini`, the
/// effective settings. An earlier simulation in the same place is replaced once the new one is
/// complete. \param quiet No progress bar. \throws Error when a setting is out of range, the
/// simulator does not know the configured LiDAR,
///         or the output exists and is not an earlier simulation.
sim::SimulationSummary simulateDrive(const SimulateOptions& options, bool quiet);

/// \brief Simulates and writes the poles of the scans (PoleDriveFiles), and the folder of
/// simulateDrive() too when both are asked for. \throws Error as simulateDrive() and castPoles().
PoleDriveSummary simulatePoles(const SimulateOptions& options, bool quiet);

/// \brief The program. \return An ExitCode.
int simulateMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
