#pragma once
/// \file MapUpdateBindings.h
/// \brief INI keys of map updates.

#include "config/Config.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {

void bind(Binder& binder, MapUpdateOptions& options);  ///< `[map_update]`

}  // namespace polemcl
