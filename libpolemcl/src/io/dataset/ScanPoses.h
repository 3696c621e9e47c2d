#pragma once
/// \file ScanPoses.h
/// \brief True poses and odometry for the scans of a folder, from tracks with other time stamps.

#include "io/data/TrackSampler.h"
#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Longest gap of a track that is interpolated, s: the vehicle may turn during longer gaps.
constexpr double kTrackGap = 1.0;

/// \brief Share of assumedCovariance(), where the odometry (or for the yaw the IMU) states none.
constexpr double kDefaultMotionNoise = 0.02;

/// \brief Adds a note if rows of a track were ignored.
void noteUnusedRows(std::size_t rows, const std::filesystem::path& file,
                    std::vector<std::string>& notes);

/// \brief Times of the scans, s.
std::vector<double> timesOf(const ScanFolder& folder);

/// \brief Drops the scans with `keep` false and adds a note. Their motions are composed with that
/// of the next remaining scan.
/// \param keep One value per scan. \param why Reason for the note, such as "at times without
///        truth".
void keepScans(ScanFolder& folder, const std::vector<bool>& keep, const std::string& why);

/// \throws Error with both time spans when the sampled track has no pose for any scan.
/// \param file Source of the track. \param what Content of the track, such as "truth".
void requireOverlap(const ScanFolder& folder, const TrackSampler& track,
                    const std::filesystem::path& file, const std::string& what);

/// \param where Prefix of the message. \param isLevel Whether the odometry's frame has z up: then
///        its poses tell which axis of the robot points up.
/// \throws Error when the odometry moves along its z axis more than in x and y, as a camera does,
///         or its z axis points down.
void requireVehicleFrame(const TrackSampler& track, const std::string& where, bool isLevel);

/// \brief Gives the scans the poses of a sampled track. Scans without a pose are dropped.
/// \param why Reason for the note, see keepScans(). \throws Error as requireOverlap(), which takes
///        the other arguments.
void takePoses(ScanFolder& folder, const TrackSampler& track, const std::filesystem::path& file,
               const std::string& what, const std::string& why);

/// \brief Replaces the poses of the scans by those of a TUM file at the times of the scans. Scans
/// at times without a pose are dropped, with a note. Scans without times of their own
/// (`nominalTimes`) are paired with the rows in order, and take the times of the rows.
/// \param T_pose_robot Pose of the robot in the frame that the file describes: identity if the file
///        has robot poses, the inverse of the sensor's pose if it has sensor poses.
/// \throws Error as readTum(). Also when no scan has a pose, or the number of rows differs from the
///         number of scans without times.
void takeTumPoses(ScanFolder& folder, const std::filesystem::path& file,
                  const Eigen::Isometry3d& T_pose_robot);

/// \brief Replaces the motions of the scans by those between the poses of a TUM file, which may
/// drift: the result of an odometry. Covariances: 2 % of each component, 1 mm and 0.1 mrad added.
/// Scans without a pose, times, parameters and errors are those of takeTumPoses().
void takeTumMotions(ScanFolder& folder, const std::filesystem::path& file,
                    const Eigen::Isometry3d& T_pose_robot);

}  // namespace polemcl::io
