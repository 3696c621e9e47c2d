#pragma once
/// \file Repeatability.h
/// \brief Whether poles are found again: in the next scans of a drive, and when a scan is turned.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include <polemcl/core/extraction/PoleExtractor.h>

namespace polemcl {

/// \brief What counts as found again.
struct RepeatabilityOptions {
  double radius = 0.25;     ///< m, exclusive
  std::size_t next = 5;     ///< scans after a detection's own that are searched
  std::size_t atLeast = 3;  ///< of these must hold it
};

struct RepeatabilityScore {
  std::size_t scans = 0, detections = 0;  ///< all
  std::size_t judged = 0;                 ///< detections in scans with enough scans after them
  std::size_t repeated = 0;               ///< of these, found again
  double perScan = 0;                     ///< detections / scans
  double share = 0;                       ///< repeated / judged; 0 when none is judged
};

/// \brief Counts the detections that are found again near the same place in enough of the next
/// scans. The last `next` scans are searched but not judged.
/// \param scans_map Positions of each scan's poles, in order, all in one frame that stands still.
/// \throws Error when there are no more than `next` scans, or an option makes no sense.
RepeatabilityScore evaluateRepeatability(const std::vector<std::vector<Eigen::Vector2d>>& scans_map,
                                         const RepeatabilityOptions& options = {});

struct RotationScore {
  std::size_t scans = 0, turns = 0;        ///< scans, and turned copies of them
  std::size_t poles = 0, turnedPoles = 0;  ///< each scan's poles once per turn; those of the copies
  std::size_t matched = 0;                 ///< one to one
  double share = 0;                        ///< matched / poles; 0 without poles
  double backShare = 0;                    ///< matched / turnedPoles; 0 without
};

/// \brief Turns a scan by 30°, 60°, … 330° about z, extracts again and adds to `score` how many of
/// its poles are found again in their place.
/// \param points One turn, lidar frame. \param radius Matching radius, m, inclusive.
void addRotations(PoleExtractor& extractor, const PointsView& points, double radius,
                  RotationScore& score);

}  // namespace polemcl
