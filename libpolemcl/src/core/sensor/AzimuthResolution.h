#pragma once
/// \file AzimuthResolution.h
/// \brief How often a spinning LiDAR fires in a turn. Private to the library.

#include "core/sensor/BeamTableEstimator.h"

namespace polemcl {

/// \brief Firing steps in a full turn: the commonest step of azimuth between neighbours on a beam.
/// \param beams Beams of these scans. \return 0 when no step stands out.
int azimuthResolution(const std::vector<PointsView>& scans, const BeamTableEstimate& beams);

}  // namespace polemcl
