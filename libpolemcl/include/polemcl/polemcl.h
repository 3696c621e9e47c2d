#pragma once
/// \file polemcl.h
/// \brief All of polemcl::polemcl. See share/doc/cpp.md.

#include <polemcl/config/Config.h>
#include <polemcl/core.h>
#include <polemcl/io/data/Cloud.h>
#include <polemcl/io/data/PlanarMotion.h>
#include <polemcl/io/map/PoleMapFile.h>
#include <polemcl/localizer/Localizer.h>
#include <polemcl/localizer/Settings.h>
#include <polemcl/mrpt/common/Compatibility.h>
#include <polemcl/mrpt/common/RegisterClasses.h>
#include <polemcl/mrpt/filter/FilterOptions.h>
#include <polemcl/mrpt/filter/LocalizationPipeline.h>
#include <polemcl/mrpt/filter/PoleParticleFilter.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include <polemcl/mrpt/rawlog/MotionOptions.h>
#include <polemcl/mrpt/rawlog/PoleSequence.h>
#include <polemcl/mrpt/rawlog/VehicleOptions.h>
