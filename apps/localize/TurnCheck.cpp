#include "localize/TurnCheck.h"

#include <cmath>

#include "mrpt/observation/ObservationPoints.h"

namespace polemcl::apps {
namespace {

constexpr double tolerance = 0.01;  // s
constexpr int directions = 16;

/// Same times in most directions; close to the cut, small differences make a whole turn.
bool agree(const ScanTiming& set, const ScanTiming& stated) {
  int apart = 0;
  for (int i = 0; i < directions; ++i) {
    const double azimuth = 2 * M_PI * i / directions;
    apart += std::abs(set.offset(azimuth) - set.clock - stated.offset(azimuth)) > tolerance;
  }
  return 2 * apart < directions;
}

}  // namespace

std::vector<std::string> turnWarnings(const ReadScan& scan, const SequenceOptions& options) {
  std::vector<std::string> warnings;
  for (const auto& source : scan.sources) {
    const auto lidar = options.vehicle.indexOf(source->sensorLabel);
    const SensorOptions& sensor =
        lidar ? options.vehicle.lidars[*lidar].sensor : options.extraction.sensor;
    if (sensor.timing.turn == Turn::automatic) continue;
    ObservationPoints points(sensor);
    const ObservationPoints::Loan loan(points);
    points.read(*source);
    if (!points.timing() || agree(sensor.timing, *points.timing())) continue;
    warnings.push_back("[sensor" + (lidar ? ":" + source->sensorLabel : "") + "] turn = " +
                       name(sensor.timing.turn) + " and the keys beside it contradict " +
                       "the times that the LiDAR " + source->sensorLabel +
                       " states: poses of a moving robot get worse; set turn = auto");
  }
  return warnings;
}

}  // namespace polemcl::apps
