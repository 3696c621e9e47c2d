#pragma once
/// \file Simulation.h
/// \brief A drive through a simulated world, written as a folder of scans.

#include <filesystem>
#include <functional>

#include "sim/common/SimulationOptions.h"
#include "sim/drive/Drive.h"
#include "sim/lidar/Scanner.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Statistics of the written data.
struct SimulationSummary {
  std::size_t scans = 0, points = 0, poles = 0;
  double length = 0;  ///< path length, m
};

/// \brief A world, the path through it and the LiDAR. Scans are simulated on request, by index.
/// Immutable, safe to share between threads.
class SimulatedDrive {
 public:
  /// \param beams `[sensor]`, for LiDARs whose beams are listed in it, see makeLidar().
  /// \throws Error when an option is out of range or the track cannot be read.
  explicit SimulatedDrive(const SimulationOptions& options, const SensorOptions& beams = {});
  const SimulationOptions& options() const { return m_options; }
  const LidarModel& lidar() const { return m_lidar; }
  const World& world() const { return m_world; }
  const Drive& drive() const { return m_drive; }
  std::size_t scans() const { return m_drive.time.size(); }
  double length() const;  ///< path length, m
  /// \brief Simulates scan i. \return Points in the frame of the written clouds.
  SimulatedScan scan(std::size_t i) const;

 private:
  SimulationOptions m_options;
  LidarModel m_lidar;
  World m_world;
  Drive m_drive;
  Scanner m_scanner;
};

/// \brief Writer of the folder layout: the drive and the true poles at once, scans one by one.
class ScanFolderWriter {
 public:
  /// \param directory Must exist. \throws Error when a file cannot be written.
  ScanFolderWriter(const SimulatedDrive& drive, const std::filesystem::path& directory);
  /// \brief Writes velodyne/ and labels/ of scan i; may be called from several threads.
  void write(std::size_t i, const SimulatedScan& scan) const;

 private:
  std::filesystem::path m_directory;
};

/// \brief Writes `id,x,y,radius,top,kind` of the true poles: map frame, m; x, y, radius of the axis
/// 1.5 m above ground. Written atomically. \throws Error when it cannot be written.
void writeTruePoles(const std::filesystem::path& file, const std::vector<TruePole>& poles);

/// \brief Writes velodyne/*.bin, labels/*.label, times.txt, poses.txt, odometry.txt, poles_gt.csv,
/// and with `motion_distortion` scan_timing.ini, to `directory`, which must exist. Scans are
/// simulated in parallel; the bytes do not depend on the number of threads.
/// \param progress Called after each scan with (done, total), from one thread at a time.
/// \param beams As for SimulatedDrive.
/// \throws Error when an option is out of range or a file cannot be written.
SimulationSummary simulate(const SimulationOptions& options, const std::filesystem::path& directory,
                           const std::function<void(std::size_t, std::size_t)>& progress = {},
                           const SensorOptions& beams = {});

}  // namespace polemcl::sim
