#pragma once
/// \file ScanPoints.h
/// \brief The points of a scan as they are shown.

#include <mrpt/math/TPoint3D.h>
#include <mrpt/obs/CObservation.h>

#include <vector>

#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::report {

/// \brief Robot frame, without points that are no returns; at most 50000, evenly chosen.
/// \param sources Of one scan, as in ReadScan. \param reading As the scan was read.
/// \throws Error as ObservationPoints::read().
std::vector<mrpt::math::TPoint3Df> scanPoints(
    const std::vector<mrpt::obs::CObservation::Ptr>& sources, const SequenceOptions& reading);

}  // namespace polemcl::report
