#pragma once
/// \file StreetDatasets.h
/// \brief Drives through a simulated street, written as the owners of datasets write theirs.

#include <cstdint>
#include <set>

#include "sim/drive/Simulation.h"
#include "support/TempFolder.h"

namespace testing_apps {

/// Labels of object ids become SemanticKITTI's classes, as its owners would have drawn them.
void relabel(const fs::path& sequence, const std::set<std::uint32_t>& poles);

/// A drive of the LiDAR of `options`, in the format of SemanticKITTI: `sequences/NN`, poses of a
/// camera that looks ahead, in its first frame; points of all poles have the class of poles.
void writeSemanticKitti(const polemcl::sim::SimulationOptions& options, const fs::path& sequence);

/// KITTI raw: `DATE_drive_NNNN_sync` beside `calib_imu_to_velo.txt`; near latitude 49.
void writeKittiRaw(const polemcl::sim::SimulationOptions& options, const fs::path& drive);

/// MulRan: `Ouster/` with the LiDAR's x axis to the back, `global_pose.csv` of the vehicle in UTM.
void writeMulran(const polemcl::sim::SimulationOptions& options, const fs::path& sequence,
                 std::uint64_t startNanoseconds);

/// NCLT: `velodyne_sync/`, ground truth, odometry and its covariances; frames have z down. The
/// options have the LiDAR as config/nclt.ini has it. The true poles, as the authors' pole maps have
/// them, go to `truth` (.npz).
void writeNclt(const polemcl::sim::SimulationOptions& options, const fs::path& session,
               std::uint64_t startMicroseconds, const fs::path& truth);

}  // namespace testing_apps
