#pragma once
/// \file MapUpdateBindings.h
/// \brief INI keys of the upkeep of maps.

#include "config/Config.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {

void bind(Binder& binder, MapUpdateOptions& options);  ///< `[map_update]`

}  // namespace polemcl
