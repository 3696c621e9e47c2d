#pragma once
/// \file core.h
/// \brief All of polemcl::core, which needs no MRPT: extraction, mapping, likelihood, global
/// localization.

#include <polemcl/core/common/Binder.h>
#include <polemcl/core/common/Deskew.h>
#include <polemcl/core/common/PathSections.h>
#include <polemcl/core/common/PoleIndex.h>
#include <polemcl/core/common/PoseEstimate.h>
#include <polemcl/core/common/Types.h>
#include <polemcl/core/evaluation/TrajectoryEvaluation.h>
#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/ExtractionReport.h>
#include <polemcl/core/extraction/PoleExtractor.h>
#include <polemcl/core/global_localization/GlobalLocalizer.h>
#include <polemcl/core/localization/KldSampleSize.h>
#include <polemcl/core/localization/LocalMaps.h>
#include <polemcl/core/localization/LocalSubmap.h>
#include <polemcl/core/localization/LocalizationHealth.h>
#include <polemcl/core/localization/MapAssociation.h>
#include <polemcl/core/localization/OdometryCalibration.h>
#include <polemcl/core/localization/OdometryDrift.h>
#include <polemcl/core/localization/OdometryMonitor.h>
#include <polemcl/core/localization/PoleLikelihood.h>
#include <polemcl/core/localization/ScanRegistration.h>
#include <polemcl/core/mapping/AlignmentOptions.h>
#include <polemcl/core/mapping/MapUpdater.h>
#include <polemcl/core/mapping/PoleExistence.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include <polemcl/core/sensor/PinholeCamera.h>
#include <polemcl/core/sensor/ScanTiming.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/version.h>
