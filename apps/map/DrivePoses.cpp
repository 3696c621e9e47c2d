#include "map/DrivePoses.h"

#include <algorithm>

#include "cli/RunRecords.h"
#include "core/common/Transform.h"
#include "core/localization/OdometryCalibration.h"
#include "core/mapping/PoleExistence.h"
#include "io/data/Trajectory.h"
#include "io/file/AtomicFile.h"
#include "io/file/ErrorPlace.h"

namespace polemcl::apps {
namespace {

constexpr double kKeptSigma = 0.001;  ///< m, rad: of motions between poses that stay

AdjustmentTrust trustOf(const AllSettings& settings) {
  return {OdometryCalibration::scaleSigma, OdometryCalibration::yawSigma, kDecorrelation,
          settings.map.poseSigma};
}

void addScans(const std::vector<MappingSession>& drives, std::vector<DrivenScan>& scans) {
  for (const MappingSession& drive : drives)
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      DrivenScan scan{drive.scans[i].pose_map_robot, drive.scans[i].poles_robot, {}};
      if (const auto& motion = drive.motions[i])
        scan.motion = PoseWithCovariance{motion->mean, motion->covariance};
      scans.push_back(std::move(scan));
    }
}

/// Sessions of a map. Between their poses, which stay, the odometry matters little.
void addScans(const AddedSessions& sessions, std::vector<DrivenScan>& scans) {
  for (const AddedSession& session : sessions.sessions)
    for (std::size_t i = 0; i < session.scans.size(); ++i) {
      const Pose2D& pose = session.scans[i].pose_map_robot;
      DrivenScan scan{pose, session.scans[i].poles_robot, {}};
      if (i > 0)
        scan.motion = PoseWithCovariance{relative(session.scans[i - 1].pose_map_robot, pose),
                                         kKeptSigma * kKeptSigma * Eigen::Matrix3d::Identity()};
      scans.push_back(std::move(scan));
    }
}

/// Zero where poses are true; empty if all are.
std::vector<Eigen::Matrix3d> covariancesOf(const AddedSessions& before) {
  std::vector<Eigen::Matrix3d> covariances;
  bool found = false;
  for (const AddedSession& session : before.sessions) {
    found |= !session.covariances.empty();
    covariances.insert(covariances.end(), session.covariances.begin(), session.covariances.end());
    if (session.covariances.empty())
      covariances.resize(covariances.size() + session.scans.size(), Eigen::Matrix3d::Zero());
  }
  return found ? covariances : std::vector<Eigen::Matrix3d>();
}

/// \throws Error when most scans of a drive have no odometry.
void requireOdometry(const MappingSession& drive, const std::filesystem::path& input) {
  const auto known = static_cast<std::size_t>(
      std::count_if(drive.motions.begin(), drive.motions.end(),
                    [](const auto& motion) { return motion.has_value(); }));
  if (2 * (known + 1) < drive.motions.size())
    throw Error(input.string() + ": only " + std::to_string(known) + " of " +
                std::to_string(drive.motions.size()) +
                " scans have odometry; --inventory needs it: write odometry to the rawlog");
}

/// \param poseOf Of the scan with this number, over all drives.
template <class PoseOf>
void setPoses(std::vector<MappingSession>& drives, const PoseOf& poseOf) {
  std::size_t next = 0;
  for (MappingSession& drive : drives)
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      drive.scans[i].pose_map_robot = drive.path[i].pose = poseOf(next++);
      drive.scans[i].poseCovariance.setZero();
    }
}

}  // namespace

AdjustedDrives adjustToInventory(std::vector<MappingSession>& drives,
                                 const std::vector<std::filesystem::path>& inputs,
                                 const std::vector<MapPole>& inventory,
                                 const AllSettings& settings) {
  for (std::size_t i = 0; i < drives.size(); ++i) requireOdometry(drives[i], inputs[i]);
  std::vector<DrivenScan> scans;
  addScans(drives, scans);
  AdjustedDrives adjusted = adjustDrives(scans, inventory, {settings.map, trustOf(settings)});
  setPoses(drives, [&](std::size_t scan) { return adjusted.poses_map_robot[scan]; });
  return adjusted;
}

MappedDrives findPoses(std::vector<MappingSession>& drives,
                       const std::vector<std::filesystem::path>& inputs,
                       const AddedSessions& before, std::vector<DriveFix> fixes,
                       const AllSettings& settings) {
  DrivesToMap job;
  job.fixes = std::move(fixes);
  addScans(before, job.scans);
  for (const AddedSession& session : before.sessions) job.names.push_back(session.name);
  job.known = job.scans.size();
  job.knownCovariances = covariancesOf(before);
  addScans(drives, job.scans);
  for (const auto& input : inputs) job.names.push_back(input.string());
  MappedDrives mapped = mapDrives(std::move(job), trustOf(settings));
  setPoses(drives, [&](std::size_t scan) { return mapped.poses[mapped.known + scan].mean; });
  return mapped;
}

void writeTrajectory(const std::filesystem::path& file, const DrivenPath& path,
                     const std::vector<PoseWithCovariance>& poses, std::size_t first) {
  io::writeTum(file, path.poses);
  io::AtomicFile covariances(file.parent_path() / (file.stem().string() + "_cov.csv"));
  covariances.stream() << kEstimateColumns;
  for (std::size_t i = 0; i < path.poses.size(); ++i)
    covariances.stream() << estimateRow(path.numbers[i], path.poses[i].time, poses[first + i]);
  covariances.commit();
}

}  // namespace polemcl::apps
