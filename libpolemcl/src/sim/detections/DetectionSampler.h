#pragma once
/// \file DetectionSampler.h
/// \brief The poles that an extractor would report in each scan of a drive, drawn from a model.

#include <Eigen/Geometry>
#include <vector>

#include "sim/detections/DetectionModel.h"
#include "sim/drive/Drive.h"
#include "sim/world/SightLines.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Where lasting false detections come from: looks like a pole and is none.
struct ClutterObject {
  std::uint64_t id = 0;
  double x = 0, y = 0;  ///< m, map frame
  bool today = false;   ///< on this day only
};

/// \brief What looks like a pole along the roads and at the fences of building sites (there as long
/// as the site stands), the same for the same world, day and factor.
/// \param factor Scales the numbers; up to 1 they are a part of those of 1, beyond that come
/// others.
std::vector<ClutterObject> placeClutter(const DetectionModel& model, const World& world,
                                        double factor);

/// \brief Draws the detections of a drive. Each scan is drawn from hashes of the world's seed, the
/// day, `drive_seed` and its number, so they may be asked for in any order, by many threads.
class DetectionSampler {
 public:
  /// \throws Error when the model is of another LiDAR than `options.sensor`, or mounted at another
  ///         height (by more than 0.3 m).
  DetectionSampler(DetectionModel model, const World& world, const SimulationOptions& options);

  /// \brief Detections of scan i, by azimuth then range.
  /// \param T_map_sensor Of the optical centre.
  /// \return Poles in the frame of the written clouds (see cloudFrame()), heights above ground.
  std::vector<PoleDetection> sample(std::size_t i, const Eigen::Isometry3d& T_map_sensor) const;

  /// \brief How far a pole could have been seen in each direction, as VisibilityRangeFinder gives
  /// it: to the nearest house, wall, hoarding or container, at most to the model's greatest range,
  /// in its steps. Cars, hedges and crowns hide nothing here; the model's detection rates hold what
  /// they hide. \return VisibilityRangeFinder::kSectors ranges, m, in the frame of the written
  /// clouds.
  std::vector<float> visibilityRange(const Eigen::Isometry3d& T_map_sensor) const;

  const DetectionModel& model() const { return m_model; }
  const std::vector<ClutterObject>& clutter() const { return m_clutter; }

 private:
  /// \brief One thing that may be detected.
  struct Target {
    DetectionClass kind;
    Eigen::Vector2d place;        ///< m, map frame
    double radius;                ///< m; 0 of what is no pole
    std::uint64_t always, today;  ///< where its noise begins
    double snow = 0;              ///< of the snow bank it stands in, m
    double shift = 0;             ///< of its threshold, by the season
  };
  struct View;
  Target targetOf(DetectionClass kind, double x, double y, double radius, std::uint64_t id,
                  bool todayOnly) const;
  /// \brief Threshold on its visibility, below which a target is detected.
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
