#pragma once
/// \file DetectionModelFit.h
/// \brief Fits a DetectionModel to detections of an extractor on ray-cast streets.

#include <string>
#include <vector>

#include "sim/detections/DetectionModel.h"
#include "sim/drive/Simulation.h"

namespace polemcl::sim {

/// \brief A simulated drive with the extractor's detections in each of its scans.
struct ObservedDrive {
  const SimulatedDrive* drive = nullptr;
  std::vector<std::vector<PoleDetection>> poles;  ///< per scan, in the frame of the written clouds
  std::vector<std::uint32_t> points;              ///< number of valid points per scan
};

/// \brief One street on two days, driven with the same spacing of scans. Common parts belong to the
/// place, differences to the day.
struct ObservedStreet {
  ObservedDrive first, second;
};

/// \brief Fits all parts of the model by counting (share/doc/simulation.md). Detections within 0.5
/// m of a true pole belong to this pole. Other detections are clutter if three or more fall on one
/// place.
/// \param maxRange Range of the extraction, m. \param fittedOn Description for humans.
/// \throws Error without a street, when the days of a street differ in more than day and drive,
///         when drives differ in LiDAR, its height or spacing, or when hardly any pole is found.
DetectionModel fitDetectionModel(const std::vector<ObservedStreet>& streets, double maxRange,
                                 const std::string& fittedOn);

}  // namespace polemcl::sim
