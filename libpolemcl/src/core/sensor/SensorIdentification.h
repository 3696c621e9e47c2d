#pragma once
/// \file SensorIdentification.h
/// \brief What LiDAR is this, and how is it mounted? Estimated from a few of its scans.

#include <optional>
#include <string>
#include <vector>

#include <polemcl/core/sensor/SensorOptions.h>
#include "core/sensor/BeamTableEstimator.h"
#include "core/sensor/GroundPlane.h"

namespace polemcl {

/// \brief How well the beams of a preset agree with those found.
struct PresetFit {
  std::string model;
  bool upsideDown = false;
  int rows = 0;         ///< beams of the preset
  int found = 0;        ///< beams found in the scans
  int matched = 0;      ///< of these, how many lie beside a preset's beam of their own
  double rms = 0;       ///< of the matched ones' differences in elevation, rad
  double rmsShare = 0;  ///< the same as a share of the angle between the preset's beams
  double originZ = 0;   ///< the preset's origin above the cloud's, m
  /// All beams match, few of the preset's are missing, and the differences are small against the
  /// angles between beams.
  bool fits = false;
};

/// \brief What the scans say about their sensor. Everything is as seen with the ground below: when
/// `onItsHead`, the clouds were turned by half a turn about x first.
struct SensorIdentification {
  std::size_t scans = 0, points = 0, invalid = 0;
  bool onItsHead = false;  ///< the ground is on the side of +z of the clouds
  BeamTableEstimate beams;
  int columns = 0;                    ///< firing steps in a full turn; 0: could not be told
  double covered = 0;                 ///< share of the full turn with returns
  double nearest = 0, farthest = 0;   ///< horizontal range of the returns, m (1 % to 99 %)
  std::optional<GroundPlane> ground;  ///< of the scan in the middle of all by height
  std::vector<PresetFit> presets;     ///< best first

  /// \brief The best preset, if it fits well.
  const PresetFit* preset() const;
  /// \brief `[sensor]` for clouds like these: the preset if one fits well, else a table.
  SensorOptions options() const;
};

/// \brief Inspects a few scans of one sensor. Beams are found without returns that may be the
/// vehicle's own: nearer than 3 m and higher than 0.4 m over the ground. Where no preset fits all
/// scans together, each is tried alone: correction for motion bends the beams of each scan by its
/// own speed.
/// \param scans In the sensor's own axes; the order of points does not matter.
/// \throws Error as estimateBeamTable().
SensorIdentification identifySensor(const std::vector<PointsView>& scans);

}  // namespace polemcl
