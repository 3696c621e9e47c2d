#pragma once
/// \file DetectionSummary.h
/// \brief What a drive's detections are like in numbers, to compare drawn ones with cast ones.

#include <array>
#include <optional>
#include <vector>

#include "sim/detections/DetectionModelFit.h"

namespace polemcl::sim {

/// \brief Figures of one drive. A pole counts when it stands within the range and no house hides
/// it; a detection is right within 0.5 m of a true pole, one to one. What there is nothing to
/// compute from is none.
struct DetectionSummary {
  std::size_t scans = 0, detections = 0;
  double perScan = 0, falsePerScan = 0;
  /// Of these, of objects that are found three times or more in the drive.
  double lastingFalsePerScan = 0;
  std::vector<double> rangeEdges;             ///< 0, 5, 10, … m
  std::vector<std::optional<double>> recall;  ///< share of the poles found between two edges
  std::optional<double> centreMedian, centre90, neesMean, neesMedian;
  /// Mean length of the way over which a pole is found in each scan, or in none, within runs that
  /// begin and end in sight, m.
  std::optional<double> foundRun, missedRun;
  std::optional<double> confidence;  ///< mean, of right detections
};

/// \brief \param maxRange Of the extraction, m. \throws Error when there is no scan.
DetectionSummary summarizeDetections(const ObservedDrive& observed, double maxRange);

}  // namespace polemcl::sim
