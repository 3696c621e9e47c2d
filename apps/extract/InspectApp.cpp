#include "extract/InspectApp.h"

#include <cmath>
#include <ostream>

#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

std::string degrees(double radians, int digits = 2) {
  return io::fixed(radians * 180 / M_PI, digits);
}

void printBeams(std::ostream& out, const SensorIdentification& sensor) {
  const BeamTableEstimate& beams = sensor.beams;
  const auto all = beams.elevations();
  out << "beams             " << beams.beams() << '\n';
  for (const BeamBlock& block : beams.blocks) {
    if (beams.blocks.size() > 1)
      out << "  block of " << block.elevations.size() << " starting " << io::fixed(block.apex, 3)
          << " m above the origin of the clouds\n";
    for (std::size_t i = 0; i < block.elevations.size(); ++i)
      out << (i % 8 == 0 ? "    " : " ") << degrees(block.elevations[i])
          << (i % 8 == 7 || i + 1 == block.elevations.size() ? "\n" : "");
  }
  out << "field of view     " << degrees(all.front()) << " to " << degrees(all.back()) << " deg, "
      << io::fixed(100 * sensor.covered, 0) << " % of the turn\n"
      << "sharpness         " << io::fixed(100 * beams.sharpness, 1)
      << " % of the returns in the middle third of their beam's cell, median deviation "
      << degrees(beams.spread, 3) << " deg\n";
  if (beams.origin.slide != 0)
    out << "motion            corrected in these clouds: "
        << io::fixed(std::abs(beams.origin.slide), 2) << " m a turn\n";
}

void printMounting(std::ostream& out, const RawlogInspection& inspection) {
  const SensorIdentification& sensor = inspection.sensor;
  const SensorOptions& options = inspection.options;
  out << "firing steps      ";
  if (sensor.columns > 0)
    out << sensor.columns << " a turn\n";
  else
    out << "unknown: neighbours on a beam have no common step\n";
  out << "ranges            " << io::fixed(sensor.nearest, 1) << " to "
      << io::fixed(sensor.farthest, 1) << " m (1 % to 99 % of the returns)\n"
      << "optical centre    " << io::fixed(options.originX, 3) << ' '
      << io::fixed(options.originY, 3) << ' ' << io::fixed(options.originZ, 3)
      << " m from the origin of the clouds, robot's axes\n";
  if (sensor.ground)
    out << "height            " << io::fixed(options.height, 2) << " m above ground ("
        << io::fixed(100 * sensor.ground->share, 0) << " % of the surroundings lie in its plane)\n"
        << "tilt              roll " << degrees(sensor.ground->roll()) << " deg, pitch "
        << degrees(sensor.ground->pitch()) << " deg over that plane\n";
  else
    out << "height            unknown: no ground plane around the sensor; height_m is a default\n";
  if (sensor.onItsHead)
    out << "upside down       the ground lies above the origin: the z axis of these clouds points "
           "down.\n                  All of the above is for the clouds turned over; import them "
           "again with a\n                  --sensor-pose whose roll is 180 deg, else the "
           "configuration does not fit\n";
}

void printPresets(std::ostream& out, const RawlogInspection& inspection) {
  const SensorIdentification& sensor = inspection.sensor;
  out << "presets           ";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, sensor.presets.size()); ++i) {
    const PresetFit& fit = sensor.presets[i];
    out << (i > 0 ? "                  " : "") << fit.model
        << (fit.upsideDown ? " upside down" : "") << ": " << fit.matched << " of "
        << sensor.beams.beams() << " beams found beside one of its " << fit.rows;
    if (fit.matched > 0)
      out << ", " << degrees(fit.rms, 3) << " deg off (rms), " << io::fixed(100 * fit.rmsShare, 0)
          << " % of the angle between beams";
    out << '\n';
  }
  if (const PresetFit* fit = sensor.preset())
    out << "fits              model = " << fit->model
        << (fit->upsideDown ? ", upside_down = true" : "") << '\n';
  else
    out << "fits              no preset; model = table with the elevations above\n";
}

}  // namespace

Settings settingsFor(const RawlogInspection& inspection) {
  Settings settings;
  settings.sensor = inspection.options;
  return settings;
}

RawlogInspection inspect(const InspectOptions& options) {
  const RawlogInspection result = inspectRawlog(options.input.string(), options.allowTruncated);
  if (options.writeConfig) saveSettings(settingsFor(result), options.writeConfig->string());
  return result;
}

void printInspection(std::ostream& out, const RawlogInspection& inspection) {
  const SensorIdentification& sensor = inspection.sensor;
  out << "scans             " << inspection.used.size() << " of " << inspection.scans << " ("
      << inspection.label << "), " << sensor.points << " points, " << sensor.invalid
      << " invalid\n";
  printBeams(out, sensor);
  printMounting(out, inspection);
  printPresets(out, inspection);
}

}  // namespace polemcl::apps
