#pragma once
/// \file SimulationBindings.h
/// \brief INI keys of the simulation: one line per field.

#include "config/Config.h"
#include "sim/common/SimulationOptions.h"

namespace polemcl::sim {

void bind(Binder& binder, WorldOptions& options);  ///< `[world]`
/// \brief `[simulation]` and `[world]`. The LiDAR and its mounting come from `[sensor]`; the
/// program copies them.
void bind(Binder& binder, SimulationOptions& options);

}  // namespace polemcl::sim
