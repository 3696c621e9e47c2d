#pragma once
/// \file SensorKeys.h
/// \brief The keys of `[sensor]` in a section of another name.

#include <polemcl/core/sensor/SensorOptions.h>
#include "core/common/Binder.h"

namespace polemcl {

/// \brief As bind(), in the open section.
void bindKeys(Binder& binder, SensorOptions& options);

}  // namespace polemcl
