#pragma once
/// \file ScanFusion.h
/// \brief The poles of several LiDARs on one vehicle -> one observation in the robot frame.

#include <string>
#include <vector>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "core/common/Deskew.h"
#include "core/common/DetectionFusion.h"

namespace polemcl {

/// \brief Sensor label of observations that were fused; also where one LiDAR alone saw the scan, so
/// that the scans of a drive have one label.
extern const char* const kFusedLabel;

struct FusedScan {
  CObservationPoles::Ptr observation;
  std::vector<FusionAgreement> agreements;  ///< of each part with the parts before it
};

/// \brief Fuses scans that belong together, see fuseDetections(). `sensorPose` is the robot itself,
/// so that the planar sensor frame is the robot frame. Time offsets of the poles count from `time`.
/// A direction is visible as far as one of the LiDARs sees; see fusedVisibility().
/// \param parts At least one; each with its own time stamp and sensor pose.
/// \param time Time stamp of the result, s.
/// \param velocity The velocity of the robot at that time.
FusedScan fuseScans(const std::vector<CObservationPoles::Ptr>& parts, double time,
                    const Velocity& velocity);

/// \brief Visibility ranges around the robot's origin, as many as the part with most has: the
/// range up to which all places in that direction lie within the visibility range of one LiDAR.
/// Unknown (0) where that is unknown for all. The motion between the scans is not considered.
std::vector<float> fusedVisibility(const std::vector<CObservationPoles::Ptr>& parts);

}  // namespace polemcl
