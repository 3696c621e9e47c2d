#include "sim/detections/DetectionTracks.h"

#include <cmath>

#include "core/common/GreedyAssignment.h"
#include "sim/detections/DetectionSampler.h"

namespace polemcl::sim {
namespace {

constexpr double kMatch = 0.5;       // m, as in pole-eval detections
constexpr double kSame = 0.6;        // m: nearer false detections belong to one object
constexpr std::size_t kLasting = 3;  // least number of its detections on one drive
constexpr std::uint64_t kClutterIds = 1ull << 40;

/// The frames of one scan.
struct Frames {
  Eigen::Isometry3d T_map_cloud;
  Eigen::Vector2d sensor;  ///< m, map frame
  double height;
  Eigen::Vector2d lidar_cloud;
  Frames(const SimulatedDrive& drive, std::size_t i) {
    const Eigen::Isometry3d& T_map_sensor = drive.drive().T_map_sensor[i];
    T_map_cloud = cloudFrame(T_map_sensor, drive.options());
    sensor = T_map_sensor.translation().head<2>();
    height = T_map_sensor.translation().z();
    lidar_cloud = {drive.options().originX, drive.options().originY};
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

/// Assigns the detections of one drive to objects.
class Tracker {
 public:
  Tracker(const ObservedDrive& observed, double maxRange)
      : m_observed(observed),
        m_drive(*observed.drive),
        m_sight(m_drive.world()),
        m_maxRange(maxRange),
        m_used(observed.poles.size()) {
    m_result.scans = observed.poles.size();
    for (std::size_t i = 0; i < m_result.scans; ++i) {
      m_used[i].assign(observed.poles[i].size(), 0);
      m_frames.emplace_back(m_drive, i);
      m_blocks.push_back(m_sight.around(m_frames[i].sensor, maxRange));
    }
  }

  TrackedDrive run(std::vector<Track>& clutterSoFar) {
    truePoles();
    clutter(clutterSoFar);
    for (std::size_t i = 0; i < m_result.scans; ++i)
      for (std::size_t k = 0; k < m_used[i].size(); ++k)
        if (!m_used[i][k]) passing(i, m_observed.poles[i][k]);
    return std::move(m_result);
  }

 private:
  void truePoles() {
    const std::size_t first = m_result.tracks.size();
    for (const TruePole& pole : m_drive.world().poles())
      m_result.tracks.push_back({classOf(pole.kind), pole.id, {pole.x, pole.y}, pole.radius, {}});
    for (std::size_t i = 0; i < m_result.scans; ++i) assign(i, first, kMatch);
  }

  /// Assigns the remaining detections of a scan to the tracks from `first` on.
  void assign(std::size_t i, std::size_t first, double radius) {
    std::vector<Eigen::Vector2d> truth, found;
    std::vector<std::size_t> trackOf, detectionOf;
    for (std::size_t t = first; t < m_result.tracks.size(); ++t) {
      const Track& track = m_result.tracks[t];
      if ((track.place - m_frames[i].sensor).norm() > m_maxRange + radius) continue;
      truth.push_back(m_frames[i].inCloud(track.place));
      trackOf.push_back(t);
    }
    const auto& poles = m_observed.poles[i];
    for (std::size_t k = 0; k < poles.size(); ++k) {
      if (m_used[i][k]) continue;
      found.emplace_back(poles[k].x, poles[k].y);
      detectionOf.push_back(k);
    }
    std::vector<const PoleDetection*> of(truth.size(), nullptr);
    for (const AssignedPair& pair : greedyAssignment(truth, found, radius)) {
      m_used[i][detectionOf[pair.second]] = 1;
      of[pair.first] = &poles[detectionOf[pair.second]];
    }
    for (std::size_t n = 0; n < truth.size(); ++n) {
      Track& track = m_result.tracks[trackOf[n]];
      const double range = (track.place - m_frames[i].sensor).norm();
      if (range > m_maxRange) continue;
      Chance chance{
          i, range, SightLines::blocked(m_blocks[i], m_frames[i].sensor, track.place), of[n], {}};
      if (of[n])
        chance.reported = reportedBy(*of[n], truth[n], track.radius, m_frames[i].lidar_cloud);
      track.chances.push_back(chance);
    }
  }

  /// Places with several false detections: running means, in the order of the scans.
  std::vector<Eigen::Vector2d> lastingPlaces() const {
    struct Place {
      Eigen::Vector2d sum;
      std::size_t count;
    };
    std::vector<Place> places;
    for (std::size_t i = 0; i < m_result.scans; ++i)
      for (std::size_t k = 0; k < m_used[i].size(); ++k) {
        if (m_used[i][k]) continue;
        const Eigen::Vector2d p = m_frames[i].inMap(m_observed.poles[i][k]);
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

  void clutter(std::vector<Track>& soFar) {
    const std::size_t first = m_result.tracks.size();
    for (const Eigen::Vector2d& place : lastingPlaces()) {
      std::uint64_t id = kClutterIds + soFar.size();
      for (const Track& other : soFar)
        if ((other.place - place).norm() < kSame) id = other.id;
      m_result.tracks.push_back({DetectionClass::clutter, id, place, 0, {}});
      if (id == kClutterIds + soFar.size()) soFar.push_back(m_result.tracks.back());
    }
    for (std::size_t i = 0; i < m_result.scans; ++i) assign(i, first, kSame);
  }

  void passing(std::size_t i, const PoleDetection& pole) {
    const Eigen::Vector2d place(pole.x, pole.y);
    Chance chance{i, (place - m_frames[i].lidar_cloud).norm(), false, &pole, {}};
    chance.reported = reportedBy(pole, place, 0, m_frames[i].lidar_cloud);
    m_result.passing.push_back(chance);
  }

  const ObservedDrive& m_observed;
  const SimulatedDrive& m_drive;
  SightLines m_sight;
  double m_maxRange;
  std::vector<std::vector<char>> m_used;
  std::vector<Frames> m_frames;
  std::vector<std::vector<const SightLines::Block*>> m_blocks;
  TrackedDrive m_result;
};

}  // namespace

TrackedDrive trackDrive(const ObservedDrive& drive, double maxRange) {
  std::vector<Track> clutter;
  return Tracker(drive, maxRange).run(clutter);
}

TrackedStreet trackStreet(const ObservedStreet& street, double maxRange) {
  TrackedStreet tracked;
  std::vector<Track> clutter;
  tracked.first = Tracker(street.first, maxRange).run(clutter);
  const std::size_t first = clutter.size();
  tracked.second = Tracker(street.second, maxRange).run(clutter);
  std::size_t second = 0;
  for (const Track& track : tracked.second.tracks) second += track.kind == DetectionClass::clutter;
  tracked.clutterOnBoth = second - (clutter.size() - first);
  return tracked;
}

}  // namespace polemcl::sim
