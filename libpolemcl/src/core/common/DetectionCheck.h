#pragma once
/// \file DetectionCheck.h
/// \brief Which detections can be used.

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief What is wrong with a detection, e.g. "a confidence outside [0, 1]"; null if nothing is.
/// All numbers must be finite, x and y at most PoleIndex::farthest, the confidence in [0, 1], the
/// covariance one by isCovariance().
const char* faultOf(const PoleDetection& pole);

}  // namespace polemcl
