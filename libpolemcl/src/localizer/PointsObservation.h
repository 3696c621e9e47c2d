#pragma once
/// \file PointsObservation.h
/// \brief A borrowed cloud as an observation of MRPT.

#include <mrpt/obs/CObservationPointCloud.h>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief The points with a time stamp and the identity as sensor pose. \param time s.
/// \throws Error when MRPT's clock does not have that time, or an array is missing.
mrpt::obs::CObservationPointCloud observationOf(double time, const PointsView& points);

}  // namespace polemcl
