#pragma once
/// \file LidarModel.h
/// \brief Spinning LiDARs as their data sheets describe them, with the small offsets real ones
/// have.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/sensor/SensorOptions.h"
#include "sim/common/SimulationOptions.h"

namespace polemcl::sim {

/// \brief One laser of the rotor.
struct Beam {
  double elevation = 0;       ///< as reported, rad, above the sensor's x-y plane
  double elevationError = 0;  ///< true minus reported, rad
  double azimuth = 0;         ///< offset from the rotor's azimuth, rad, counter-clockwise
  double rise = 0;            ///< start above the optical centre, m (HDL-64E: two blocks)
  double rangeBias = 0;       ///< left by calibration, m
};

/// \brief A LiDAR: beams from top to bottom, firing steps of a turn, and how well it measures.
struct LidarModel {
  std::string name;
  std::vector<Beam> beams;
  int columns = 0;            ///< firing steps a turn
  bool clockwise = true;      ///< direction of rotation seen from above
  double startAzimuth = 0;    ///< of the first firing step, rad
  double period = 0.1;        ///< of a turn, s
  double divergence = 0.002;  ///< full angle of the beam, rad
  double rangeNoise = 0.02;   ///< standard deviation at good signal, m
  double rangeStep = 0.002;   ///< quantum of the range, m
  double minRange = 1.0;      ///< m
  double maxRange = 100;      ///< m
  double referenceRange =
      80;                    ///< where a surface of 10 % reflectivity returns half of the pulses, m
  double pulseLength = 0.6;  ///< echoes nearer to each other melt into one, m
  /// Each unit's true elevations are measured and reported; else the data sheet's are.
  bool calibrated = false;
  double dropout = 0.004;  ///< share of pulses lost at random
};

/// \brief Names makeLidar() knows.
const std::vector<std::string>& lidarNames();
/// \brief The LiDAR of that name, its small calibration offsets fixed by `unit` (a serial number).
/// \param upsideDown It hangs; beams are given as seen upright, so elevations change sign.
/// \throws Error for an unknown name.
LidarModel makeLidar(const std::string& name, bool upsideDown = false, unsigned unit = 1);
/// \brief The LiDAR of a simulation. `table` and `uniform` have the beams and firing steps of
/// `beams` and measure as an HDL-32E does; their name tells the number of beams and the field of
/// view. \param beams `[sensor]`; looked at for these two only, its mounting is that of `options`.
/// \throws Error for an unknown name, beams that make no sense, a height or place that no
/// simulation
///         has. Programs that do not simulate take such sensors.
LidarModel makeLidar(const SimulationOptions& options, const SensorOptions& beams = {});

}  // namespace polemcl::sim
