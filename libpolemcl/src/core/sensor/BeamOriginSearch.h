#pragma once
/// \file BeamOriginSearch.h
/// \brief From where the elevations of a cloud gather in beams. Private to the library.

#include "core/sensor/ElevationHistogram.h"

namespace polemcl {

/// \brief The origin of the upper block; how much deeper the lower one's is, and where they part.
struct BlockOrigins {
  BeamOrigin upper;
  bool two = false;
  double lowerZ = 0;      ///< m, of the lower block; upper.z when there is one block
  double splitSlope = 0;  ///< returns with z - (upper.z + lowerZ) / 2 < rho · splitSlope are lower
};

/// \brief Searches heights of ±2.5 m, then places of ±2 m, the slide of motion-corrected clouds,
/// and two blocks, keeping only what makes the beams clearly sharper.
BlockOrigins searchOrigins(ElevationHistogram& spectrum);

}  // namespace polemcl
