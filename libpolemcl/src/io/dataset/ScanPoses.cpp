#include "io/dataset/ScanPoses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/data/PlanarMotion.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

std::string span(const ScanFolder& folder) {
  return fixed(folder.scans.front().time, 3) + " ... " + fixed(folder.scans.back().time, 3) + " s";
}

/// Row i belongs to scan i, which takes its time: both counts must agree.
void pairInTurn(ScanFolder& folder, const fs::path& file, const std::vector<StampedPose3D>& rows) {
  if (rows.size() != folder.scans.size())
    throw Error(file.string() + ": " + std::to_string(rows.size()) + " poses for " +
                std::to_string(folder.scans.size()) +
                " scans that have no times of their own; give them a times.txt, or take away the "
                "scans without a pose");
  for (std::size_t i = 0; i < rows.size(); ++i) folder.scans[i].time = rows[i].time;
  folder.nominalTimes = false;
  folder.notes.push_back("times of the scans: those of " + file.filename().string() +
                         ", which has as many rows");
}

/// The rows as poses of the robot, at the times of the scans.
TrackSampler sampled(ScanFolder& folder, const fs::path& file,
                     const Eigen::Isometry3d& T_pose_robot) {
  const std::vector<StampedPose3D> rows = readTum(file);
  if (folder.nominalTimes) pairInTurn(folder, file, rows);
  TrackSampler track(timesOf(folder), kTrackGap);
  for (const StampedPose3D& row : rows) track.add(row.time, row.pose * T_pose_robot);
  return track;
}

}  // namespace

void noteUnusedRows(std::size_t rows, const fs::path& file, std::vector<std::string>& notes) {
  if (rows > 0)
    notes.push_back(file.filename().string() + ": " + std::to_string(rows) +
                    " rows ignored: not finite, or not later than the previous row");
}

std::vector<double> timesOf(const ScanFolder& folder) {
  std::vector<double> times;
  times.reserve(folder.scans.size());
  for (const ScanEntry& scan : folder.scans) times.push_back(scan.time);
  return times;
}

void keepScans(ScanFolder& folder, const std::vector<bool>& keep, const std::string& why) {
  std::vector<ScanEntry> kept;
  std::optional<PoseWithCovariance> pending;  // motion since the last remaining scan
  const std::size_t all = folder.scans.size();
  for (std::size_t i = 0; i < all; ++i) {
    ScanEntry& scan = folder.scans[i];
    if (pending && scan.motion) scan.motion = composeMotions(*pending, *scan.motion);
    pending.reset();
    if (keep[i]) {
      if (kept.empty()) scan.motion.reset();  // the first scan has no motion
      kept.push_back(std::move(scan));
    } else if (!kept.empty()) {
      pending = scan.motion;
    }
  }
  folder.scans = std::move(kept);
  if (folder.scans.size() < all)
    folder.notes.push_back(std::to_string(all - folder.scans.size()) + " of " +
                           std::to_string(all) + " scans left out, " + why);
}

void requireOverlap(const ScanFolder& folder, const TrackSampler& track, const fs::path& file,
                    const std::string& what) {
  if (track.found() > 0) return;
  throw Error(file.string() + ": no " + what + " at the time of any scan: " + what + " " +
              track.span() + ", scans " + span(folder) +
              "; take the files of one session, stamped by one clock");
}

void requireVehicleFrame(const TrackSampler& track, const std::string& where, bool isLevel) {
  double alongZ = 0, level = 0;
  std::size_t down = 0;
  const Eigen::Isometry3d* last = nullptr;
  for (const auto& pose : track.poses()) {
    if (!pose) continue;
    if (pose->linear()(2, 2) < 0) ++down;
    if (last) {
      const Eigen::Vector3d step = (last->inverse() * *pose).translation();
      alongZ += std::abs(step.z());
      level += step.head<2>().norm();
    }
    last = &*pose;
  }
  constexpr double kShort = 2;  // m; less tells nothing
  if (alongZ > kShort && alongZ > level)
    throw Error(where + ": it moves " + fixed(alongZ, 1) + " m along z and " + fixed(level, 1) +
                " m in x and y, as a camera does; a frame with x ahead and z up is expected");
  if (isLevel && 2 * down > track.found())
    throw Error(where + ": its z axis points down; a frame with x ahead and z up is expected");
}

void takePoses(ScanFolder& folder, const TrackSampler& track, const fs::path& file,
               const std::string& what, const std::string& why) {
  requireOverlap(folder, track, file, what);
  std::vector<bool> keep;
  for (std::size_t i = 0; i < folder.scans.size(); ++i) {
    folder.scans[i].T_map_robot = track.poses()[i];
    keep.push_back(track.poses()[i].has_value());
  }
  keepScans(folder, keep, why);
}

void takeTumPoses(ScanFolder& folder, const fs::path& file, const Eigen::Isometry3d& T_pose_robot) {
  takePoses(folder, sampled(folder, file, T_pose_robot), file, "pose",
            "at times without a pose in " + file.filename().string());
}

void takeTumMotions(ScanFolder& folder, const fs::path& file,
                    const Eigen::Isometry3d& T_pose_robot) {
  const TrackSampler track = sampled(folder, file, T_pose_robot);
  requireOverlap(folder, track, file, "odometry");
  requireVehicleFrame(track, file.string(), false);
  std::vector<bool> keep;
  const Eigen::Isometry3d* last = nullptr;
  for (std::size_t i = 0; i < folder.scans.size(); ++i) {
    const auto& pose = track.poses()[i];
    keep.push_back(pose.has_value());
    folder.scans[i].motion.reset();
    if (!pose) continue;
    PoseWithCovariance motion;
    if (last) motion.mean = planar(last->inverse() * *pose);
    motion.covariance = assumedCovariance(motion.mean, kDefaultMotionNoise) + floorCovariance();
    folder.scans[i].motion = motion;
    last = &*pose;
  }
  keepScans(folder, keep, "at times without odometry in " + file.filename().string());
  folder.scans.front().motion.reset();
}

}  // namespace polemcl::io
