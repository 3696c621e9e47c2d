#pragma once
/// \file DriveDoubts.h
/// \brief Sentences for people about a drive without true poses: do its poles say that odometry or
/// positions from satellites are wrong? Empty when there is nothing to say.

#include <string>

#include "core/slam/DriveFixes.h"
#include "core/slam/PoleMotions.h"

namespace polemcl::apps {

/// \brief Motions of the odometry that the poles contradict.
std::string odometryDoubt(const FilledMotions& filled);

/// \brief Positions from satellites of which many do not fit the path.
std::string fixesDoubt(const FixFit& fit);

}  // namespace polemcl::apps
