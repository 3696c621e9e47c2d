#include <polemcl/localizer/Localizer.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Transform.h"
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
  LocalizationUpdate step(const PoleScan& frame);
  LocalizationUpdate step(PoleScan frame, const Pose2D& odometry);

  SettingsValues settings;
  ObservationPoleExtractor extractor;
  LocalizationPipeline pipeline;
  bool isStarted = false;
  OdometryTrack track;
  std::optional<Pose2D> odometryBefore;  ///< at the last scan
  double timeBefore = 0;                 ///< of the last scan, s
  std::vector<PoleDetection> poles_robot;
};

LocalizationUpdate Localizer::Impl::step(const PoleScan& frame) {
  if (!isStarted)
    throw Error(
        "the localizer has not been started: start it near a pose or anywhere, or say where in "
        "[start] of the settings");
  LocalizationUpdate update = pipeline.step(frame);
  poles_robot = frame.poles_robot;
  return update;
}

LocalizationUpdate Localizer::Impl::step(PoleScan frame, const Pose2D& odometry) {
  track.add(frame.time, odometry);
  const auto pose = track.at(frame.time);
  if (!pose) throw Error("odometry: x, y and yaw must be finite");
  if (odometryBefore) {
    const Pose2D motion = relative(*odometryBefore, *pose);
    frame.motion = PoseWithCovariance{motion, motionCovariance(motion, settings.motion)};
  }
  LocalizationUpdate update = step(frame);
  track.forgetBefore(timeBefore);  // the last motion goes on over a jump
  timeBefore = frame.time;
  odometryBefore = pose;
  return update;
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
  if (!m_impl->settings.vehicle.lidars.empty())
    throw Error("[vehicle] lidars names several LiDARs, whose scans are fused: play() does that");
  const auto* stored = dynamic_cast<const CObservationPoles*>(&scan);
  if (stored) return m_impl->step(frameOf(*stored, {}), odometry);
  return m_impl->step(frameOf(*m_impl->extractor.process(scan), {}), odometry);
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
