#pragma once
/// \file Weather.h
/// \brief Rain and spray: returns from drops, and dimmer surfaces.

#include <optional>

#include "sim/common/Random.h"
#include "sim/common/RealismOptions.h"

namespace polemcl::sim {

/// \brief Range of the drop that a pulse meets first, m; nothing if it meets none.
/// \param azimuth, elevation Direction of the pulse, sensor frame, rad; the vehicle drives along x.
std::optional<double> dropRange(const RealismOptions& realism, double azimuth, double elevation,
                                Random& random);

/// \brief Factor of the signal from a surface at a range, m: wet surfaces are darker, and drops
/// take energy on both ways.
double rainFactor(const RealismOptions& realism, double range);

}  // namespace polemcl::sim
