#pragma once
/// \file DrivePoses.h
/// \brief The poses of drives where no truth tells them: by odometry and poles, or adjusted to an
/// inventory.

#include <filesystem>
#include <vector>

#include "core/mapping/DriveAdjustment.h"
#include "core/mapping/MapAccumulator.h"
#include "core/slam/DriveMapping.h"
#include "map/MappingSession.h"

namespace polemcl::apps {

/// \brief Moves the poses of all drives so that their poles stand where the inventory has them.
/// \param inputs Files of the drives, for messages.
/// \throws Error as adjustDrives(); when most scans of a drive have no odometry.
AdjustedDrives adjustToInventory(std::vector<MappingSession>& drives,
                                 const std::vector<std::filesystem::path>& inputs,
                                 const std::vector<MapPole>& inventory,
                                 const AllSettings& settings);

/// \brief Finds the poses of drives that only know their odometry; frame of the sessions
/// before, or of the fixes, else of the first scan.
/// \param before Sessions whose poses stay; may be empty. \param fixes On the plane of the map,
/// their scans counted from the first of `before`; may be empty. \throws Error as mapDrives().
MappedDrives findPoses(std::vector<MappingSession>& drives,
                       const std::vector<std::filesystem::path>& inputs,
                       const AddedSessions& before, std::vector<DriveFix> fixes,
                       const AllSettings& settings);

/// \brief Poses of scans, and the numbers of the scans in their rawlog.
struct DrivenPath {
  std::vector<StampedPose2D> poses;
  std::vector<std::size_t> numbers;
};

/// \brief Writes the path of a drive as TUM, and the covariances beside it (`a_cov.csv` of
/// `a.tum`). \param poses Of all drives. \param first Of the drive.
void writeTrajectory(const std::filesystem::path& file, const DrivenPath& path,
                     const std::vector<PoseWithCovariance>& poses, std::size_t first);

}  // namespace polemcl::apps
