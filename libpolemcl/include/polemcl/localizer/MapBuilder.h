#pragma once
/// \file MapBuilder.h
/// \brief From scans at known poses to a map of poles: what pole-map build does.

#include <filesystem>
#include <memory>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/localizer/Settings.h>

namespace mrpt::obs {
class CObservation;
}

namespace polemcl {

/// \brief Makes a map of one drive. \code
///   MapBuilder builder(Settings("hdl32e.ini"));
///   builder.add(time, points, pose);  // for each scan
///   builder.save("street.polemap");
/// \endcode
/// Poles are corrected for the motion within a scan as `[sensor] turn` says, with the velocity
/// between the poses. The result depends on settings and scans only. Not for several threads at
/// once.
class POLEMCL_EXPORT MapBuilder {
 public:
  explicit MapBuilder(const Settings& settings);
  MapBuilder(MapBuilder&&) noexcept;
  MapBuilder& operator=(MapBuilder&&) noexcept;
  ~MapBuilder();

  /// \brief The next scan of the drive.
  /// \param time s, greater than that of the scan before.
  /// \param points One turn of the LiDAR, m, in its frame: x ahead, z up.
  /// \param pose_map_robot Pose of that frame on the ground, m and rad.
  /// \throws Error when time does not increase, the pose is not finite, or the points contradict
  /// `[sensor]`.
  void add(double time, const PointsView& points, const Pose2D& pose_map_robot);
  /// \brief The same from an observation of MRPT with its time stamp and sensor pose, as
  /// Localizer::step() takes them. Of more than 200 poles, the most confident are used.
  void add(const mrpt::obs::CObservation& scan, const Pose2D& pose_map_robot);

  /// \brief The poles of the map so far, map frame, sorted by x then y; empty: none was seen often
  /// enough.
  std::vector<MapPole> poles() const;
  /// \brief Writes a `.polemap` with the history of each pole, so that pole-map update can go on.
  /// \throws Error when there is no pole, or the file cannot be written.
  void save(const std::filesystem::path& file) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
