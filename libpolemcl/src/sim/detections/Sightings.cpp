#include "sim/detections/Sightings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/common/GreedyAssignment.h"
#include "sim/world/SightLines.h"

namespace polemcl::sim {
namespace {

constexpr double kMatch = 0.5;       // m, as in pole-eval detections
constexpr double kSame = 0.6;        // m: nearer false detections belong to one object
constexpr std::size_t kLasting = 3;  // least number of its detections on one drive

/// The frames of one scan, and the houses around it.
struct Frames {
  Eigen::Isometry3d T_map_cloud;
  Eigen::Vector2d sensor;  ///< m, map frame
  double height;
  Eigen::Vector2d lidar_cloud;
  std::vector<const SightLines::Block*> blocks;
  Frames(const SimulatedDrive& drive, std::size_t i, const SightLines& sight, double maxRange) {
    const Eigen::Isometry3d& T_map_sensor = drive.drive().T_map_sensor[i];
    T_map_cloud = cloudFrame(T_map_sensor, drive.options());
    sensor = T_map_sensor.translation().head<2>();
    height = T_map_sensor.translation().z();
    lidar_cloud = {drive.options().originX, drive.options().originY};
    blocks = sight.around(sensor, maxRange);
  }
  /// Position of a vertical object at the height of the sensor, cloud frame.
  Eigen::Vector2d inCloud(const Eigen::Vector2d& place) const {
    const Eigen::Vector3d p = T_map_cloud.inverse() * Eigen::Vector3d(place.x(), place.y(), height);
    return p.head<2>();
  }
  Eigen::Vector2d inMap(const PoleDetection& pole) const {
    const Eigen::Vector3d level =
        T_map_cloud.inverse() * Eigen::Vector3d(sensor.x(), sensor.y(), height);
    const Eigen::Vector3d p = T_map_cloud * Eigen::Vector3d(pole.x, pole.y, level.z());
    return p.head<2>();
  }
};

std::array<double, kReported> reportedBy(const PoleDetection& pole, const Eigen::Vector2d& truth,
                                         double radius, const Eigen::Vector2d& lidar) {
  const Eigen::Vector2d ray = (truth - lidar).normalized(), left(-ray.y(), ray.x());
  const Eigen::Vector2d error = Eigen::Vector2d(pole.x, pole.y) - truth;
  const double along = std::sqrt(ray.dot(pole.covariance * ray));
  const double across = std::sqrt(left.dot(pole.covariance * left));
  return {along,
          across,
          error.dot(ray) / along,
          error.dot(left) / across,
          pole.confidence,
          pole.radius - radius,
          pole.bottom,
          pole.top,
          static_cast<double>(pole.points)};
}

struct Object {
  DetectionClass kind;
  std::size_t id;
  Eigen::Vector2d place;  ///< m, map frame
  double radius;          ///< m
};

/// Assigns the detections of one drive to objects.
class Assigner {
 public:
  Assigner(const SimulatedDrive& drive, const std::vector<std::vector<PoleDetection>>& poles,
           double maxRange)
      : m_drive(drive), m_sight(drive.world()), m_maxRange(maxRange) {
    for (const auto& scan : poles) {
      m_frames.emplace_back(drive, m_frames.size(), m_sight, maxRange);
      m_rest.emplace_back();
      for (const PoleDetection& pole : scan) m_rest.back().push_back(&pole);
    }
  }

  std::vector<Sighting> run() {
    std::vector<Object> objects;
    for (const TruePole& pole : m_drive.world().poles())
      objects.push_back({classOf(pole.kind), pole.id, {pole.x, pole.y}, pole.radius});
    for (std::size_t i = 0; i < m_frames.size(); ++i) assign(i, objects, kMatch);
    objects.clear();
    for (const Eigen::Vector2d& place : lastingPlaces())
      objects.push_back({DetectionClass::clutter, objects.size(), place, 0});
    for (std::size_t i = 0; i < m_frames.size(); ++i) assign(i, objects, kSame);
    for (std::size_t i = 0; i < m_frames.size(); ++i)
      for (const PoleDetection* pole : m_rest[i]) passing(i, *pole);
    return std::move(m_sightings);
  }

 private:
  /// Assigns remaining detections of a scan.
  void assign(std::size_t i, const std::vector<Object>& objects, double radius) {
    const Frames& frames = m_frames[i];
    std::vector<const Object*> near;
    std::vector<Eigen::Vector2d> truth, found;
    for (const Object& object : objects) {
      if ((object.place - frames.sensor).norm() > m_maxRange + radius) continue;
      near.push_back(&object);
      truth.push_back(frames.inCloud(object.place));
    }
    auto& rest = m_rest[i];
    for (const PoleDetection* pole : rest) found.emplace_back(pole->x, pole->y);
    std::vector<const PoleDetection*> of(truth.size(), nullptr);
    for (const AssignedPair& pair : greedyAssignment(truth, found, radius))
      of[pair.first] = std::exchange(rest[pair.second], nullptr);
    rest.erase(std::remove(rest.begin(), rest.end(), nullptr), rest.end());
    for (std::size_t n = 0; n < near.size(); ++n) {
      const double range = (near[n]->place - frames.sensor).norm();
      if (range > m_maxRange) continue;
      const bool hidden = SightLines::blocked(frames.blocks, frames.sensor, near[n]->place);
      m_sightings.push_back({near[n]->kind, near[n]->id, near[n]->place, i, range, hidden, {}});
      if (of[n])
        m_sightings.back().reported =
            reportedBy(*of[n], truth[n], near[n]->radius, frames.lidar_cloud);
    }
  }

  /// Places with several false detections: running means, in the order of the scans.
  std::vector<Eigen::Vector2d> lastingPlaces() const {
    struct Place {
      Eigen::Vector2d sum;
      std::size_t count;
    };
    std::vector<Place> places;
    for (std::size_t i = 0; i < m_frames.size(); ++i)
      for (const PoleDetection* pole : m_rest[i]) {
        const Eigen::Vector2d p = m_frames[i].inMap(*pole);
        Place* nearest = nullptr;
        double best = kSame;
        for (Place& place : places) {
          const double distance = (place.sum / static_cast<double>(place.count) - p).norm();
          if (distance >= best) continue;
          best = distance;
          nearest = &place;
        }
        if (nearest) {
          nearest->sum += p;
          ++nearest->count;
        } else {
          places.push_back({p, 1});
        }
      }
    std::vector<Eigen::Vector2d> lasting;
    for (const Place& place : places)
      if (place.count >= kLasting) lasting.push_back(place.sum / static_cast<double>(place.count));
    return lasting;
  }

  void passing(std::size_t i, const PoleDetection& pole) {
    const Frames& frames = m_frames[i];
    const Eigen::Vector2d place(pole.x, pole.y);
    m_sightings.push_back({DetectionClass::passing, 0, frames.inMap(pole), i,
                           (place - frames.lidar_cloud).norm(), false,
                           reportedBy(pole, place, 0, frames.lidar_cloud)});
  }

  const SimulatedDrive& m_drive;
  SightLines m_sight;
  double m_maxRange;
  std::vector<Frames> m_frames;
  std::vector<std::vector<const PoleDetection*>> m_rest;  ///< not assigned yet, by scan
  std::vector<Sighting> m_sightings;
};

}  // namespace

std::vector<Sighting> sightingsOf(const SimulatedDrive& drive,
                                  const std::vector<std::vector<PoleDetection>>& poles,
                                  double maxRange) {
  return Assigner(drive, poles, maxRange).run();
}

}  // namespace polemcl::sim
