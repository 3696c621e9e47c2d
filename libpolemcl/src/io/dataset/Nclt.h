#pragma once
/// \file Nclt.h
/// \brief Sessions of the North Campus Long-Term dataset (NCLT), as its owners publish them.

#include "io/dataset/NcltScans.h"
#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief NCLT's body in the robot frame: its x ahead, y right, z down, turned upright about x.
Eigen::Isometry3d ncltRobotBody();

/// \brief Reads a session: `velodyne_sync/*.bin` (named by their times in µs; also right in the
/// folder), else `velodyne_hits.bin`; `groundtruth_DATE.csv`, `cov_DATE.csv`,
/// `odometry_mu_100hz.csv`, `odometry_mu.csv`, `odometry_cov.csv`, all optional. Each may lie in
/// the folder or one below it; the truth also beside the folder or in `../ground_truth`, of the
/// date in the folder's name.
///
/// The folders of NCLT's own downloader are known as well: ROOT/velodyne_data/DATE (or DATE_vel),
/// ROOT/sensor_data/DATE (or DATE_sen), ROOT/ground_truth, ROOT/ground_truth_cov. The session is
/// then ROOT/DATE, though there is no such folder, or ROOT/velodyne_data/DATE; or ROOT when it
/// holds one session only.
///
/// Clouds are in the body frame (z down), as velodyne_sync has them. Whole turns of
/// velodyne_hits.bin are brought there, with the body's motion during the turn taken out where
/// there is odometry. Map frame: x east, y north, z up, the origin that of the dataset, as in the
/// published pole maps; the truth's files have x north, y east, z down. Rows with NaN are passed
/// over. Scans at times without truth, or without odometry where there is some, are left out, with
/// a note.
/// \param T_robot_body The frame of the clouds in the robot frame; ncltRobotBody() if in doubt.
/// \param progress Of the search for turns, in MB.
/// \throws Error naming the file (and line): no scans, scans cut short, rows too short, several
///         files that may be meant, times of the files that do not overlap.
ScanFolder readNclt(const std::filesystem::path& session, const Eigen::Isometry3d& T_robot_body,
                    const ReadProgress& progress = {});

/// \brief Whether there is anything of a session by that name, see readNclt().
bool isNcltSession(const std::filesystem::path& session);

}  // namespace polemcl::io
