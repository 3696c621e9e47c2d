#pragma once
/// \file Localizer.h
/// \brief From scans and odometry to poses on a map of poles: what a run of pole-localize does.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/localization/LocalizationUpdate.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/localizer/Settings.h>

namespace mrpt::obs {
class CObservation;
}

namespace polemcl {

class LocalizationPipeline;  // private to the library
struct LocalizationMap;      // private to the library

/// \brief What odometry says at one time.
struct OdometryReading {
  double time = 0;  ///< s
  Pose2D pose;      ///< of the robot in the frame of the odometry, m and rad
  /// Used at the first scan, to which no motion leads; passed over unless finite.
  std::optional<Velocity> velocity = {};
  /// Covariance of (vx, vy, yaw rate), m²/s², m·rad/s², rad²/s², with errors that are independent
  /// from reading to reading. None, zero or negative: `[motion]` says how exact motions are.
  std::optional<Eigen::Matrix3d> velocityCovariance = {};
};

/// \brief Localizes one drive. \code
///   Localizer localizer(Settings("hdl32e.ini"), "street.polemap");
///   localizer.startAnywhere();
///   auto update = localizer.step(time, points, odometry);  // for each scan
///   if (update.estimate) drive(update.estimate->mean, update.health);
/// \endcode
/// The same settings, seed, scans and odometry give the same poses. Not for several threads at
/// once. What was moved from can only be destroyed or assigned to. A new start() takes times that
/// begin again.
class POLEMCL_EXPORT Localizer {
 public:
  /// \param map A `.polemap`. \throws Error when it cannot be read or has no poles.
  Localizer(const Settings& settings, const std::filesystem::path& map);
  /// \brief One of several on a map that is loaded once. \param seed In place of `[runs] seed`.
  Localizer(const Settings& settings, const LocalizationMap& map, std::uint32_t seed);
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;
  ~Localizer();

  /// \brief Starts near a pose. Not needed where `[start]` of the settings says where.
  /// \param pose_map_robot At the first scan, m and rad.
  /// \param radius, heading How far it may be off, m and rad; unless given those of `[start]`.
  /// \throws Error on values that are not finite, or far from every pole of the map.
  void start(const Pose2D& pose_map_robot, std::optional<double> radius = {},
             std::optional<double> heading = {});
  /// \brief Starts without a pose: the poles of the first metres tell it.
  void startAnywhere();
  /// \brief Starts without a heading, as by a position from satellites: places farther than
  /// `radius` from x, y on the map are not considered until a pose is known, m.
  /// \throws Error on values that are not finite, or far from every pole of the map.
  void startWithin(double x, double y, double radius);
  /// \brief False until one of these, or where `[start]` says where.
  bool isStarted() const;

  /// \brief The next scan.
  /// \param time s, at least 0, greater than that of the scan before.
  /// \param points One turn of the LiDAR, m, in its frame: x ahead, z up. Rows that are no numbers
  /// or zero are left out.
  /// \param odometry Pose of that frame on the ground, in the frame of the odometry at that time,
  /// m and rad. Only its change matters; `[motion]` says how exact it is. The update's pose is of
  /// the same frame. Where the robot's frame is another one, the overload below knows both.
  /// \throws Error when nothing was started, time does not increase, or the points contradict
  /// `[sensor]`.
  LocalizationUpdate step(double time, const PointsView& points, const Pose2D& odometry);
  /// \brief The same from an observation of MRPT with its time stamp and sensor pose: point clouds,
  /// Velodyne and rotating scans, depth images, CObservationPoles.
  LocalizationUpdate step(const mrpt::obs::CObservation& scan, const Pose2D& odometry);
  /// \brief The same from poles that were found elsewhere. \param poles_robot Frame of the robot;
  /// of more than 200, the most confident are used. They are corrected for the motion during a turn
  /// by their `timeOffset` and `turnRate`, which PoleExtractor leaves at 0.
  LocalizationUpdate step(double time, const std::vector<PoleDetection>& poles_robot,
                          const Pose2D& odometry);

  /// \brief The same from poles with a motion whose covariance is known, of one or several LiDARs.
  /// Not to be mixed with those above: they would count its motion again.
  LocalizationUpdate step(const PoleScan& frame);

  /// \name Where scans and odometry come by themselves, as from sensors
  /// @{
  /// \brief s; a scan that comes later than that after its time finds no odometry.
  static constexpr double keptOdometry = 60;
  /// \brief A reading of the odometry, at 1 Hz or more. One that is not later than the one before
  /// is left out; after a second of such readings the clock was set, and the odometry begins anew.
  /// Readings are kept for `keptOdometry`. \throws Error when the time is not in [0, 1e11) s, or
  /// the pose is not finite.
  void addOdometry(const OdometryReading& reading);
  /// \brief Whether there is odometry at `time` or later: the scan of that time can be taken.
  bool hasOdometry(double time) const;
  /// \brief What the recording says of the measuring times of the points, see io::TimingEstimate;
  /// used if `[sensor] turn = auto`. A later one replaces it; ScanTiming() takes it back.
  void setRecordedTiming(const ScanTiming& timing);
  /// \brief The next scan; its motion is that of the odometry, interpolated at its time.
  /// \param T_robot_lidar Pose of the frame of the points in the robot's, m.
  /// \throws Error as step() above, and where odometry is missing: no reading within 0.5 s
  /// at its begin or end, or readings more than 2 s apart round the scan.
  LocalizationUpdate step(double time, const PointsView& points,
                          const Eigen::Isometry3d& T_robot_lidar);
  /// \brief Pose of the frame of the odometry in that of the map at the last scan (ROS: `map` to
  /// `odom`); nullopt before the first scan after a start, or if that scan gave no estimate.
  std::optional<Pose2D> odometryFrame() const;
  /// @}

  /// \brief All scans of a rawlog of scans or poles with odometry; several LiDARs are fused. Start
  /// again before other scans.
  /// \param consume Gets what each scan brings, from changing threads, one call at a time.
  /// \throws Error as step(), and when the rawlog cannot be read.
  void play(const std::string& rawlog,
            const std::function<void(const LocalizationUpdate&)>& consume);

  /// \brief For drawing: particles, submap, matches.
  const LocalizationPipeline& pipeline() const;

  /// \brief Steps of the odometry so far that no vehicle makes, as after a restart of its node. The
  /// motion before went on in their place.
  std::size_t odometryJumps() const;
  /// \brief The poles of the last scan since the start, frame of the robot.
  const std::vector<PoleDetection>& poles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
