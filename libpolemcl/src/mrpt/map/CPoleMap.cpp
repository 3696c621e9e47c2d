#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>  // to write std::map

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "core/common/Covariance.h"
#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"
#include "core/mapping/IncrementalMerge.h"
#include "io/file/ReadLimits.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "mrpt/common/BoundedRead.h"
#include "mrpt/drawing/SceneParts.h"

IMPLEMENTS_SERIALIZABLE(CPoleMap, CMetricMap, polemcl)

// For loading the library as a plugin. After the line above, which names the class. An
// MRPT_INITIALIZER would run before it with Clang.
[[maybe_unused]] static const bool kCPoleMapIsRegistered =
    (mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(CPoleMap, polemcl)), true);

namespace polemcl {

using mrpt::serialization::CArchive;

namespace {

Pose2D planarPose(const mrpt::poses::CPose3D& pose) {
  return {pose.x(), pose.y(), pose.yaw()};
}

void requireStorable(const CPoleMap& map) {
  bool fits = map.poles().size() <= io::kMostMapPoles && map.info.size() <= io::kMostMapFacts;
  for (const auto& [key, value] : map.info)
    fits = fits && std::max(key.size(), value.size()) <= io::kLongestMapFact;
  if (!fits)
    throw Error("a map of more than " + std::to_string(io::kMostMapPoles) + " poles or " +
                std::to_string(io::kMostMapFacts) + " facts, or with one of more than " +
                std::to_string(io::kLongestMapFact) + " bytes, fits into no archive of MRPT");
}

template <class Pole>
void requireUsable(const Pole& pole, std::size_t i) {
  if (!(std::abs(pole.x) <= PoleIndex::farthest && std::abs(pole.y) <= PoleIndex::farthest))
    throw Error("pole " + std::to_string(i) + ": the position must be finite, and at most " +
                "1e9 m from the origin");
  if (!isCovariance(pole.covariance))
    throw Error("pole " + std::to_string(i) +
                ": the covariance must be symmetric positive semidefinite");
  if (pole.covariance.trace() > kGreatestVariance)
    throw Error("pole " + std::to_string(i) + ": the covariance must be at most 1e12 m²");
}

}  // namespace

CPoleMap::CPoleMap() = default;

const PoleIndex& CPoleMap::index() const {
  return m_index.of(m_poles, likelihoodOptions.gate);
}

const PoleIndex& CPoleMap::LazyIndex::of(const std::vector<MapPole>& poles, double gate) const {
  auto index = std::atomic_load(&m_index);
  if (!index) {
    const auto built = std::make_shared<const PoleIndex>(poles, gate);
    if (std::atomic_compare_exchange_strong(&m_index, &index, built)) index = built;
  }
  return *index;  // m_index keeps it until the poles change
}

void CPoleMap::setPoles(std::vector<MapPole> poles) {
  for (std::size_t i = 0; i < poles.size(); ++i) requireUsable(poles[i], i);
  m_index = LazyIndex(std::make_shared<PoleIndex>(poles, likelihoodOptions.gate));
  m_poles = std::move(poles);
  m_merge.reset();
}

void CPoleMap::loadFromPoleMapFile(const std::string& path) {
  io::PoleMapData data = io::readPoleMap(path);
  setPoles(std::move(data.poles));
  info = std::move(data.info);
}

void CPoleMap::saveToPoleMapFile(const std::string& path) const {
  io::writePoleMap(path, {m_poles, info});
}

uint8_t CPoleMap::serializeGetVersion() const {
  return 2;  // 1: with the floor of the likelihood, 2: with its far outliers
}

void CPoleMap::serializeTo(CArchive& out) const {
  requireStorable(*this);
  out << genericMapParams << insertionOptions.mergeDistance << insertionOptions.minConfidence;
  const auto& l = likelihoodOptions;
  out << static_cast<std::uint8_t>(l.model) << l.sigma << l.outlier << l.gate << l.weighted;
  out << l.floor << l.farOutlier;
  out << info << static_cast<std::uint32_t>(m_poles.size());
  for (const auto& pole : m_poles) writePole(out, pole, pole.count);
}

void CPoleMap::serializeFrom(CArchive& in, uint8_t version) {
  if (version > 2) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> genericMapParams >> insertionOptions.mergeDistance >> insertionOptions.minConfidence;
  auto& l = likelihoodOptions;
  l.model = static_cast<LikelihoodModel>(in.ReadAs<std::uint8_t>());
  in >> l.sigma >> l.outlier >> l.gate >> l.weighted;
  auto& g = genericMapParams;
  for (bool* flag : {&g.enableSaveAs3DObject, &g.enableObservationLikelihood,
                     &g.enableObservationInsertion, &l.weighted})
    *flag = storedNumber(*flag) != 0;
  if (version >= 1) in >> l.floor;
  if (version >= 2) {
    in >> l.farOutlier;
  } else {
    l.farOutlier = 1;  // as it was then
  }
  insertionOptions.validate();
  checkOptions<LikelihoodOptions>(l);
  info = readTexts(in, io::kMostMapFacts, io::kLongestMapFact, "facts about the map");
  std::vector<MapPole> poles;
  // One by one: a count in a damaged file must not decide how much memory is allocated.
  for (std::uint32_t left = readCount(in, io::kMostMapPoles, "poles"); left > 0; --left)
    poles.push_back(readPole(in, &MapPole::count));
  setPoles(std::move(poles));
}

void CPoleMap::internal_clear() {
  setPoles({});
  info.clear();
}

bool CPoleMap::internal_insertObservation(
    const mrpt::obs::CObservation& obs,
    const std::optional<const mrpt::poses::CPose3D>& robotPose) {
  const auto* scan = dynamic_cast<const CObservationPoles*>(&obs);
  if (!scan) return false;
  const Pose2D T_map_robot = robotPose ? planarPose(*robotPose) : Pose2D();
  const Pose2D T_map_sensor = compose(T_map_robot, scan->planarSensorPose());
  std::vector<PoleDetection> detections_map;
  for (const auto& pole : scan->poles)
    if (pole.confidence >= insertionOptions.minConfidence)
      detections_map.push_back(moved(T_map_sensor, pole));
  if (detections_map.empty()) return false;
  for (std::size_t i = 0; i < detections_map.size(); ++i) requireUsable(detections_map[i], i);
  // A copy of this map shares what the map last inserted with, until one of them inserts.
  if (m_merge.use_count() != 1 || m_merge->mergeDistance() != insertionOptions.mergeDistance)
    m_merge = std::make_shared<IncrementalMerge>(m_poles, insertionOptions.mergeDistance);
  m_merge->insertScan(m_poles, detections_map);
  m_index = {};
  return true;
}

void CPoleMap::evaluate(const CObservationPoles& scan, const LikelihoodOptions& options,
                        const std::vector<Pose2D>& robotPoses, const std::vector<double>& widenings,
                        std::vector<std::vector<double>>& out) const {
  const Pose2D T_robot_sensor = scan.planarSensorPose();
  // Computed in the sensor frame: same value as in the robot frame, without moving every pole.
  const bool sameFrame = T_robot_sensor.x == 0 && T_robot_sensor.y == 0 && T_robot_sensor.yaw == 0;
  std::vector<Pose2D> sensorPoses;
  if (!sameFrame) {
    sensorPoses.reserve(robotPoses.size());
    for (const Pose2D& pose : robotPoses) sensorPoses.push_back(compose(pose, T_robot_sensor));
  }
  polemcl::widenedLogLikelihoods(scan.poles, sameFrame ? robotPoses : sensorPoses, index(), options,
                                 widenings, out);
}

void CPoleMap::widenedLogLikelihoods(const mrpt::obs::CObservation& observation,
                                     const LikelihoodOptions& options,
                                     const std::vector<Pose2D>& robotPoses,
                                     const std::vector<double>& widenings,
                                     std::vector<std::vector<double>>& out) const {
  const auto* scan = dynamic_cast<const CObservationPoles*>(&observation);
  if (scan && genericMapParams.enableObservationLikelihood)
    evaluate(*scan, options, robotPoses, widenings, out);
  else
    out.assign(widenings.size(), std::vector<double>(robotPoses.size(), 0.0));
}

void CPoleMap::logLikelihoods(const mrpt::obs::CObservation& observation,
                              const std::vector<Pose2D>& robotPoses,
                              std::vector<double>& out) const {
  std::vector<std::vector<double>> widened(1);
  widened[0].swap(out);
  widenedLogLikelihoods(observation, likelihoodOptions, robotPoses, {1}, widened);
  out.swap(widened[0]);
}

double CPoleMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& obs, const mrpt::poses::CPose3D& takenFrom) const {
  const auto* scan = dynamic_cast<const CObservationPoles*>(&obs);
  if (!scan) return 0;
  std::vector<std::vector<double>> out;
  evaluate(*scan, likelihoodOptions, {planarPose(takenFrom)}, {1}, out);
  return out[0][0];
}

bool CPoleMap::internal_canComputeObservationLikelihood(const mrpt::obs::CObservation& obs) const {
  return dynamic_cast<const CObservationPoles*>(&obs) != nullptr;
}

std::string CPoleMap::asString() const {
  return "polemcl::CPoleMap: " + std::to_string(m_poles.size()) + " poles";
}

void CPoleMap::saveMetricMapRepresentationToFile(const std::string& filNamePrefix) const {
  saveToPoleMapFile(filNamePrefix + ".polemap");
  io::writePoleCsv(filNamePrefix + ".csv", m_poles);
  viz::Scene scene;
  scene.insert(getVisualization());
  scene::save(scene, filNamePrefix + ".3Dscene");
}

void CPoleMap::getVisualizationInto(viz::CSetOfObjects& outObj) const {
  if (!genericMapParams.enableSaveAs3DObject) return;
  for (std::size_t i = 0; i < m_poles.size(); ++i) {
    const auto& pole = m_poles[i];
    scene::drawPole(outObj, pole.x, pole.y, pole.radius, pole.bottom, pole.top,
                    scene::colorOfCount(pole.count), "pole " + std::to_string(i));
  }
}

}  // namespace polemcl
