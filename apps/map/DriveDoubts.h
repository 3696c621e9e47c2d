#pragma once
/// \file DriveDoubts.h
/// \brief Do the poles of a drive without true poses say that its odometry is wrong? A sentence for
/// people, empty when there is nothing to say.

#include <string>

#include "core/slam/PoleMotions.h"

namespace polemcl::apps {

/// \brief Motions of the odometry that the poles contradict.
std::string odometryDoubt(const FilledMotions& filled);

}  // namespace polemcl::apps
