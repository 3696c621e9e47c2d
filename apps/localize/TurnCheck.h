#pragma once
/// \file TurnCheck.h
/// \brief Whether the settings say the same as sensors about how they turn. Private to the library.

#include <string>
#include <vector>

#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief A warning for each LiDAR of a scan that states its measuring times where `turn` and the
/// keys beside it set others. The settings win, so the poles are then moved wrongly.
std::vector<std::string> turnWarnings(const ReadScan& scan, const SequenceOptions& options);

}  // namespace polemcl::apps
