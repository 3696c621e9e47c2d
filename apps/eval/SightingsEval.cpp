/// \file SightingsEval.cpp
/// \brief `pole-eval sightings`: a table of the objects that the scans of a simulated drive could
/// detect (sim/detections/Sightings.h). share/experiments/fit_detections.py reads it.

#include <memory>

#include "cli/Outputs.h"
#include "cli/Settings.h"
#include "eval/DriveTruth.h"
#include "eval/EvalApp.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "sim/detections/Sightings.h"
#include "simulate/SimulatedPoles.h"

namespace polemcl::apps {
namespace {

struct SightingsOptions {
  std::filesystem::path poles;   ///< rawlog of `pole-simulate --poles`, P_config.ini beside it
  std::filesystem::path output;  ///< table to write (CSV)
};

std::string number(double value) {
  return io::significant(value, 9);
}

/// What holds for the whole drive, and the names of the columns.
void writeHeader(std::ostream& out, const sim::SimulatedDrive& drive, double maxRange,
                 const std::vector<std::uint32_t>& points) {
  const sim::SimulationOptions& options = drive.options();
  out << "# sensor " << drive.lidar().name << "\n# height_m " << number(options.height)
      << "\n# max_range_m " << number(maxRange) << "\n# spacing_m " << number(options.spacing)
      << "\n# seed " << options.world.seed << "\n# day " << options.world.day << "\n# track "
      << options.world.track << "\n# street_m " << number(drive.world().street().length())
      << "\n# driven_m " << number(drive.length()) << "\n# points_per_scan";
  for (const std::uint32_t count : points) out << ' ' << count;
  out << "\nkind,object,x,y,aside_m,scan,range_m,hidden";
  for (int r = 0; r < sim::kReported; ++r) out << ',' << name(static_cast<sim::Reported>(r));
  out << '\n';
}

void writeRow(std::ostream& out, const sim::Sighting& sighting, const sim::Street& street) {
  constexpr double kFar = 63;  // m
  const double aside = street.distance(sighting.place.x(), sighting.place.y(), kFar);
  out << name(sighting.kind) << ',' << sighting.object << ',' << number(sighting.place.x()) << ','
      << number(sighting.place.y()) << ',' << number(aside) << ',' << sighting.scan << ','
      << number(sighting.range) << ',' << sighting.hidden;
  for (int r = 0; r < sim::kReported; ++r)
    out << ',' << (sighting.reported ? number((*sighting.reported)[r]) : "");
  out << '\n';
}

/// Columns: the object (`aside_m`: its distance from the middle of the road), the scan, the range,
/// whether a house hides it, and what the detection says; empty when it was not detected. The world
/// is built again from the settings of the drive.
/// \throws Error naming the file: no P_config.ini, another number of scans than its drive has.
std::string writeSightings(const SightingsOptions& options) {
  const AllSettings settings = loadSettings(poleDriveFiles(options.poles).config.string());
  const sim::SimulatedDrive drive(settings.simulation, settings.sensor);
  std::vector<std::vector<PoleDetection>> poles;
  std::vector<std::uint32_t> points;
  std::size_t count = 0;
  streamStoredPoles(options.poles, [&](const ReadScan& scan) {
    poles.push_back(scan.observation->poles);
    points.push_back(scan.observation->points);
    count += poles.back().size();
  });
  if (poles.size() != drive.scans())
    throw Error(options.poles.string() + ": holds " + std::to_string(poles.size()) +
                " scans, and the drive of its settings has " + std::to_string(drive.scans()));
  const double maxRange = settings.extraction.scanLine.maxRange;
  io::AtomicFile file(options.output);
  writeHeader(file.stream(), drive, maxRange, points);
  for (const sim::Sighting& sighting : sim::sightingsOf(drive, poles, maxRange))
    writeRow(file.stream(), sighting, drive.world().street());
  file.commit();
  return "scans " + std::to_string(poles.size()) + ", detections " + std::to_string(count) + '\n';
}

}  // namespace

Subcommand sightingsCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "sightings", "Writes which poles each scan of a simulated drive detects; needs no scans");
  const auto options = std::make_shared<SightingsOptions>();
  addFile(cli, "--poles", options->poles, "Rawlog that pole-simulate --poles wrote")->required();
  addOutput(cli, "--output", options->output, "Table to write (CSV)")->required();
  return {&cli, [options](bool) { return writeSightings(*options); }};
}

}  // namespace polemcl::apps
