#pragma once
/// \file SettingsValues.h
/// \brief What Settings holds: the options of all rooms of the library.

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/localization/PoleLikelihood.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/localizer/Settings.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Binder.h"
#include "core/mapping/MapUpdater.h"
#include "mrpt/filter/FilterOptions.h"
#include "mrpt/filter/LocalizationPipeline.h"
#include "mrpt/rawlog/MotionOptions.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {

struct POLEMCL_EXPORT SettingsValues {
  SensorOptions sensor;          ///< `[sensor]`
  ExtractionOptions extraction;  ///< `[extraction]`, `[range_image]`, `[scan_line]`
  PoleMapOptions map;            ///< `[map]`
  MapUpdateOptions upkeep;       ///< `[map_update]`
  LikelihoodOptions likelihood;  ///< `[likelihood]`
  MotionOptions motion;          ///< `[motion]`
  VehicleOptions vehicle;        ///< `[vehicle]`, and the sections of its LiDARs
  /// `[filter] [tracking] [search] [odometry_monitor] [odometry_calibration]`
  LocalizationOptions localization;
  StartOptions start;  ///< `[start]`
  RunOptions runs;     ///< `[runs]`

  /// \brief What the extraction needs.
  ObservationPoleExtractorOptions poleExtraction() const { return {sensor, extraction}; }
  /// \brief What reading rawlogs and sensors needs.
  SequenceOptions reading() const;
};

/// \brief Binds all sections, in the order of the reference page.
POLEMCL_EXPORT void bind(Binder& binder, SettingsValues& values);

}  // namespace polemcl
