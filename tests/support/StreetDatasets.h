#pragma once
// Drives through a simulated street, written in the formats of datasets.

#include <cstdint>
#include <set>

#include "sim/drive/Simulation.h"
#include "support/TempFolder.h"

namespace testing_apps {

/// Converts labels of object ids to SemanticKITTI's classes.
void relabel(const fs::path& sequence, const std::set<std::uint32_t>& poles);

/// A drive of the LiDAR of `options` in the format of SemanticKITTI: `sequences/NN`, poses of a
/// forward-looking camera in its first frame. Points of all poles have the class of poles.
void writeSemanticKitti(const polemcl::sim::SimulationOptions& options, const fs::path& sequence);

/// KITTI raw: `DATE_drive_NNNN_sync` beside `calib_imu_to_velo.txt`; near latitude 49.
void writeKittiRaw(const polemcl::sim::SimulationOptions& options, const fs::path& drive);

/// MulRan: `Ouster/` with the LiDAR's x axis backwards, `global_pose.csv` of the vehicle in UTM.
void writeMulran(const polemcl::sim::SimulationOptions& options, const fs::path& sequence,
                 std::uint64_t startNanoseconds);

/// NCLT: `velodyne_sync/`, ground truth, odometry and its covariances; frames have z down. The
/// options have the LiDAR of config/nclt.ini. The true poles are written to `truth` (.npz), as in
/// the authors' pole maps.
void writeNclt(const polemcl::sim::SimulationOptions& options, const fs::path& session,
               std::uint64_t startMicroseconds, const fs::path& truth);

}  // namespace testing_apps
