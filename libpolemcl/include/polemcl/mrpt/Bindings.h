#pragma once
/// \file Bindings.h
/// \brief INI keys of the option structs of `core/` and `mrpt/`: one line per field.

#include <polemcl/core/ExtractionOptions.h>
#include <polemcl/core/GlobalLocalizer.h>
#include <polemcl/core/LocalSubmap.h>
#include <polemcl/core/LocalizationHealth.h>
#include <polemcl/core/MotionCheck.h>
#include <polemcl/core/PoleLikelihood.h>
#include <polemcl/core/PoleMapBuilder.h>
#include <polemcl/mrpt/Config.h>
#include <polemcl/mrpt/MotionOptions.h>

namespace polemcl {

void bind(Binder& binder, SensorOptions& options);       ///< `[sensor]`
void bind(Binder& binder, ExtractionOptions& options);   ///< `[extraction]`, `[paper]`, `[native]`
void bind(Binder& binder, PoleMapOptions& options);      ///< `[map]`
void bind(Binder& binder, LikelihoodOptions& options);   ///< `[likelihood]`
void bind(Binder& binder, MotionOptions& options);       ///< `[motion]`
void bind(Binder& binder, SubmapOptions& options);       ///< `[submap]`
void bind(Binder& binder, GlobalOptions& options);       ///< `[global]`
void bind(Binder& binder, HealthOptions& options);       ///< `[health]`
void bind(Binder& binder, MotionCheckOptions& options);  ///< `[motion_check]`

}  // namespace polemcl
