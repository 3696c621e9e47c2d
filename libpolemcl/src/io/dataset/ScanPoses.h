#pragma once
/// \file ScanPoses.h
/// \brief True poses for the scans of a folder, from tracks with their own times.

#include "io/data/TrackSampler.h"
#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Tracks are not interpolated across longer gaps, s: a vehicle may turn meanwhile.
constexpr double trackGap = 1.0;

/// \brief Times of the scans, s.
std::vector<double> timesOf(const ScanFolder& folder);

/// \brief Leaves out the scans that are not to be kept, with a note. Their motion goes into that of
/// the next scan that stays.
/// \param keep One for each scan. \param why Such as "at times without truth".
void keepScans(ScanFolder& folder, const std::vector<bool>& keep, const std::string& why);

/// \throws Error that names both time spans when the sampled track has no pose for any scan.
/// \param file Where the track comes from. \param what Such as "truth".
void requireOverlap(const ScanFolder& folder, const TrackSampler& track,
                    const std::filesystem::path& file, const std::string& what);

/// \brief Gives the scans the poses of a sampled track; those without one are left out.
/// \param why As of keepScans(). \throws Error as requireOverlap(), whose the other arguments are.
void takePoses(ScanFolder& folder, const TrackSampler& track, const std::filesystem::path& file,
               const std::string& what, const std::string& why);

/// \brief Gives the scans the poses of a TUM file, instead of those they had, at their times.
/// Scans at times without a pose are left out, with a note. Scans without times of their own
/// (`nominalTimes`) are paired with the rows in turn, and take their times.
/// \param T_pose_robot The robot in the frame whose poses the file has: identity for poses of the
///        robot, the inverse of the sensor's pose for poses of the sensor.
/// \throws Error as readTum(); when no scan has a pose, or scans without times are not as many as
///         rows.
void takeTumPoses(ScanFolder& folder, const std::filesystem::path& file,
                  const Eigen::Isometry3d& T_pose_robot);

}  // namespace polemcl::io
