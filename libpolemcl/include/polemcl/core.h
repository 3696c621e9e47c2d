#pragma once
/// \file core.h
/// \brief All of polemcl::core, which needs no MRPT: poles of a scan, a map of them, its
/// likelihood.

#include <polemcl/core/common/Types.h>
#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/ExtractionReport.h>
#include <polemcl/core/extraction/PoleExtractor.h>
#include <polemcl/core/localization/LocalizationUpdate.h>
#include <polemcl/core/localization/PoleLikelihood.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/version.h>
