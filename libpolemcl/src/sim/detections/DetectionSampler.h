#pragma once
/// \file DetectionSampler.h
/// \brief Poles that an extractor would report in each scan of a drive, sampled from a model.

#include <Eigen/Geometry>
#include <vector>

#include "sim/detections/DetectionModel.h"
#include "sim/drive/Drive.h"
#include "sim/world/SightLines.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Source of lasting false detections: looks like a pole but is not one.
struct ClutterObject {
  std::uint64_t id = 0;
  double x = 0, y = 0;  ///< m, map frame
  bool today = false;   ///< exists on this day only
};

/// \brief Places clutter along the roads and at the fences of building sites (there for as long as
/// the site exists). Equal world, day and factor give equal clutter.
/// \param factor Scales the numbers. Factors below 1 give a subset of the objects for 1; factors
///        above 1 add others.
std::vector<ClutterObject> placeClutter(const DetectionModel& model, const World& world,
                                        double factor);

/// \brief Samples the detections of a drive. Each scan depends only on hashes of the world's seed,
/// the day, `drive_seed` and the scan's number. Scans may thus be requested in any order, from many
/// threads.
class DetectionSampler {
 public:
  /// \throws Error when the model is for another LiDAR than `options.sensor`, or for a height that
  ///         differs by more than 0.3 m.
  DetectionSampler(DetectionModel model, const World& world, const SimulationOptions& options);

  /// \brief Detections of scan i, sorted by azimuth, then range.
  /// \param T_map_sensor Pose of the optical centre.
  /// \return Poles in the frame of the written clouds (see cloudFrame()), heights above ground.
  std::vector<PoleDetection> sample(std::size_t i, const Eigen::Isometry3d& T_map_sensor) const;

  /// \brief Visibility range in each direction, as VisibilityRangeFinder gives it. It ends at the
  /// nearest house, wall, hoarding or container, at most at the model's greatest range, and is
  /// rounded to the steps of the finder. Cars, hedges and crowns have no effect here; the model's
  /// detection rates include them. \return VisibilityRangeFinder::kSectors ranges, m, in the frame
  /// of the written clouds.
  std::vector<float> visibilityRange(const Eigen::Isometry3d& T_map_sensor) const;

  const DetectionModel& model() const { return m_model; }
  const std::vector<ClutterObject>& clutter() const { return m_clutter; }

 private:
  /// \brief One object that may be detected.
  struct Target {
    DetectionClass kind;
    Eigen::Vector2d place;        ///< m, map frame
    double radius;                ///< m; 0 if it is not a pole
    std::uint64_t always, today;  ///< seeds of its noise
    double snow = 0;              ///< height of the snow bank around it, m
    double shift = 0;             ///< shift of its threshold by the season
  };
  struct View;
  Target targetOf(DetectionClass kind, double x, double y, double radius, std::uint64_t id,
                  bool todayOnly) const;
  /// \brief Threshold on the visibility; below it the target is detected.
  double threshold(const Target& target, const View& view) const;
  void addPoles(const World& world);
  void addTarget(const Target& target, const View& view, std::vector<PoleDetection>& found) const;
  void addPassing(const View& view, std::vector<PoleDetection>& found) const;
  PoleDetection report(const Target& target, const View& view, const Eigen::Vector2d& place,
                       std::uint64_t scanSeed) const;

  DetectionModel m_model;
  SimulationOptions m_options;
  SightLines m_sight, m_fences;
  std::vector<ClutterObject> m_clutter;
  std::vector<Target> m_targets;
};

}  // namespace polemcl::sim
