#include <cmath>

#include <polemcl/localizer/Localizer.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Covariance.h"
#include "core/common/Transform.h"
#include "io/data/MotionSteps.h"
#include "io/file/TextFile.h"
#include "localizer/PointsObservation.h"
#include "localizer/SettingsValues.h"
#include "mrpt/filter/LocalizationPipeline.h"
#include "mrpt/rawlog/MotionOptions.h"
#include "mrpt/rawlog/OdometryTrack.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {
namespace {

LocalizationMap loaded(const std::filesystem::path& file, const SettingsValues& settings) {
  auto map = std::make_shared<CPoleMap>();
  map->likelihoodOptions = settings.likelihood;  // first: the index is prepared for its gate
  map->loadFromPoleMapFile(file.string());
  return {map};
}

bool isFinite(const Pose2D& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

}  // namespace

struct Localizer::Impl {
  Impl(const SettingsValues& values, LocalizationMap map, std::uint32_t seed)
      : settings(values),
        extractor(settings.poleExtraction()),
        pipeline(std::move(map), settings.localization, seed) {
    if (settings.start.anywhere)
      startAnywhere(settings.start.area);
    else if (settings.start.pose)
      start(settings.start);
  }

  void start(const StartOptions& options) {
    pipeline.start(options);
    isStarted = true;
  }
  void startAnywhere(const std::optional<SearchArea>& area = {}) {
    pipeline.initializeGlobally(area);
    isStarted = true;
  }
  void add(const OdometryReading& reading);
  LocalizationUpdate step(const PoleScan& frame);
  /// \brief With the motion that the odometry tells. \param time Of the scan as the odometry
  /// counts it: observations round theirs. \param pose Of the odometry at that time.
  LocalizationUpdate follow(PoleScan frame, double time, const Pose2D& pose);
  LocalizationUpdate step(PoleScan frame, const Pose2D& odometry);
  /// \brief With the odometry of add().
  LocalizationUpdate stepByOdometry(PoleScan frame, double time);
  PoleScan frameOfScan(const mrpt::obs::CObservation& scan);

