#pragma once
/// \file DetectionSummary.h
/// \brief Statistics of a drive's detections, to compare sampled ones with ray-cast ones.

#include <array>
#include <optional>
#include <vector>

#include "sim/detections/DetectionModelFit.h"

namespace polemcl::sim {

/// \brief Metrics of one drive. A pole counts if it is within the range and not hidden by a house.
/// A detection is correct if it is assigned to a true pole within 0.5 m, one to one. Values without
/// data are nullopt.
struct DetectionSummary {
  std::size_t scans = 0, detections = 0;
  double perScan = 0, falsePerScan = 0;
  /// The part of these that belongs to objects found three times or more in the drive.
  double lastingFalsePerScan = 0;
  std::vector<double> rangeEdges;             ///< 0, 5, 10, … m
  std::vector<std::optional<double>> recall;  ///< share of the poles found between two edges
  std::optional<double> centreMedian, centre90, neesMean, neesMedian;
  /// Mean path length over which a pole is found in every scan, or in no scan, m. Only complete
  /// runs count, not those cut off at the limits of visibility.
  std::optional<double> foundRun, missedRun;
  std::optional<double> confidence;  ///< mean of the correct detections
};

/// \brief \param maxRange Range of the extraction, m. \throws Error when there is no scan.
DetectionSummary summarizeDetections(const ObservedDrive& observed, double maxRange);

}  // namespace polemcl::sim
