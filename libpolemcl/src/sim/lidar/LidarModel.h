#pragma once
/// \file LidarModel.h
/// \brief Spinning LiDARs after their data sheets, with the small offsets of real ones.

#include <Eigen/Core>
#include <string>
#include <vector>

#include <polemcl/core/sensor/SensorOptions.h>
#include "sim/common/SimulationOptions.h"

namespace polemcl::sim {

/// \brief One laser of the rotor.
struct Beam {
  double elevation = 0;       ///< reported value, rad, above the sensor's x-y plane
  double elevationError = 0;  ///< true minus reported, rad
  double azimuth = 0;         ///< offset from the rotor's azimuth, rad, counter-clockwise
  double rise = 0;            ///< start above the optical centre, m (HDL-64E: two blocks)
  double rangeBias = 0;       ///< residual of the calibration, m
};

/// \brief A LiDAR: beams from top to bottom, firing steps per revolution, and accuracy.
struct LidarModel {
  std::string name;
  std::vector<Beam> beams;
  int columns = 0;             ///< firing steps per revolution
  bool clockwise = true;       ///< direction of rotation seen from above
  double startAzimuth = 0;     ///< azimuth of the first firing step, rad
  double period = 0.1;         ///< time of one revolution, s
  double divergence = 0.002;   ///< full angle of the beam, rad
  double rangeNoise = 0.02;    ///< standard deviation at good signal, m
  double rangeStep = 0.002;    ///< resolution of the range, m
  double minRange = 1.0;       ///< m
  double maxRange = 100;       ///< m
  double referenceRange = 80;  ///< half of the pulses return from 10 % reflectivity, m
  double pulseLength = 0.6;    ///< returns nearer to each other are merged, m
  /// True: the unit's true elevations are measured and reported. False: those of the data sheet
  /// are.
  bool calibrated = false;
  double dropout = 0.004;  ///< share of pulses lost at random
  /// The true range is rangeScale * measured range + rangeOffset, as `[sensor]` says.
  double rangeOffset = 0;  ///< m
  double rangeScale = 1;
};

/// Standard deviation of Beam::rangeBias as a share of LidarModel::rangeNoise.
inline constexpr double kCalibrationError = 0.4;

/// \brief Names that makeLidar() knows.
const std::vector<std::string>& lidarNames();
/// \brief The LiDAR with this name. `unit` (a serial number) determines its small calibration
/// offsets.
/// \param upsideDown The sensor hangs. Beams are given with z up, so elevations change sign.
/// \throws Error for an unknown name.
LidarModel makeLidar(const std::string& name, bool upsideDown = false, unsigned unit = 1);
/// \brief The LiDAR of a simulation. `table` and `uniform` have the beams and firing steps of
/// `beams`, and the accuracy of an HDL-32E. Their name states the number of beams and the field of
/// view.
/// \param beams `[sensor]`: beams for these two only; ranges that are off for all. Its mounting
///        is not used; that comes from `options`.
/// \throws Error for an unknown name, invalid beams, or a height or origin that the simulation does
///         not support. (Programs that do not simulate accept such sensors.)
LidarModel makeLidar(const SimulationOptions& options, const SensorOptions& beams = {});

/// \brief Measuring times of its scans with `motion_distortion`; stamped in the middle of the turn.
ScanTiming timingOf(const LidarModel& lidar);

}  // namespace polemcl::sim
