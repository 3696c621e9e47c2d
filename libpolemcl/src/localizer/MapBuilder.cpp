#include <polemcl/localizer/MapBuilder.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "core/mapping/LandmarkFusion.h"
#include "core/mapping/MapAccumulator.h"
#include "io/map/PoleMapFile.h"
#include "localizer/PointsObservation.h"
#include "localizer/SettingsValues.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {
namespace {

constexpr double kHalfTurn = 0.05;  // of most LiDARs, s

ObservationPoleExtractorOptions extractionFor(SettingsValues settings) {
  // Others can confirm a doubtful detection.
  if (settings.map.minConfidence > 0)
    settings.extraction.scanLine.minConfidence = settings.map.minConfidence;
  return settings.poleExtraction();
}

}  // namespace

struct MapBuilder::Impl {
  explicit Impl(const Settings& given)
      : settings(given), extractor(extractionFor(settings.values())) {}

  void add(const CObservationPoles& observation, const Pose2D& pose_map_robot);
  MapAccumulator mapped() const;

  Settings settings;
  ObservationPoleExtractor extractor;
  std::vector<SessionScan> scans;  ///< poles as they were measured
  std::vector<StampedPose2D> path;
};

void MapBuilder::Impl::add(const CObservationPoles& observation, const Pose2D& pose_map_robot) {
  const PoleScan frame = frameOf(observation, {});
  checkScan(pose_map_robot, frame.poles_robot, "scan " + std::to_string(path.size()));
  if (!path.empty() && !(frame.time > path.back().time))
    throw Error("time does not increase: scan " + std::to_string(path.size()) + " at " +
                std::to_string(frame.time) + " s comes after one at " +
                std::to_string(path.back().time) + " s");
  path.push_back({frame.time, pose_map_robot});
  if (frame.poles_robot.empty() && observation.points == 0) return;  // neither seen nor missed
  scans.push_back({frame.time, pose_map_robot, frame.poles_robot, frame.visibilityRange,
                   frame.pose_robot_sensor});
}

MapAccumulator MapBuilder::Impl::mapped() const {
  std::vector<SessionScan> corrected = scans;
  for (SessionScan& scan : corrected)
    deskew(scan.poles_robot, velocityAt(path, scan.time, kHalfTurn, longestTruthGap));
  MapAccumulator map(settings.values().map, settings.values().upkeep);
  map.add("", std::move(corrected));
  return map;
}

MapBuilder::MapBuilder(const Settings& settings) : m_impl(std::make_unique<Impl>(settings)) {}
MapBuilder::MapBuilder(MapBuilder&&) noexcept = default;
MapBuilder& MapBuilder::operator=(MapBuilder&&) noexcept = default;
MapBuilder::~MapBuilder() = default;

void MapBuilder::add(double time, const PointsView& points, const Pose2D& pose_map_robot) {
  add(observationOf(time, points), pose_map_robot);
}

void MapBuilder::add(const mrpt::obs::CObservation& scan, const Pose2D& pose_map_robot) {
  if (const auto* stored = dynamic_cast<const CObservationPoles*>(&scan))
    m_impl->add(*stored, pose_map_robot);
  else
    m_impl->add(*m_impl->extractor.process(scan), pose_map_robot);
}

std::vector<MapPole> MapBuilder::poles() const {
  return m_impl->mapped().build().poles;
}

void MapBuilder::save(const std::filesystem::path& file) const {
  if (file.extension() != ".polemap")
    throw Error(file.string() + ": the name must end in .polemap");
  const MapAccumulator map = m_impl->mapped();
  const PoleMapResult result = map.build();
  if (result.poles.empty())
    throw Error(file.string() + ": no pole found in " + std::to_string(m_impl->scans.size()) +
                " scans; see [sensor] and [map]");
  io::writePoleMap(file, io::mapData(map.withHistories(result.poles),
                                     {{"scans", std::to_string(m_impl->scans.size())},
                                      {"config", m_impl->settings.text()}}));
}

}  // namespace polemcl
