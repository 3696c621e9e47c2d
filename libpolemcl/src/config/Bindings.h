#pragma once
/// \file Bindings.h
/// \brief INI keys of the option structs of `core/` and `mrpt/`: one line per field.

#include "config/Config.h"
#include "core/extraction/ExtractionOptions.h"
#include "core/global_localization/GlobalLocalizer.h"
#include "core/localization/LocalSubmap.h"
#include "core/localization/LocalizationHealth.h"
#include "core/localization/OdometryMonitor.h"
#include "core/localization/PoleLikelihood.h"
#include "core/mapping/PoleMapBuilder.h"
#include "core/sensor/SensorOptions.h"

namespace polemcl {

void bind(Binder& binder, SensorOptions& options);  ///< `[sensor]`
void bind(Binder& binder,
          ExtractionOptions& options);  ///< `[extraction]`, `[range_image]`, `[scan_line]`
void bind(Binder& binder, PoleMapOptions& options);          ///< `[map]`
void bind(Binder& binder, LikelihoodOptions& options);       ///< `[likelihood]`
void bind(Binder& binder, SubmapOptions& options);           ///< `[submap]`
void bind(Binder& binder, GlobalOptions& options);           ///< `[global]`
void bind(Binder& binder, HealthOptions& options);           ///< `[health]`
void bind(Binder& binder, OdometryMonitorOptions& options);  ///< `[odometry_monitor]`

}  // namespace polemcl
