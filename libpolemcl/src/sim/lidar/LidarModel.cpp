#include "sim/lidar/LidarModel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <polemcl/core/common/Types.h>
#include "core/common/Angles.h"
#include "core/common/Binder.h"
#include "core/sensor/SensorModel.h"
#include "sim/common/Random.h"

namespace polemcl::sim {
namespace {

std::vector<Beam> evenBeams(int count, double topDeg, double stepDeg) {
  std::vector<Beam> beams(count);
  for (int i = 0; i < count; ++i) beams[i].elevation = (topDeg - stepDeg * i) * degree;
  return beams;
}

/// Velodyne HDL-64E: two blocks of 32 lasers. The upper ones start higher than the lower ones,
/// according to the calibration of real units. Lasers of one firing point to the left and right of
/// the rotor's azimuth.
LidarModel hdl64e(double topDeg, double upperStepDeg, double lowerTopDeg, double lowerStepDeg) {
  LidarModel lidar;
  lidar.beams = evenBeams(32, topDeg, upperStepDeg);
  const auto lower = evenBeams(32, lowerTopDeg, lowerStepDeg);
  lidar.beams.insert(lidar.beams.end(), lower.begin(), lower.end());
  for (int i = 0; i < 64; ++i) {
    lidar.beams[i].rise = i < 32 ? 0.2 : 0.12;
    lidar.beams[i].azimuth = (i % 4 - 1.5) * (i < 32 ? 1.3 : 2.2) * degree;
  }
  lidar.columns = 2083;
  lidar.calibrated = true;
  lidar.divergence = 0.0025;
  lidar.rangeNoise = 0.022;
  lidar.maxRange = 120;
  lidar.referenceRange = 75;
  return lidar;
}

/// Velodyne HDL-32E: 46.08 µs per firing.
LidarModel hdl32e() {
  LidarModel lidar;
  lidar.beams = evenBeams(32, 10.0 + 2.0 / 3, 4.0 / 3);
  lidar.columns = 2170;
  lidar.divergence = 0.003;
  lidar.maxRange = 100;
  lidar.referenceRange = 60;
  return lidar;
}

/// Listed or measured beams, with the rotor and the ranging of an HDL-32E.
LidarModel listed(const SensorOptions& options) {
  const SensorModel model(options);
  LidarModel lidar = hdl32e();
  lidar.beams.clear();
  for (int row = 0; row < model.beamCount(); ++row) {
    Beam beam;
    beam.elevation = std::atan(model.beam(row).slope);
    beam.rise = model.beam(row).offset;
    lidar.beams.push_back(beam);
  }
  lidar.columns = model.columns();
  std::ostringstream name;
  name.precision(5);
  name << options.model << " of " << lidar.beams.size() << " beams from "
       << lidar.beams.front().elevation / degree << " to " << lidar.beams.back().elevation / degree
       << " deg";
  lidar.name = name.str();
  return lidar;
}

/// Velodyne VLP-16: 55.296 µs per firing.
LidarModel vlp16() {
  LidarModel lidar;
  lidar.beams = evenBeams(16, 15, 2);
  lidar.columns = 1808;
  lidar.divergence = 0.003;
  lidar.maxRange = 100;
  lidar.referenceRange = 60;
  return lidar;
}

/// Ouster: beams in four staggered columns; noise of 1 to 3 cm; detectors integrate a short pulse.
LidarModel ouster(int rings, double halfViewDeg, double staggerDeg, double reference) {
  LidarModel lidar;
  lidar.beams = evenBeams(rings, halfViewDeg, 2 * halfViewDeg / (rings - 1));
  for (int i = 0; i < rings; ++i)
    lidar.beams[i].azimuth = (1.5 - i % 4) * staggerDeg / 1.5 * degree;
  lidar.columns = 1024;
  lidar.calibrated = true;
  lidar.divergence = 0.0031;
  lidar.rangeNoise = 0.011;
  lidar.rangeStep = 0.001;
  lidar.minRange = 0.5;
  lidar.referenceRange = reference;
  lidar.pulseLength = 0.8;
  lidar.dropout = 0.01;
  return lidar;
}

using Maker = LidarModel (*)();
const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> table{
      // Data sheet: spacing 1/3° from +2°, 1/2° from -8.83°.
      {"hdl64e", [] { return hdl64e(2.0, 1.0 / 3, -8.0 - 5.0 / 6, 0.5); }},
      // The unit of the KITTI recordings has a slightly wider field of view than the data sheet.
      {"hdl64e_kitti", [] { return hdl64e(1.95, 0.3435, -9.03, 0.5151); }},
      {"hdl32e", hdl32e},
      {"vlp16", vlp16},
      {"os1_64", [] { return ouster(64, 16.611, 3.164, 45); }},    // first generation
      {"os1_64_gen2", [] { return ouster(64, 21.2, 4.23, 50); }},  // "45°", as measured
      {"os1_128", [] { return ouster(128, 22.5, 4.23, 50); }},
      {"os0_64", [] { return ouster(64, 45, 4.23, 25); }}};
  return table;
}

/// Adds the residual errors of a unit's calibration.
void addOffsets(LidarModel& lidar, unsigned unit) {
  Random random(hash(0x11da4ull, unit));
  for (Beam& beam : lidar.beams) {
    if (lidar.calibrated)
      beam.elevation += random.normal(0, 0.05 * degree);
    else
      beam.elevationError = random.normal(0, 0.03 * degree);
    beam.azimuth += random.normal(0, 0.03 * degree);
    beam.rangeBias = random.normal(0, kCalibrationError * lidar.rangeNoise);
    beam.rise += beam.rise > 0 ? random.normal(0, 0.004) : 0.0;
  }
}
}  // namespace

