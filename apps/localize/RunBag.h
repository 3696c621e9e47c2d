#pragma once
/// \file RunBag.h
/// \brief The first run of `pole-localize` as a bag of ROS 2, to be shown by Foxglove or rviz.
/// Private to the library.

#include <filesystem>
#include <vector>

#include "io/rosbag/McapWriter.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl::apps {

/// \brief Writes the messages of each scan at its time. Frames: `map` and `base_link` (the robot).
///
/// - `/pose`, PoseWithCovarianceStamped, and `/tf`, TFMessage from `map` to `base_link`: while the
///   pose is known;
/// - `/path`, Path: a pose a metre. It is written whenever it has grown by a quarter and at the
///   end, so that all paths together have at most five times the length of the last one;
/// - `/map_poles`, MarkerArray, latched: the poles of the map, with the first scan;
/// - `/poles`, MarkerArray: the poles of the scan in `base_link`, green where they match the map;
/// - `/diagnostics`, DiagnosticArray: the health; `ok` is OK, `degraded` WARN, `lost` ERROR.
class RunBag {
 public:
  /// \throws Error when the file cannot be created.
  explicit RunBag(const std::filesystem::path& file);
  /// \brief The next scan, after the step of the localization.
  /// \throws Error when its time is not one that ROS can state.
  void add(const LocalizationPipeline& localization, const PoleScan& scan,
           const LocalizationUpdate& update);
  /// \brief Completes the file. Call it once. \throws Error when it cannot be written.
  void commit();

 private:
  void addPose(double time, const PoseWithCovariance& pose);
  void addPath(double time);
  void addPoles(const LocalizationPipeline& localization, const PoleScan& scan);

  io::McapWriter m_bag;
  std::uint16_t m_pose, m_transform, m_pathTopic, m_map, m_poles, m_diagnostics;  ///< channels
  bool m_begun = false;
  std::vector<StampedPose2D> m_path;  ///< 32 bytes a metre
  std::size_t m_pathWritten = 0;      ///< poses of the last path in the bag
  double m_time = 0;                  ///< of the last scan, s
};

}  // namespace polemcl::apps
