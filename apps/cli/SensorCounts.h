#pragma once
/// \file SensorCounts.h
/// \brief What people and scripts are told of the sensors of a rawlog.

#include <iosfwd>
#include <string>
#include <vector>

#include "cli/JsonFile.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief Warnings: a sentence for each LiDAR whose scans look raw though nothing says so, and one
/// if `[sensor] turn` is set, but stored poles were extracted with another.
std::vector<std::string> turnDoubts(const SequenceCounts& counts, const ScanTiming& timing);

/// \brief A line for each LiDAR that was fused, with how well it agrees with the others; a line for
/// scans that were not used, with their sensors and what to write in order to use them.
void printSensors(std::ostream& out, const SequenceCounts& counts);

/// \brief An object for each LiDAR that was fused, in a list.
Json lidarsJson(const SequenceCounts& counts);

}  // namespace polemcl::apps