const std::vector<std::string>& lidarNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& maker : makers()) list.push_back(maker.first);
    return list;
  }();
  return names;
}

LidarModel makeLidar(const std::string& name, bool upsideDown, unsigned unit) {
  const auto maker = makers().find(name);
  if (maker == makers().end()) {
    std::string known;
    for (const std::string& each : lidarNames()) known += " " + each;
    throw Error("unknown LiDAR \"" + name + "\": allowed are" + known + " table uniform");
  }
  LidarModel lidar = maker->second();
  lidar.name = name;
  addOffsets(lidar, unit);
  lidar.startAzimuth = M_PI;
  if (upsideDown) {
    for (Beam& beam : lidar.beams) {
      beam.elevation = -beam.elevation;
      beam.elevationError = -beam.elevationError;
      beam.azimuth = -beam.azimuth;
      beam.rise = -beam.rise;
    }
    std::reverse(lidar.beams.begin(), lidar.beams.end());
    lidar.clockwise = !lidar.clockwise;
  }
  return lidar;
}

namespace {

/// The mounting comes from `[sensor]`; a simulated street allows less.
void checkMounting(SimulationOptions options) {
  CheckingBinder binder;
  binder.section("sensor", "");
  binder.number("height_m", options.height, Range::between(0.3, 5), "m",
                "of a simulated sensor above ground");
  binder.numbers("origin", {&options.originX, &options.originY, &options.originZ},
                 Range::between(-10, 10), "m", "of a simulated sensor");
}

LidarModel lidarOfSettings(const SimulationOptions& options, const SensorOptions& beams) {
  if (options.sensor != "table" && options.sensor != "uniform")
    return makeLidar(options.sensor, options.upsideDown);
  SensorOptions mounted = beams;
  mounted.model = options.sensor;
  mounted.upsideDown = options.upsideDown;
  LidarModel lidar = listed(mounted);  // as mounted, from top to bottom
  addOffsets(lidar, 1);
  lidar.startAzimuth = M_PI;
  if (options.upsideDown) lidar.clockwise = !lidar.clockwise;
  return lidar;
}

}  // namespace

LidarModel makeLidar(const SimulationOptions& options, const SensorOptions& beams) {
  checkMounting(options);
  LidarModel lidar = lidarOfSettings(options, beams);
  lidar.rangeOffset = beams.rangeOffset;
  lidar.rangeScale = beams.rangeScale;
  return lidar;
}

ScanTiming timingOf(const LidarModel& lidar) {
  return {lidar.clockwise ? Turn::clockwise : Turn::counterclockwise, lidar.period,
          lidar.startAzimuth, 0.5};
}

}  // namespace polemcl::sim
