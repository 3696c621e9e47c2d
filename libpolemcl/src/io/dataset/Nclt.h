#pragma once
/// \file Nclt.h
/// \brief Sessions of the North Campus Long-Term dataset (NCLT) in their published form.

#include "io/dataset/NcltScans.h"
#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Pose of NCLT's body frame (x forward, y right, z down) in the robot frame: a half turn
/// about x.
Eigen::Isometry3d ncltRobotBody();

/// \brief Reads a session. Scans: `velodyne_sync/*.bin` (file names are times in µs; the files may
/// also lie directly in the folder), otherwise `velodyne_hits.bin`. Optional:
/// `groundtruth_DATE.csv`, `cov_DATE.csv`, `odometry_mu_100hz.csv`, `odometry_mu.csv`,
/// `odometry_cov.csv`, `gps.csv`. Each file may lie in the folder or one level below. The ground
/// truth may also lie beside the folder or in `../ground_truth`; its date must then be the date in
/// the folder's name.
///
/// The folders of NCLT's own downloader are supported: ROOT/velodyne_data/DATE (or DATE_vel),
/// ROOT/sensor_data/DATE (or DATE_sen), ROOT/ground_truth, ROOT/ground_truth_cov. Name such a
/// session as ROOT/DATE (this folder need not exist) or as ROOT/velodyne_data/DATE. ROOT alone is
/// enough if it holds only one session.
///
/// Clouds are in the body frame (z down), as in velodyne_sync. Complete revolutions of
/// velodyne_hits.bin are transformed to the body frame. Where odometry exists, the motion of the
/// body during the revolution is compensated. Map frame: x east, y north, z up, with the origin of
/// the dataset, as in the published pole maps. The ground truth files use x north, y east, z down.
/// Rows with NaN are skipped. Scans without ground truth are dropped with a note; so are scans
/// without odometry if the session has odometry.
/// \param T_robot_body Pose of the cloud frame in the robot frame; usually ncltRobotBody().
/// \param progress Progress of the search for revolutions, in MB.
/// \throws Error with the file (and line): no scans, truncated scans, rows too short, several
///         candidates for one file, times of the files that do not overlap.
ScanFolder readNclt(const std::filesystem::path& session, const Eigen::Isometry3d& T_robot_body,
                    const ReadProgress& progress = {});

/// \brief Whether any file of such a session exists, see readNclt().
bool isNcltSession(const std::filesystem::path& session);

}  // namespace polemcl::io
