#include "mrpt/rawlog/ScanSource.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "config/TimingComment.h"
#include "core/common/Covariance.h"
#include "mrpt/rawlog/RawlogReader.h"

namespace polemcl {

using namespace mrpt::obs;

namespace {

/// Most scans that wait for later odometry. Bounds the memory, and the delay without odometry.
constexpr std::size_t mostWaiting = 32;

/// Scans of sensors without any odometry before the drive is given up: 5 s at 10 Hz.
constexpr std::size_t mostWithoutOdometry = 50;

/// Time over which odometry readings give a velocity, s: a turn of most LiDARs.
constexpr double shortWay = 0.1;

Pose2D planar(const mrpt::poses::CPose2D& pose) {
  return {pose.x(), pose.y(), pose.phi()};
}

std::optional<io::PlanarMotion> motionOf2D(const CActionRobotMovement2D& action,
                                           const MotionOptions& options) {
  const bool isGaussian =
      dynamic_cast<const mrpt::poses::CPosePDFGaussian*>(action.poseChange.get()) != nullptr;
  io::PlanarMotion motion;
  if (action.estimationMethod == CActionRobotMovement2D::emOdometry) {
    // The reading itself: the motion model may have turned it into random samples.
    motion.mean = planar(action.rawOdometryIncrementReading);
    motion.covariance = motionCovariance(motion.mean, options);
    if (!isGaussian) return motion;
  } else if (!action.poseChange) {
    return std::nullopt;
  }
  const auto [covariance, mean] = action.poseChange->getCovarianceAndMean();
  if (action.estimationMethod != CActionRobotMovement2D::emOdometry) motion.mean = planar(mean);
  motion.covariance = covariance.asEigen() * options.covarianceFactor;
  return motion;
}

io::PlanarMotion motionOf3D(const CActionRobotMovement3D& action, const MotionOptions& options) {
  const auto& pose = action.poseChange;
  const int use[] = {0, 1, 3};  // x, y, yaw of x, y, z, yaw, pitch, roll
  io::PlanarMotion motion;
  motion.mean = {pose.mean.x(), pose.mean.y(), pose.mean.yaw()};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      motion.covariance(i, k) = pose.cov(use[i], use[k]) * options.covarianceFactor;
  return motion;
}

void requireUsable(const io::PlanarMotion& motion) {
  const Eigen::Vector3d mean(motion.mean.x, motion.mean.y, motion.mean.yaw);
  if (!mean.allFinite() || !motion.covariance.allFinite())
    throw Error("the odometry is not finite");
  if (!isCovariance(motion.covariance))
    throw Error("the covariance of the odometry is not positive semidefinite");
}

std::string sensorOf(const CObservation& observation) {
  return std::string(observation.GetRuntimeClass()->className) + " " + observation.sensorLabel;
}

}  // namespace

bool isScan(const CObservation& observation) {
  return dynamic_cast<const CObservationPoles*>(&observation) ||
         ObservationPoleExtractor::canProcess(observation);
}

std::optional<io::PlanarMotion> motionOf(const CActionCollection& actions,
                                         const MotionOptions& options) {
  std::optional<io::PlanarMotion> motion;
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
                       double follow)
    : ScanSource(std::make_shared<RawlogReader>(path, allowTruncated, follow), path, motion) {
  const std::filesystem::path file = std::filesystem::absolute(path);
  const std::filesystem::path images = file.parent_path() / (file.stem().string() + "_Images");
  std::error_code none;
  mrpt::io::setLazyLoadPathBase(
      (std::filesystem::is_directory(images, none) ? images : file.parent_path()).string());
}

ScanSource::ScanSource(std::shared_ptr<EntrySource> entries, std::string name,
                       const MotionOptions& motion)
    : m_name(std::move(name)), m_options(motion), m_entries(std::move(entries)) {
  checkOptions(m_options);
}

void ScanSource::take(const CObservation::Ptr& observation, const RawlogEntry& entry) {
  const double time = mrpt::Clock::toDouble(observation->timestamp);
  if (const auto odometry = std::dynamic_pointer_cast<CObservationOdometry>(observation)) {
    m_odometry.add(time, planar(odometry->odometry));
    return;
  }
  if (!isScan(*observation)) return;
  if (m_sensor.empty()) m_sensor = sensorOf(*observation);
  if (sensorOf(*observation) != m_sensor) {
    ++m_otherSensors;
    return;
  }
  if (observation->timestamp == INVALID_TIMESTAMP)
    throw Error(m_name + ": scan " + std::to_string(m_scans) + " has no time");
  if (m_scans == 0) m_timing = timingIn(m_entries->comment(), m_name);
  m_waiting.push_back(
      {m_scans++, time, m_moved, {}, observation, entry.arrival, m_entries->dropped()});
  m_moved.reset();
}

void ScanSource::take(const RawlogEntry& entry) {
  if (entry.action) {
    m_anyAction = true;
    try {
      if (const auto motion = motionOf(*entry.action, m_options))
        m_moved = m_moved ? io::composeMotions(*m_moved, *motion) : *motion;
    } catch (const Error& error) {
      throw Error(m_name + ": before scan " + std::to_string(m_scans) + ": " + error.what());
    }
  }
  if (entry.observation) take(entry.observation, entry);
  if (!entry.frame) return;
  if (m_sensor.empty())  // prefer poles in a frame with several scans
    if (const auto poles = entry.frame->getObservationByClass<CObservationPoles>())
      m_sensor = sensorOf(*poles);
  for (const auto& observation : *entry.frame) take(observation, entry);
}

/// The first scan waits for the second, which tells its velocity; without actions, a scan waits for
/// odometry later than itself. Those of sensors have waited.
bool ScanSource::mustWait(const Scan& scan) const {
  if (m_entries->isLive()) return false;
  if (!m_ended && m_released == 0 && m_waiting.size() < 2) return true;
  return !m_ended && !m_anyAction && !m_odometry.reaches(scan.time) &&
         m_waiting.size() < mostWaiting;
}

std::size_t ScanSource::expected() const {
  const double share = m_entries->progress();
  if (!(share > 0)) return 0;
  return std::max(m_scans,
                  static_cast<std::size_t>(std::llround(static_cast<double>(m_scans) / share)));
}

std::optional<Velocity> ScanSource::velocityAt(const Scan& scan) const {
  if (m_odometry.covers(scan.time - shortWay, scan.time))
    return velocityOf(relative(*m_odometry.at(scan.time - shortWay), *m_odometry.at(scan.time)),
                      shortWay);
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
  if (m_released == 0) {
    scan.motion = io::PlanarMotion();
  } else if (!scan.motion) {
    const auto from = m_odometry.at(m_lastTime), to = m_odometry.at(scan.time);
    if (from && to) {
      const Pose2D mean = relative(*from, *to);
      scan.motion = io::PlanarMotion{mean, motionCovariance(mean, m_options)};
    } else {
      ++m_unknownMotions;
    }
  }
  if (scan.time > m_lastTime) m_odometry.forgetBefore(scan.time - shortWay);
  m_lastTime = scan.time;
  ++m_released;
  return scan;
}

/// Whether a scan of sensors has its odometry. The filter needs it from the first scan on.
bool ScanSource::hasOdometry(const Scan& scan) {
  if (scan.motion || m_odometry.at(scan.time)) return true;
  if (++m_unknownMotions >= mostWithoutOdometry && m_odometry.empty())
    throw Error(m_name + ": no odometry came with the first " + std::to_string(m_unknownMotions) +
                " scans: the filter needs it; add a sensor that gives CObservationOdometry, such "
                "as driver = CUdpOdometry");
  return false;
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
    }
  } catch (...) {
    m_ended = true;
    m_error = std::current_exception();  // reported later: the waiting scans come before it
  }
  return !m_waiting.empty();
}

std::optional<ScanSource::Scan> ScanSource::next() {
  while (fill()) {
    if (!m_entries->isLive() || hasOdometry(m_waiting.front())) return release();
    m_waiting.pop_front();
  }
  if (m_error) std::rethrow_exception(m_error);
  return std::nullopt;
}

}  // namespace polemcl
