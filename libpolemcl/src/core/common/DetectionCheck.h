#pragma once
/// \file DetectionCheck.h
/// \brief Which detections and times can be used.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief What is wrong with a detection, e.g. "a confidence outside [0, 1]"; null if nothing is.
/// All numbers must be finite, x and y at most PoleIndex::farthest, the confidence in [0, 1], the
/// covariance one by isCovariance(), and no number so great that sums or products overflow.
const char* faultOf(const PoleDetection& pole);

/// Most poles of a scan that maps and localization use. It limits the time of each.
constexpr std::size_t mostDetections = 200;

/// \brief Keeps the most confident poles of a scan that has too many, in their order; of equal ones
/// the earlier.
void keepMostConfident(std::vector<PoleDetection>& poles);

/// \brief Whether a time can be one in seconds: at least 0 and below 1e11, as MRPT's clock. One in
/// nanoseconds, or NaN, is not.
constexpr bool isTimeInSeconds(double time) {
  return time >= 0 && time < 1e11;
}
constexpr const char* kTimeAllowed = "times are seconds, at least 0 and below 1e11";

}  // namespace polemcl
