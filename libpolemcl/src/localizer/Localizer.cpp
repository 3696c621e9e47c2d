#include <polemcl/localizer/Localizer.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Transform.h"
#include "io/file/TextFile.h"
#include "localizer/PointsObservation.h"
#include "localizer/ScanOdometry.h"
#include "localizer/SettingsValues.h"
#include "mrpt/filter/LocalizationPipeline.h"
#include "mrpt/observation/LidarFrame.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {
namespace {

LocalizationMap loaded(const std::filesystem::path& file, const SettingsValues& settings) {
  auto map = std::make_shared<CPoleMap>();
  map->likelihoodOptions = settings.likelihood;  // first: the index is prepared for its gate
  map->loadFromPoleMapFile(file.string());
  return {map};
}

}  // namespace

struct Localizer::Impl {
  Impl(const SettingsValues& values, LocalizationMap map, std::uint32_t seed)
      : settings(values),
        extractor(settings.poleExtraction()),
        pipeline(std::move(map), settings.localization, seed),
        odometry(settings.motion) {
    if (settings.start.anywhere)
      startAnywhere(settings.start.area);
    else if (settings.start.pose)
      start(settings.start);
  }

  void start(const StartOptions& options) {
    pipeline.start(options);
    beginDrive();
  }
  void startAnywhere(const std::optional<SearchArea>& area = {}) {
    pipeline.initializeGlobally(area);
    beginDrive();
  }
  void beginDrive() {
    odometry.restart();
    pose_map_odometry.reset();
    poles_robot.clear();
    isStarted = true;
  }
  LocalizationUpdate step(const PoleScan& frame);
  LocalizationUpdate step(PoleScan frame, const Pose2D& atScan);
  /// \brief After a scan; arguments of ScanOdometry::pass().
  LocalizationUpdate passed(const LocalizationUpdate& update, double time, const Pose2D& pose);
  LocalizationUpdate stepByOdometry(PoleScan frame, double time);
  PoleScan frameOfScan(const mrpt::obs::CObservation& scan);

  SettingsValues settings;
  ObservationPoleExtractor extractor;
  LocalizationPipeline pipeline;
  bool isStarted = false;
  ScanOdometry odometry;
  std::optional<Pose2D> pose_map_odometry;
  std::vector<PoleDetection> poles_robot;
};

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

/// A scan that is refused leaves no reading of the odometry behind.
LocalizationUpdate Localizer::Impl::step(PoleScan frame, const Pose2D& atScan) {
  const double time = frame.time;
  const Pose2D pose = odometry.atScan(time, atScan);
  frame.motion = odometry.motionTo(time, pose);
  const LocalizationUpdate update = step(frame);
  odometry.addAtScan(time, atScan);
  return passed(update, time, pose);
}

LocalizationUpdate Localizer::Impl::passed(const LocalizationUpdate& update, double time,
                                           const Pose2D& pose) {
  odometry.pass(time, pose);
  if (update.estimate)
    pose_map_odometry = compose(update.estimate->mean, relative(odometry.track().asRead(pose), {}));
  return update;
}

LocalizationUpdate Localizer::Impl::stepByOdometry(PoleScan frame, double time) {
  const auto pose = odometry.track().at(time);
  if (!pose || !odometry.track().isNear(time))
    throw Error("no odometry within 0.5 s of the scan at " + io::fixed(time, 3) +
                " s, or readings more than 2 s apart round it");
  frame.motion = odometry.motionTo(time, *pose);
  if (!frame.motion) frame.velocity = odometry.velocity();
  return passed(step(frame), time, *pose);
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
  m_impl->odometry.add(reading);
}

bool Localizer::hasOdometry(double time) const {
  return m_impl->odometry.track().reaches(time);
}

void Localizer::setRecordedTiming(const ScanTiming& timing) {
  m_impl->extractor.setRecordedTiming(timing);
}

LocalizationUpdate Localizer::step(double time, const PointsView& points,
                                   const Eigen::Isometry3d& T_robot_lidar) {
  if (!isPose(T_robot_lidar.matrix()))
    throw Error("T_robot_lidar is no pose: a finite place and a rotation are needed");
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
  return m_impl->odometry.track().jumps();
}

const std::vector<PoleDetection>& Localizer::poles() const {
  return m_impl->poles_robot;
}

}  // namespace polemcl
