#include "simulate/SimulateApp.h"

#include <algorithm>
#include <iostream>

#include "cli/CommandLine.h"
#include "cli/OutputFolder.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "cli/Settings.h"
#include "core/sensor/SensorModel.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "sim/drive/Drive.h"
#include "sim/lidar/LidarModel.h"

namespace polemcl::apps {
namespace {

AllSettings simulationSettings(const SimulateOptions& options) {
  AllSettings settings = loadSettings(options.config.string(), options.set);
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
  io::located(options.config.string() + " and command line: ", [&] {
    simulation.validate();
    sim::makeLidar(simulation, settings.sensor);
  });
  return settings;
}

void print(const sim::SimulationSummary& summary, const SimulateOptions& options) {
  std::cout << summary.scans << " scans over " << io::fixed(summary.length, 1) << " m, "
            << summary.points << " points, " << summary.poles
            << " true poles: " << options.output->string() << '\n';
}

void print(const PoleDriveSummary& summary, const SimulateOptions& options) {
  std::cout << summary.poles << " poles in " << summary.scans << " scans ("
            << io::fixed(static_cast<double>(summary.poles) / static_cast<double>(summary.scans), 2)
            << " per scan) over " << io::fixed(summary.length, 1) << " m, " << summary.truePoles
            << " true poles: " << options.poles->string() << '\n';
}

const std::vector<std::string> kFolderNames{
    "velodyne",        "velodyne/[0-9][0-9][0-9][0-9][0-9][0-9].bin",
    "labels",          "labels/[0-9][0-9][0-9][0-9][0-9][0-9].label",
    "times.txt",       "poses.txt",
    "odometry.txt",    "poles_gt.csv",
    "scan_timing.ini", "config.ini"};
const std::string kFolderMarker = "poles_gt.csv";

/// The models of the simulator, and the two that `[sensor]` describes.
std::vector<std::string> sensorNames() {
  std::vector<std::string> names = sim::lidarNames();
  names.insert(names.end(), {"table", "uniform"});
  return names;
}

const Guides kSimulateGuides{
    {"",
     {{"pole-simulate --config demo.ini --length 60 --output scans",
       "pole-simulate --config hdl32e.ini --length 1000 --day 30 --poles long.rawlog --set "
       "simulation.detections=hdl32e.json"},
      "Make a rawlog of the scans: pole-import folder --input scans --output scans.rawlog. A "
      "rawlog of poles goes to pole-map and pole-localize as it is."}},
};

}  // namespace

sim::SimulationSummary simulateDrive(const SimulateOptions& options, bool quiet) {
  const AllSettings settings = simulationSettings(options);
  OutputFolder folder(*options.output, "a simulated drive", kFolderNames, kFolderMarker);
  saveSettings(settings, (folder.temporary() / "config.ini").string());
  Progress progress("simulate", 0, quiet);
  const auto summary =
      sim::simulate(settings.simulation, folder.temporary(), progress.updates(), settings.sensor);
  folder.commit();
  return summary;
}

PoleDriveSummary simulatePoles(const SimulateOptions& options, bool quiet) {
  const PoleDriveFiles files = poleDriveFiles(*options.poles);
  const AllSettings settings = simulationSettings(options);
  if (options.output && !settings.simulation.detections.empty())
    throw Error(options.config.string() +
                ": [simulation] detections samples poles without scans, so --output has nothing to "
                "hold; leave one of them out");
  std::optional<OutputFolder> folder;
  if (options.output) {
    folder.emplace(*options.output, "a simulated drive", kFolderNames, kFolderMarker);
    saveSettings(settings, (folder->temporary() / "config.ini").string());
  }
  const sim::SimulatedDrive drive(settings.simulation, settings.sensor);
  std::optional<sim::ScanFolderWriter> scans;
  if (folder) scans.emplace(drive, folder->temporary());
  Progress progress("simulate", 0, quiet);
  const auto update = [&](std::size_t done) { progress.update(done, drive.scans()); };
  const auto summary = settings.simulation.detections.empty()
                           ? castPoles(drive, settings, files, scans ? &*scans : nullptr, update)
                           : samplePoles(drive, settings, files, update);
  if (folder) folder->commit();
  return summary;
}

int simulateMain(int argc, const char* const* argv) {
  CommandLine line("pole-simulate",
                   "Simulates a drive through an urban street, as a folder of LiDAR scans or a "
                   "rawlog of their poles.",
                   kSimulateGuides);
  SimulateOptions options;
  addConfigOption(line.cli(), options.config)->required();
  addSetOption(line.cli(), options.set);
  const auto* output = addFolder(
      line.cli(), "--output", options.output,
      "Folder of scans to write; replaces an earlier simulation; this or --poles is needed");
  const auto* poles = markOutput(
      addFile(line.cli(), "--poles", options.poles,
              "Rawlog of poles to write, with P.tum, P_poles_gt.csv, P_config.ini beside it"),
      {".tum", "_poles_gt.csv", "_config.ini"});
  line.cli()
      .add_option("--seed", options.seed, "Seed of the street")
      ->default_str(unlessSet("[world] seed", sim::WorldOptions().seed));
  line.cli()
      .add_option("--day", options.day, "Day; 0 is the day of the map")
      ->default_str(unlessSet("[world] day", sim::WorldOptions().day));
  line.cli()
      .add_option("--length", options.length, "Length of the street, m")
      ->default_str(unlessSet("[world] length_m", sim::WorldOptions().length));
  line.cli()
      .add_option("--sensor", options.sensor, "Model of the LiDAR")
      ->check(CLI::IsMember(sensorNames()))
      ->default_str(unlessSet("[sensor] model", sim::SimulationOptions().sensor));
  line.cli().parse_complete_callback([&] {
    if (output->count() + poles->count() == 0) throw CLI::RequiredError("--output or --poles");
  });
  return line.run(argc, argv, [&] {
    if (options.poles) {
      const auto summary = simulatePoles(options, line.quiet());
      if (!line.quiet()) print(summary, options);
    } else {
      const auto summary = simulateDrive(options, line.quiet());
      if (!line.quiet()) print(summary, options);
    }
  });
}

}  // namespace polemcl::apps
