#pragma once
// Settings of LiDARs for tests.

#include <cmath>
#include <string>

#include "core/sensor/SensorModel.h"

namespace polemcl::tests {

inline SensorOptions sensorNamed(const std::string& model, bool upsideDown = false) {
  SensorOptions options;
  options.model = model;
  options.upsideDown = upsideDown;
  return options;
}

/// Beams at equal steps, from the topmost to the lowest.
inline SensorOptions uniformSensor(int rings, double upDeg, double downDeg, int columns) {
  SensorOptions options = sensorNamed("uniform");
  options.rings = rings;
  options.fovUp = upDeg * M_PI / 180;
  options.fovDown = downDeg * M_PI / 180;
  options.columns = columns;
  return options;
}

}  // namespace polemcl::tests
