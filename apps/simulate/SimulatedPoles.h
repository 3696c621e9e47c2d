#pragma once
/// \file SimulatedPoles.h
/// \brief The poles of a simulated drive as a rawlog, scan by scan, without keeping any cloud.

#include <filesystem>
#include <functional>
#include <optional>

#include "cli/Settings.h"
#include "sim/drive/Simulation.h"

namespace polemcl::apps {

/// \brief What `pole-simulate --poles` writes: all appear together once they are complete.
struct PoleDriveFiles {
  std::filesystem::path rawlog;  ///< actions and frames with one CObservationPoles each
  std::filesystem::path truth;   ///< P.tum: true robot poses, one row per scan
  std::filesystem::path poles;   ///< P_poles_gt.csv: the true poles of the day
  std::filesystem::path config;  ///< P_config.ini: the effective settings
};
/// \brief The files that belong to P.rawlog. \throws Error unless the name ends in .rawlog.
PoleDriveFiles poleDriveFiles(const std::filesystem::path& rawlog);

/// \brief What was written.
struct PoleDriveSummary {
  std::size_t scans = 0;
  std::size_t poles = 0;  ///< detections in all scans
  std::size_t points = 0;
  std::size_t truePoles = 0;
  double length = 0;  ///< driven, m
};

/// \brief Casts the scans of the drive, extracts their poles as `[sensor]` and `[extraction]` say,
/// and writes them. A few scans are worked on at a time, each in a thread of its own; the bytes do
/// not depend on it, and are those of pole-import and pole-extract.
/// \param folder Also gets every scan when given.
/// \param progress Called with the number of scans done.
/// \throws Error when a file cannot be written, or `[extraction]` refuses the scans.
PoleDriveSummary castPoles(const sim::SimulatedDrive& drive, const AllSettings& settings,
                           const PoleDriveFiles& files, const sim::ScanFolderWriter* folder,
                           const std::function<void(std::size_t)>& progress = {});

/// \brief Draws the poles of each scan from the model `[simulation] detections` instead, and writes
/// them as castPoles(). \throws Error naming the model's file: cannot be read, or is of another
/// LiDAR.
PoleDriveSummary samplePoles(const sim::SimulatedDrive& drive, const AllSettings& settings,
                             const PoleDriveFiles& files,
                             const std::function<void(std::size_t)>& progress = {});

}  // namespace polemcl::apps