  SettingsValues settings;
  ObservationPoleExtractor extractor;
  LocalizationPipeline pipeline;
  bool isStarted = false;
  OdometryTrack track;
  io::MotionSteps steps;                   ///< between the readings whose covariance is known
  std::optional<OdometryReading> reading;  ///< the last one; its pose is that of the track
  std::optional<Pose2D> odometryBefore;    ///< at the last scan
  double timeBefore = 0;                   ///< of the last scan, s
  std::optional<Pose2D> pose_map_odometry;
  std::vector<PoleDetection> poles_robot;
};

void Localizer::Impl::add(const OdometryReading& next) {
  if (!std::isfinite(next.time) || !isFinite(next.pose))
    throw Error("odometry: time, x, y and yaw must be finite");
  if (reading && next.time <= reading->time) return;
  track.add(next.time, next.pose);
  OdometryReading taken = next;
  taken.pose = *track.at(next.time);
  const auto& covariance = next.velocityCovariance;
  if (reading && covariance && isCovariance(*covariance) && covariance->trace() > 0) {
    const double seconds = next.time - reading->time;
    const Pose2D step = relative(reading->pose, taken.pose);
    steps.add(reading->time, next.time, {step, *covariance * seconds * seconds});
  }
  reading = taken;
  track.forgetBefore(next.time - keptOdometry);
  steps.forgetBefore(next.time - keptOdometry);
}

LocalizationUpdate Localizer::Impl::step(const PoleScan& frame) {
  if (!isStarted)
    throw Error(
        "the localizer has not been started: start it near a pose or anywhere, or say where in "
        "[start] of the settings");
  LocalizationUpdate update = pipeline.step(frame);
  pose_map_odometry.reset();
  poles_robot = frame.poles_robot;
  return update;
}

LocalizationUpdate Localizer::Impl::follow(PoleScan frame, double time, const Pose2D& pose) {
  if (odometryBefore) {
    const Pose2D motion = relative(*odometryBefore, pose);
    frame.motion = PoseWithCovariance{motion, motionCovariance(motion, settings.motion)};
    if (const auto stated = steps.covarianceBetween(timeBefore, time))
      frame.motion->covariance =
          settings.motion.covarianceFactor * (*stated + io::floorCovariance());
  }
  LocalizationUpdate update = step(frame);
  track.forgetBefore(timeBefore);  // the last motion goes on over a jump
  steps.forgetBefore(time);
  timeBefore = time;
  odometryBefore = pose;
  if (update.estimate)
    pose_map_odometry = compose(update.estimate->mean, relative(track.asRead(pose), {}));
  return update;
}

LocalizationUpdate Localizer::Impl::step(PoleScan frame, const Pose2D& odometry) {
  const double time = frame.time;
  track.add(time, odometry);
  const auto pose = track.at(time);
  if (!pose) throw Error("odometry: x, y and yaw must be finite");
  return follow(std::move(frame), time, *pose);
}

LocalizationUpdate Localizer::Impl::stepByOdometry(PoleScan frame, double time) {
  const auto pose = track.at(time);
  if (!pose) throw Error("no odometry within 0.5 s of the scan at " + io::fixed(time, 3) + " s");
  if (!odometryBefore) frame.velocity = reading->velocity;
  return follow(std::move(frame), time, *pose);
}

/// The poles of a scan, as found in it or as stored.
PoleScan Localizer::Impl::frameOfScan(const mrpt::obs::CObservation& scan) {
  if (!settings.vehicle.lidars.empty())
    throw Error("[vehicle] lidars names several LiDARs, whose scans are fused: play() does that");
  const auto* stored = dynamic_cast<const CObservationPoles*>(&scan);
  return frameOf(stored ? *stored : *extractor.process(scan), {});
}

Localizer::Localizer(const Settings& settings, const std::filesystem::path& map)
    : Localizer(settings, loaded(map, settings.values()), settings.values().runs.seed) {}
Localizer::Localizer(const Settings& settings, const LocalizationMap& map, std::uint32_t seed)
    : m_impl(std::make_unique<Impl>(settings.values(), map, seed)) {}
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;
Localizer::~Localizer() = default;

void Localizer::start(const Pose2D& pose_map_robot, std::optional<double> radius,
                      std::optional<double> heading) {
  StartOptions options = m_impl->settings.start;
  options.anywhere = false;
  options.pose = pose_map_robot;
  options.radius = radius.value_or(options.radius);
  options.heading = heading.value_or(options.heading);
  m_impl->start(options);
}

void Localizer::startAnywhere() {
  m_impl->startAnywhere();
}

void Localizer::startWithin(double x, double y, double radius) {
  m_impl->startAnywhere(SearchArea{{x, y}, radius});
}

LocalizationUpdate Localizer::step(double time, const PointsView& points, const Pose2D& odometry) {
  return step(observationOf(time, points), odometry);
}

LocalizationUpdate Localizer::step(const mrpt::obs::CObservation& scan, const Pose2D& odometry) {
  return m_impl->step(m_impl->frameOfScan(scan), odometry);
}

void Localizer::addOdometry(const OdometryReading& reading) {
  m_impl->add(reading);
}

bool Localizer::hasOdometry(double time) const {
  return m_impl->track.reaches(time);
}

void Localizer::setRecordedTiming(const ScanTiming& timing) {
  m_impl->extractor.setRecordedTiming(timing);
}

LocalizationUpdate Localizer::step(double time, const PointsView& points,
                                   const Eigen::Isometry3d& T_robot_lidar) {
  auto scan = observationOf(time, points);
  scan.sensorPose = mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T_robot_lidar.matrix()));
  return m_impl->stepByOdometry(m_impl->frameOfScan(scan), time);
}

std::optional<Pose2D> Localizer::odometryFrame() const {
  return m_impl->pose_map_odometry;
}

bool Localizer::isStarted() const {
  return m_impl->isStarted;
}

LocalizationUpdate Localizer::step(double time, const std::vector<PoleDetection>& poles_robot,
                                   const Pose2D& odometry) {
  PoleScan frame;
  frame.time = time;
  frame.poles_robot = poles_robot;
  return m_impl->step(std::move(frame), odometry);
}

LocalizationUpdate Localizer::step(const PoleScan& frame) {
  return m_impl->step(frame);
}

void Localizer::play(const std::string& rawlog,
                     const std::function<void(const LocalizationUpdate&)>& consume) {
  streamPoles(rawlog, m_impl->settings.reading(),
              [&](const ReadScan& scan) { consume(step(frameOf(scan))); });
}

const LocalizationPipeline& Localizer::pipeline() const {
  return m_impl->pipeline;
}

std::size_t Localizer::odometryJumps() const {
  return m_impl->track.jumps();
}

const std::vector<PoleDetection>& Localizer::poles() const {
  return m_impl->poles_robot;
}

}  // namespace polemcl
