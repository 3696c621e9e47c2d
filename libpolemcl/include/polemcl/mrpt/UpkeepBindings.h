#pragma once
/// \file UpkeepBindings.h
/// \brief INI keys of the upkeep of maps.

#include <polemcl/core/MapUpkeep.h>
#include <polemcl/mrpt/Config.h>

namespace polemcl {

void bind(Binder& binder, UpkeepOptions& options);  ///< `[upkeep]`

}  // namespace polemcl
