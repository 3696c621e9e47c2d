#pragma once
/// \file SimulationOptions.h
/// \brief Settings of the simulated world and of the drive through it.

#include <cstdint>
#include <string>

#include "core/common/Binder.h"
#include "sim/common/RealismOptions.h"

namespace polemcl {
class Binder;
}

namespace polemcl::sim {

/// \brief What stands along the street. `[world]` in INI files. Shares are in [0, 1].
struct WorldOptions {
  std::uint64_t seed = 1;  ///< another seed, another street
  int day = 0;             ///< 0: the day of the map; other days move what moves
  double length = 300;  ///< length of the generated street, m (`length_m`); a track gives its own
  /// Road along a track: sensor poses, 12 numbers a line, row-major 3x4, plain or gzip; "" = none.
  std::string track;
  double curviness = 1;        ///< scales the bends of the generated street; 0: straight
  double relief = 1;           ///< scales slopes and undulation of the ground; 0: flat
  double roadWidth = 10;       ///< kerb to kerb, m
  double lampSpacing = 28;     ///< mean distance of lamp posts on one side, m (`lamp_spacing_m`)
  double signSpacing = 24;     ///< mean distance of traffic signs on one side, m (`sign_spacing_m`)
  double treeSpacing = 10;     ///< mean distance of trees in a row, m (`tree_spacing_m`)
  double treeShare = 0.4;      ///< share of the street lined with trees (`tree_share`)
  double parkedShare = 0.5;    ///< share of parking places taken
  double clutter = 1;          ///< scales numbers of people, bins, bicycles, bollards, billboards
  double removedShare = 0.03;  ///< poles of day 0 that are gone on another day (`removed_share`)
  double addedShare = 0.02;    ///< new poles on another day, share of all (`added_share`)
  double foliage = 1;          ///< density of leaves; 0: bare branches
  /// Share of the poles that go for good within 365 days, each on a day of its own, while as many
  /// new ones come to stay (`replaced_per_year`); 0: none.
  double replacedPerYear = 0;
  /// Day of the year of day 0, 1: 1 January (`day_of_year`); 0: no seasons, leaves and no snow.
  int dayOfYear = 0;
  /// Midwinter's snow banks hide what stands along the kerb up to this height, m.
  double snowBank = 0.5;
  double buildingSites = 0;  ///< per km of street, at any time (`building_sites`)
  int sideStreets = 0;       ///< side streets for detours, 0 to 2 (`side_streets`)
  RealismOptions realism;    ///< `[realism]`, of objects and LiDAR
  void validate() const;     ///< \throws Error
};

void bind(Binder& binder, WorldOptions& options);  ///< `[world]`, `[realism]`

/// \brief Where the odometry of a drive comes from.
enum class OdometryModel {
  noise,  ///< the true motion with white noise (paper)
  wheels  ///< ticks and a gyroscope with errors that stay, see WheelOdometry
};

/// \brief Errors of odometry that stay. Part of `[simulation]`.
struct OdometryBias {
  double scale = 0;     ///< error of the distance, share (`odometry_scale`)
  double yaw = 0;       ///< error of the heading, rad per metre (`odometry_yaw_deg_m`)
  double drift = 0.2;   ///< slow change of both, as a share of them; wheels only
  double slip = 0.005;  ///< error of turns, share; wheels only
  double tick = 0.02;   ///< distance per tick, m, 0: not counted; wheels only
};

/// \brief The drive and its LiDAR. `[simulation]` in INI files.
struct SimulationOptions {
  WorldOptions world;
  /// Names as in lidarNames() (LidarModel.h). Programs take it from `[sensor]`.
  std::string sensor = "hdl32e";
  double height = 1.0;      ///< optical centre above ground, m. Programs take it from `[sensor]`.
  bool upsideDown = false;  ///< the sensor hangs; its beams are given as seen upright, z up
  /// Optical centre in the frame of the written clouds and poses, x forward, z up, m (NCLT's lie
  /// below the sensor). With x and y, the sensor is another one on the same vehicle: the drive
  /// stays the same. Programs take it from `[sensor]`.
  double originX = 0, originY = 0, originZ = 0;
  double spacing = 0.5;  ///< distance between scans, m (`spacing_m`)
  double speed = 5;      ///< m/s (`speed_m_s`)
  /// Offset of the drive from the middle of the road, m, + left.
  double laneOffset = -1.5;
  /// Standard deviation as a share of each component of the motion (`odometry_noise`).
  double odometryNoise = 0.02;
  OdometryModel odometry = OdometryModel::noise;
  OdometryBias odometryBias;
  bool reverse = false;  ///< from the far end, in the other lane: poles are seen from behind
  bool motionDistortion = false;  ///< the sensor moves while it turns (`motion_distortion`)
  int scans = 0;                  ///< greatest number of scans; 0: to the end of the road
  /// Another one, other noise, sway and detections on the same day (`drive_seed`).
  std::uint64_t driveSeed = 0;
  /// Detection model (JSON) that stands in for rays where poles are asked for; "": rays are cast
  /// (`detections`).
  std::string detections;
  /// The drive goes round through this side street; 0: straight on (`detour`).
  int detour = 0;
  double falseFactor = 1;  ///< scales the false detections of that model (`false_factor`)
  void validate() const;   ///< \throws Error
};

/// \brief `[simulation]`, `[world]` and `[realism]`. The LiDAR and its mounting are those of
/// `[sensor]`; the program fills them in.
void bind(Binder& binder, SimulationOptions& options);

}  // namespace polemcl::sim
