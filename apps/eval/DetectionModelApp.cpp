#include "eval/DetectionModelApp.h"

#include <memory>
#include <sstream>

#include "cli/JsonFile.h"
#include "eval/DriveTruth.h"
#include "sim/detections/DetectionModelFit.h"
#include "simulate/SimulatedPoles.h"

namespace polemcl::apps {
namespace {

/// A drive with what it needs to be looked at: the world is built again from its settings.
struct LoadedDrive {
  AllSettings settings;
  std::unique_ptr<sim::SimulatedDrive> drive;
  sim::ObservedDrive observed;

  explicit LoadedDrive(const std::filesystem::path& rawlog)
      : settings(loadSettings(poleDriveFiles(rawlog).config.string())),
        drive(std::make_unique<sim::SimulatedDrive>(settings.simulation, settings.sensor)) {
    observed.drive = drive.get();
    streamStoredPoles(rawlog, [&](const ReadScan& scan) {
      observed.poles.push_back(scan.observation->poles);
      observed.points.push_back(scan.observation->points);
    });
    if (observed.poles.size() != drive->scans())
      throw Error(rawlog.string() + ": holds " + std::to_string(observed.poles.size()) +
                  " scans, and the drive of its settings has " + std::to_string(drive->scans()));
  }
};

std::string describe(const std::vector<LoadedDrive>& drives) {
  std::ostringstream text;
  std::size_t scans = 0;
  double length = 0;
  text << "worlds";
  for (std::size_t i = 0; i < drives.size(); ++i) {
    if (i % 2 == 0) text << (i > 0 ? ", " : " ") << drives[i].settings.simulation.world.seed;
    scans += drives[i].observed.poles.size();
    length += drives[i].drive->length();
  }
  text << "; " << scans << " scans over " << static_cast<int>(length) << " m, two days each";
  return text.str();
}

}  // namespace

sim::DetectionModel fitModel(const FitModelOptions& options) {
  if (options.drives.empty() || options.drives.size() % 2 != 0)
    throw Error("--drives: " + std::to_string(options.drives.size()) +
                " are given; two for each street are needed, of two days");
  std::vector<LoadedDrive> drives;
  for (const auto& rawlog : options.drives) drives.emplace_back(rawlog);
  std::vector<sim::ObservedStreet> streets;
  for (std::size_t i = 0; i < drives.size(); i += 2)
    streets.push_back({drives[i].observed, drives[i + 1].observed});
  const double maxRange = drives.front().settings.extraction.scanLine.maxRange;
  auto model = sim::fitDetectionModel(streets, maxRange, describe(drives));
  sim::writeDetectionModel(options.model, model);
  return model;
}

sim::DetectionSummary evalObservations(const EvalObservationsOptions& options) {
  const LoadedDrive drive(options.poles);
  auto s = sim::summarizeDetections(drive.observed, drive.settings.extraction.scanLine.maxRange);
  if (!options.json) return s;
  writeJson(*options.json, {{"scans", s.scans},
                            {"detections", s.detections},
                            {"per_scan", s.perScan},
                            {"false_per_scan", s.falsePerScan},
                            {"lasting_false_per_scan", s.lastingFalsePerScan},
                            {"centre_median_m", s.centreMedian},
                            {"centre_p90_m", s.centre90},
                            {"nees_mean", s.neesMean},
                            {"nees_median", s.neesMedian},
                            {"found_run_m", s.foundRun},
                            {"missed_run_m", s.missedRun},
                            {"confidence", s.confidence},
                            {"range_edges_m", s.rangeEdges},
                            {"recall", s.recall}});
  return s;
}

}  // namespace polemcl::apps
