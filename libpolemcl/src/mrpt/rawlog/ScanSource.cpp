#include "mrpt/rawlog/ScanSource.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "config/TimingComment.h"
#include "core/common/Binder.h"
#include "core/common/Covariance.h"
#include "io/file/TextFile.h"
#include "mrpt/common/BoundedRead.h"
#include "mrpt/observation/ObservationPoints.h"
#include "mrpt/observation/ScanFusion.h"
#include "mrpt/rawlog/RawlogReader.h"

namespace polemcl {

using namespace mrpt::obs;

namespace {

/// Most scans that wait for later odometry. Bounds the memory, and the delay without odometry.
constexpr std::size_t kMostWaiting = 32;

/// Scans of sensors without any odometry before the drive is given up: 5 s at 10 Hz.
constexpr std::size_t kMostWithoutOdometry = 50;

/// Fused scans without any of one LiDAR before a rawlog is given up: 5 s at 10 Hz.
constexpr std::size_t kMostWithoutLidar = 50;

/// Time over which odometry readings give a velocity, s: a turn of most LiDARs.
constexpr double kShortWay = 0.1;

Pose2D planar(const mrpt::poses::CPose2D& pose) {
  return {pose.x(), pose.y(), pose.phi()};
}

std::optional<PoseWithCovariance> motionOf2D(const CActionRobotMovement2D& action,
                                             const MotionOptions& options) {
  const bool isGaussian =
      dynamic_cast<const mrpt::poses::CPosePDFGaussian*>(action.poseChange.get()) != nullptr;
  const bool isOdometry =
      storedNumber(action.estimationMethod) == CActionRobotMovement2D::emOdometry;
  PoseWithCovariance motion;
  if (isOdometry) {
    // The reading itself: the motion model may have turned it into random samples.
    motion.mean = planar(action.rawOdometryIncrementReading);
    motion.covariance = motionCovariance(motion.mean, options);
    if (!isGaussian) return motion;
  } else if (!action.poseChange) {
    return std::nullopt;
  }
  const auto [covariance, mean] = action.poseChange->getCovarianceAndMean();
  if (!isOdometry) motion.mean = planar(mean);
  motion.covariance = covariance.asEigen() * options.covarianceFactor;
  return motion;
}

PoseWithCovariance motionOf3D(const CActionRobotMovement3D& action, const MotionOptions& options) {
  const auto& pose = action.poseChange;
  const int use[] = {0, 1, 3};  // x, y, yaw of x, y, z, yaw, pitch, roll
  PoseWithCovariance motion;
  motion.mean = {pose.mean.x(), pose.mean.y(), pose.mean.yaw()};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      motion.covariance(i, k) = pose.cov(use[i], use[k]) * options.covarianceFactor;
  return motion;
}

void requireUsable(const PoseWithCovariance& motion) {
  const Eigen::Vector3d mean(motion.mean.x, motion.mean.y, motion.mean.yaw);
  if (!mean.allFinite() || !motion.covariance.allFinite())
    throw Error("the odometry is not finite");
  if (!isCovariance(motion.covariance))
    throw Error("the covariance of the odometry is not positive semidefinite");
}

std::string sensorOf(const CObservation& observation) {
  return std::string(observation.GetRuntimeClass()->className) + " " + observation.sensorLabel;
}

/// A sensor whose times go back by more than this was ahead, s.
constexpr double kClockSet = 3;

/// MRPT has one such folder, which other threads may read: it is only set where it changes.
void setFolderOfClouds(const std::filesystem::path& folder) {
  static std::mutex ofFolder;
  const std::lock_guard lock(ofFolder);
  if (mrpt::io::getLazyLoadPathBase() != folder.string())
    mrpt::io::setLazyLoadPathBase(folder.string());
}

}  // namespace

bool isScan(const CObservation& observation) {
  return dynamic_cast<const CObservationPoles*>(&observation) ||
         ObservationPoleExtractor::canProcess(observation);
}

std::optional<PoseWithCovariance> motionOf(const CActionCollection& actions,
                                           const MotionOptions& options) {
  std::optional<PoseWithCovariance> motion;
  if (const auto best = actions.getBestMovementEstimation())
    motion = motionOf2D(*best, options);
  else
    for (auto action = actions.begin(); action != actions.end() && !motion; ++action)
      if (const auto move = std::dynamic_pointer_cast<CActionRobotMovement3D>(action->get_ptr()))
        motion = motionOf3D(*move, options);
  if (motion) requireUsable(*motion);
  return motion;
}

ScanSource::ScanSource(const std::string& path, const MotionOptions& motion, bool allowTruncated,
                       double follow, const VehicleOptions& vehicle)
    : ScanSource(std::make_shared<RawlogReader>(path, allowTruncated, follow), path, motion,
                 vehicle) {
  const std::filesystem::path file = std::filesystem::absolute(path);
  const std::filesystem::path images = file.parent_path() / (file.stem().string() + "_Images");
  std::error_code none;
  setFolderOfClouds(std::filesystem::is_directory(images, none) ? images : file.parent_path());
}

ScanSource::ScanSource(std::shared_ptr<EntrySource> entries, std::string name,
                       const MotionOptions& motion, const VehicleOptions& vehicle)
    : m_name(std::move(name)),
      m_options(motion),
      m_entries(std::move(entries)),
      m_vehicle(vehicle),
      m_ofLidar(vehicle.lidars.size()),
      m_late(vehicle.lidars.size()) {
  checkOptions(m_options);
  if (!vehicle.lidars.empty()) m_groups.emplace(vehicle);
}

/// Which LiDAR an observation is from; none: not used. Poles that were fused before are read as
/// they are, if they come first.
std::optional<std::size_t> ScanSource::lidarOf(const CObservation& observation) {
  if (m_groups) {
    if (const auto lidar = m_vehicle.indexOf(observation.sensorLabel)) return lidar;
    const bool isFirst = std::all_of(m_ofLidar.begin(), m_ofLidar.end(),
                                     [](std::size_t scans) { return scans == 0; });
    if (!isFirst || observation.sensorLabel != kFusedLabel ||
        !dynamic_cast<const CObservationPoles*>(&observation))
      return std::nullopt;
    m_groups.reset();
  }
  if (m_sensor.empty()) m_sensor = sensorOf(observation);
  return sensorOf(observation) == m_sensor ? std::optional<std::size_t>(0) : std::nullopt;
}

void ScanSource::take(const CObservation::Ptr& observation, const RawlogEntry& entry) {
  const double time = mrpt::Clock::toDouble(observation->timestamp);
  if (const auto odometry = std::dynamic_pointer_cast<CObservationOdometry>(observation)) {
    if (m_odometry.empty()) m_odometryLabel = odometry->sensorLabel;
    if (odometry->sensorLabel != m_odometryLabel) {
      m_otherOdometry.insert(odometry->sensorLabel);
      return;
    }
    if (isLive() && time < m_lastOdometry - kClockSet) m_odometry.forgetAfter(time);
    m_lastOdometry = time;
    m_odometry.add(time, planar(odometry->odometry));
    return;
  }
  if (!isScan(*observation)) {
    if (!m_planar && dynamic_cast<const CObservation2DRangeScan*>(observation.get()))
      m_planar = observation;
    return;
  }
  const auto lidar = lidarOf(*observation);
  if (!lidar) {
    ++m_otherSensors;
    m_otherLabels.insert(sensorOf(*observation));
    return;
  }
  if (observation->timestamp == INVALID_TIMESTAMP)
    throw Error(m_name + ": scan " + std::to_string(m_scans) + " has no time");
  if (m_scans == 0) m_timing = timingIn(m_entries->comment(), m_name);
  add({observation, *lidar, time, 0, m_motions, m_moved, entry.arrival});
}

void ScanSource::add(LidarScan scan) {
  if (!m_groups) {
    scan.ordinal = m_scans;
    m_waiting.push_back({m_scans++,
                         scan.time,
                         scan.motion,
                         {},
                         {},
                         {scan},
                         false,
                         scan.arrival,
                         m_entries->dropped()});
    m_moved.reset();
    return;
  }
  const std::size_t lidar = scan.lidar;
  scan.time += m_vehicle.lidars[lidar].sensor.timing.clock;
  scan.ordinal = m_ofLidar[lidar]++;
  if (m_groups->add(std::move(scan)))
    m_moved.reset();
  else
    ++m_late[lidar];  // its motion goes on to the next scan
}

/// Makes scans of the groups that are complete.
void ScanSource::takeGroups() {
  if (!m_groups) return;
  for (auto parts = m_groups->next(m_ended); !parts.empty(); parts = m_groups->next(m_ended)) {
    Scan scan;
    scan.index = m_scans++;
    scan.dropped = m_entries->dropped();
    scan.time = parts.front().time;
    for (const LidarScan& part : parts) {
      scan.time = std::max(scan.time, part.time);
      if (part.motion)
        scan.motion = scan.motion ? io::composeMotions(*scan.motion, *part.motion) : *part.motion;
      if (part.arrival)
        scan.arrival = std::max(scan.arrival.value_or(*part.arrival), *part.arrival);
    }
    const auto byLidar = [](const LidarScan& a, const LidarScan& b) { return a.lidar < b.lidar; };
    std::sort(parts.begin(), parts.end(), byLidar);
    scan.parts = std::move(parts);
    scan.isFused = true;
    m_waiting.push_back(std::move(scan));
  }
}

void ScanSource::take(const RawlogEntry& entry) {
  if (entry.action) {
    try {
      if (const auto motion = motionOf(*entry.action, m_options)) {
        m_moved = m_moved ? io::composeMotions(*m_moved, *motion) : *motion;
        ++m_motions;
      }
    } catch (const Error& error) {
      throw Error(m_name + ": before scan " + std::to_string(m_scans) + ": " + error.what());
    }
  }
  if (entry.observation) take(entry.observation, entry);
  if (!entry.frame) return;
  if (m_sensor.empty() && !m_groups)  // prefer poles in a frame with several scans
    if (const auto poles = entry.frame->getObservationByClass<CObservationPoles>())
      m_sensor = sensorOf(*poles);
  for (const auto& observation : *entry.frame) take(observation, entry);
}

/// The first scan waits for the second, which tells its velocity; without motions by actions, a
/// scan waits for odometry later than itself. Those of sensors have waited.
bool ScanSource::mustWait(const Scan& scan) const {
  if (m_entries->isLive()) return false;
  if (!m_ended && m_released == 0 && m_waiting.size() < 2) return true;
  return !m_ended && m_motions == 0 && !m_odometry.reaches(scan.time) &&
         m_waiting.size() < kMostWaiting;
}

std::size_t ScanSource::expected() const {
  const double share = m_entries->progress();
  if (!(share > 0)) return 0;
  return std::max(m_scans,
                  static_cast<std::size_t>(std::llround(static_cast<double>(m_scans) / share)));
}

std::optional<Velocity> ScanSource::velocityAt(const Scan& scan) const {
  if (m_odometry.covers(scan.time - kShortWay, scan.time))
    return velocityOf(relative(*m_odometry.at(scan.time - kShortWay), *m_odometry.at(scan.time)),
                      kShortWay);
  if (m_released > 0 || m_waiting.empty()) return std::nullopt;
  const Scan& next = m_waiting.front();
  if (!next.motion || next.time <= scan.time) return std::nullopt;
  return velocityOf(next.motion->mean, next.time - scan.time);
}

ScanSource::Scan ScanSource::release() {
  Scan scan = std::move(m_waiting.front());
  m_waiting.pop_front();
  scan.index = m_released;
  scan.velocity = velocityAt(scan);
  scan.moving = scan.velocity;
  if (m_released == 0) {
    scan.motion = PoseWithCovariance();
  } else if (!scan.motion) {
    const auto from = m_odometry.at(m_lastTime), to = m_odometry.at(scan.time);
    if (from && to) {
      const Pose2D mean = relative(*from, *to);
      scan.motion = PoseWithCovariance{mean, motionCovariance(mean, m_options)};
    } else {
      ++m_unknownMotions;
    }
  }
  if (!scan.moving && scan.motion && m_released > 0 && scan.time > m_lastTime)
    scan.moving = velocityOf(scan.motion->mean, scan.time - m_lastTime);
  if (scan.time > m_lastTime) m_odometry.forgetBefore(scan.time - kShortWay);
  m_lastTime = scan.time;
  ++m_released;
  return scan;
}

/// Whether a scan is left out: one of sensors without odometry, which the filter needs from the
/// first scan on, and one of a rawlog in a long gap of its odometry.
bool ScanSource::isLeftOut(const Scan& scan) {
  const bool needed = isLive() || m_odometry.at(scan.time);
  if (!needed || scan.motion || m_odometry.isNear(scan.time)) return false;
  if (++m_unknownMotions >= kMostWithoutOdometry && m_odometry.empty())
    throw Error(m_name + ": no odometry came with the first " + std::to_string(m_unknownMotions) +
                " scans: the filter needs it; add a sensor that gives CObservationOdometry, such "
                "as driver = CUdpOdometry");
  return true;
}

/// Each LiDAR of the vehicle must be in a rawlog; known at its end, or when others have come often.
void ScanSource::requireLidars() const {
  if (!m_groups || m_entries->isLive() || !(m_ended || m_scans >= kMostWithoutLidar)) return;
  for (std::size_t i = 0; i < m_ofLidar.size(); ++i) {
    if (m_ofLidar[i] > 0) continue;
    throw Error(m_name + ": no scan of the LiDAR " + m_vehicle.lidars[i].label +
                " that [vehicle] lidars lists" +
                (m_ended ? "" : " in the first " + std::to_string(m_scans) + " scans") +
                "; scans of other sensors: " +
                (m_otherLabels.empty() ? "none" : io::joined(m_otherLabels)) +
                "; write the sensor labels that are in the rawlog");
  }
}

/// Reads on until the first waiting scan can be released; false at the end.
bool ScanSource::fill() {
  RawlogEntry entry;
  try {
    while (!m_ended && (m_waiting.empty() || mustWait(m_waiting.front()))) {
      if (m_entries->next(entry))
        take(entry);
      else
        m_ended = true;
      takeGroups();
      requireLidars();
    }
  } catch (...) {
    m_ended = true;
    m_error = std::current_exception();  // reported later: the waiting scans come before it
    takeGroups();
  }
  return !m_waiting.empty();
}

std::optional<ScanSource::Scan> ScanSource::next() {
  while (fill()) {
    if (!isLeftOut(m_waiting.front())) return release();
    m_waiting.pop_front();
  }
  if (m_error) std::rethrow_exception(m_error);
  if (m_released == 0 && m_planar)
    throw Error(m_name + ": " + ObservationPoints::refusalOf(*m_planar));
  return std::nullopt;
}

}  // namespace polemcl
