#include <polemcl/apps/CommandLine.h>
#include <polemcl/apps/OutputFolder.h>
#include <polemcl/apps/Progress.h>
#include <polemcl/apps/Settings.h>
#include <polemcl/apps/SimulateApp.h>
#include <polemcl/core/SensorModel.h>
#include <polemcl/io/TextFile.h>
#include <polemcl/sim/Drive.h>

#include <algorithm>
#include <iostream>

namespace polemcl::apps {
namespace {

Settings effectiveSettings(const SimulateOptions& options) {
  Settings settings = loadSettings(options.config.string());
  sim::SimulationOptions& simulation = settings.simulation;
  if (options.seed) simulation.world.seed = *options.seed;
  if (options.day) simulation.world.day = *options.day;
  if (options.length) simulation.world.length = *options.length;
  if (options.sensor) {
    simulation.sensor = *options.sensor;
    // The simulator knows more units than the extraction has presets.
    const auto presets = SensorModel::modelNames();
    if (std::find(presets.begin(), presets.end(), *options.sensor) != presets.end())
      settings.sensor.model = *options.sensor;
  }
  try {
    simulation.validate();
  } catch (const Error& error) {
    throw Error(options.config.string() + " and command line: " + error.what());
  }
  return settings;
}

void print(const sim::SimulationSummary& summary, const SimulateOptions& options) {
  std::cout << summary.scans << " scans over " << io::fixed(summary.length, 1) << " m, "
            << summary.points << " points, " << summary.poles
            << " true poles: " << options.output.string() << '\n';
}

}  // namespace

sim::SimulationSummary simulateDrive(const SimulateOptions& options, bool quiet) {
  const Settings settings = effectiveSettings(options);
  OutputFolder folder(options.output, "a simulated drive",
                      {"velodyne", "labels", "times.txt", "poses.txt", "odometry.txt",
                       "poles_gt.csv", "config.ini"},
                      "poles_gt.csv");
  saveSettings(settings, (folder.temporary() / "config.ini").string());
  std::optional<Progress> bar;
  const auto summary = sim::simulate(settings.simulation, folder.temporary(),
                                     [&](std::size_t done, std::size_t total) {
                                       if (!bar) bar.emplace("simulate", total, quiet);
                                       bar->update(done);
                                     });
  folder.commit();
  return summary;
}

int simulateMain(int argc, const char* const* argv) {
  CommandLine line("pole-simulate",
                   "Simulates a drive through an urban street, as a folder of LiDAR scans.");
  SimulateOptions options;
  line.cli().add_option("--config", options.config, "Settings (INI)")->required();
  line.cli()
      .add_option("--output", options.output, "Folder to write; an earlier simulation is replaced")
      ->required();
  line.cli().add_option("--seed", options.seed, "Another seed, another street ([world] seed)");
  line.cli().add_option("--day", options.day, "0: the day of the map ([world] day)");
  line.cli().add_option("--length", options.length, "Length of the street, m ([world] length_m)");
  line.cli().add_option("--sensor", options.sensor, "LiDAR, instead of [sensor] model");
  return line.run(argc, argv, [&] {
    const auto summary = simulateDrive(options, line.quiet());
    if (!line.quiet()) print(summary, options);
  });
}

}  // namespace polemcl::apps
