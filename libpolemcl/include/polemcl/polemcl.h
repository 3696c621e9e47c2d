#pragma once
/// \file polemcl.h
/// \brief All of polemcl::polemcl. See share/doc/cpp.md.

#include <polemcl/core.h>
#include <polemcl/io/data/Cloud.h>
#include <polemcl/io/rosbag/PackedCloud.h>
#include <polemcl/localizer/Localizer.h>
#include <polemcl/localizer/MapBuilder.h>
#include <polemcl/localizer/Settings.h>
#include <polemcl/mrpt/common/Compatibility.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
