#pragma once
/// \file DetectionModelFit.h
/// \brief Fits a DetectionModel to what an extractor reported on ray-cast streets.

#include <string>
#include <vector>

#include "sim/detections/DetectionModel.h"
#include "sim/drive/Simulation.h"

namespace polemcl::sim {

/// \brief A simulated drive and what an extractor found in each of its scans.
struct ObservedDrive {
  const SimulatedDrive* drive = nullptr;
  std::vector<std::vector<PoleDetection>> poles;  ///< by scan, in the frame of the written clouds
  std::vector<std::uint32_t> points;              ///< valid points, by scan
};

/// \brief One street on two days, driven with the same spacing of scans: what is the same on both
/// belongs to the place, what differs to the day.
struct ObservedStreet {
  ObservedDrive first, second;
};

/// \brief Fits all parts of the model by counting (share/doc/simulation.md): detections within
/// 0.5 m of a true pole are of it; others that fall on one place three times or more are clutter.
/// \param maxRange Of the extraction, m. \param fittedOn For people.
/// \throws Error when there is no street, the days of one differ in more than day and drive, or
///         hardly any pole is found.
DetectionModel fitDetectionModel(const std::vector<ObservedStreet>& streets, double maxRange,
                                 const std::string& fittedOn);

}  // namespace polemcl::sim
