#pragma once
/// \file PoleEvidence.h
/// \brief What the scan says for and against a candidate: rows that hit it, pass through, stand in
/// the way.

#include <polemcl/core/GroundGrid.h>
#include <polemcl/core/PoleFitting.h>
#include <polemcl/core/PoleStacks.h>

namespace polemcl {

/// \brief What one beam meets at a candidate's place.
enum class Meeting {
  near,      ///< a return at the place
  passed,    ///< a return from behind: the beam went through
  empty,     ///< no return at all
  occluded,  ///< a return from before it
};

/// \brief Evidence about one candidate. Heights in m above local ground.
struct PoleEvidence {
  int slices = 0;         ///< rows with a slice
  int points = 0;         ///< returns in them
  int wholeSlices = 0;    ///< with both sides free
  int rowsPassed = 0;     ///< rows between bottom and top that saw through it (or nothing)
  int rowsWide = 0;       ///< rows between bottom and top that met something there that is no slice
  int rowsCluttered = 0;  ///< rows of slices with other returns in the ring around it
  float bottom = 0;       ///< lowest return
  float top = 0;          ///< highest return, whatever stands on it (sign, crown) included
  float topBound = 0;     ///< height of the lowest beam that passed over it; infinity when none did
  float slimHeight = 0;   ///< from lowest to highest slice
  float scatter = 0;      ///< rms distance of the slices' middles from a straight line, m
  float tilt = 0;         ///< of that line against the vertical, rad
  float widthSpread = 0;  ///< standard deviation of the slices' widths, m
};

PoleEvidence gatherEvidence(const ScanLines& lines, const SensorModel& sensor,
                            const GroundGrid& ground, const std::vector<Slice>& slices,
                            const Stack& stack, const PoleFit& fit);

}  // namespace polemcl
