#include <mrpt/core/backtrace.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <sstream>

#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "core/common/PoleIndex.h"
#include "fuzz/Fuzz.h"
#include "mrpt/observation/ObservationPoints.h"
#include "mrpt/rawlog/GnssFixes.h"
#include "mrpt/rawlog/PoleSequence.h"
#include "mrpt/rawlog/RawlogInspection.h"
#include "mrpt/rawlog/ScanSource.h"
#include "support/Samples.h"

/// MRPT notes the stack in each exception, which takes a millisecond.
void mrpt::callStackBackTrace(TCallStackBackTrace&, const unsigned int,
                              const unsigned int) noexcept {}

namespace polemcl::fuzz {
namespace {

using mrpt::serialization::CSerializable;

/// An object of MRPT's archives; null if it cannot be read: MRPT then throws what it likes.
CSerializable::Ptr objectFrom(std::string_view bytes) {
  registerClasses();
  mrpt::io::CMemoryStream memory(bytes.data(), bytes.size());
  try {
    return mrpt::serialization::archiveFrom(memory).ReadObject();
  } catch (const std::exception&) {
    return nullptr;
  }
}

/// The content of an object of one of our classes, without its name.
template <class Class>
std::shared_ptr<Class> objectOf(std::string_view bytes) {
  std::string archive = samples::bytesOf(Class());
  const std::size_t head = 1 + std::string(Class::GetRuntimeClassIdStatic().className).size();
  archive.resize(head);
  archive += bytes;
  return std::dynamic_pointer_cast<Class>(objectFrom(archive));
}

/// What objectOf() puts the name before.
template <class Class>
std::string contentOf(const Class& object) {
  const std::string archive = samples::bytesOf(object);
  return archive.substr(1 + std::string(Class::GetRuntimeClassIdStatic().className).size());
}

void readPoles(std::string_view bytes) {
  const auto scan = objectOf<CObservationPoles>(bytes);
  if (!scan) return;
  scan->polesInRobotFrame();
  scan->planarSensorPose();
  scan->exportTxtDataRow();
  std::ostringstream text;
  scan->getDescriptionAsText(text);
  frameOf(*scan, {});
}

void readMap(std::string_view bytes) {
  const auto map = objectOf<CPoleMap>(bytes);
  if (!map) return;
  map->index();
  map->asString();
  const CObservationPoles scan = samples::observation();
  std::vector<double> likelihoods;
  map->logLikelihoods(scan, {{}, {1, 2, 0.5}}, likelihoods);
  map->insertObservation(scan);
}

/// Reads the points of all scans, and does not extract.
void readRawlog(std::string_view bytes) {
  static ObservationPoints points{SensorOptions()};
  ScanSource source(fileOf("a.rawlog", bytes).string(), MotionOptions(), true);
  while (const auto scan = source.next())
    for (const LidarScan& part : scan->parts) {
      if (!ObservationPoints::canRead(*part.observation)) continue;
      const ObservationPoints::Loan loan(points);
      points.read(*part.observation);
    }
}

SequenceOptions sequenceOptions() {
  SequenceOptions options;
  options.extraction.sensor.model = "vlp16";
  options.extraction.sensor.checkBeams = false;
  options.threads = 1;
  return options;
}

/// All that programs do with a rawlog before they localize.
void readSequence(std::string_view bytes) {
  static const Readers readers{
      [](auto) { readPoleSequence((folder() / "a.rawlog").string(), sequenceOptions()); },
      [](auto) { readGnssFixes((folder() / "a.rawlog").string(), true); },
      [](auto) { inspectRawlog((folder() / "a.rawlog").string(), true); }};
  if (bytes.empty()) return;
  fileOf("a.rawlog", bytes.substr(1));
  readWithOne(readers, bytes.substr(0, 1));
}

/// A motion, then a scan in a frame.
std::string pairOf(const mrpt::obs::CObservation::Ptr& observation) {
  mrpt::obs::CActionRobotMovement2D move;
  move.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  auto change = mrpt::poses::CPosePDFGaussian::Create();
  change->mean = mrpt::poses::CPose2D(1, 0, 0.1);
  change->cov.setDiagonal(3, 0.01);
  move.poseChange = change;
  mrpt::obs::CActionCollection actions;
  actions.insert(move);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  return samples::bytesOf(actions) + samples::bytesOf(frame);
}

std::string odometryAt(double time) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.timestamp = mrpt::Clock::fromDouble(time);
  odometry.odometry = mrpt::poses::CPose2D(time, 0, 0);
  return samples::bytesOf(odometry);
}

mrpt::obs::CObservationPointCloud::Ptr cloudWith(mrpt::maps::CPointsMap::Ptr points) {
  for (int i = 0; i < 20; ++i) points->insertPoint(5 + i, 2 - i, 0.1f * i);
  auto cloud = mrpt::obs::CObservationPointCloud::Create();
  cloud->timestamp = mrpt::Clock::fromDouble(1e9);
  cloud->pointcloud = points;
  return cloud;
}

/// One object of each of MRPT's observations, poles and clouds with motions, and its own samples.
std::vector<std::string> rawlogSeeds() {
  registerClasses();
  std::vector<std::string> seeds;
  const auto classes =
      mrpt::rtti::getAllRegisteredClassesChildrenOf(CLASS_ID(mrpt::obs::CObservation));
  for (const auto* known : classes) {
    const auto object = std::dynamic_pointer_cast<CSerializable>(known->createObject());
    if (object) seeds.push_back(samples::bytesOf(*object));
  }
  auto poles = CObservationPoles::Create(samples::observation());
  seeds.push_back(pairOf(poles) + pairOf(poles));
  seeds.push_back(odometryAt(1326653000) + samples::bytesOf(*poles) + odometryAt(1326653001));
  const auto simple = cloudWith(mrpt::maps::CSimplePointsMap::Create());
  const auto intense = cloudWith(mrpt::maps::CPointsMapXYZI::Create());
  seeds.push_back(pairOf(simple) + pairOf(intense));
  for (const char* name : {"rot_scan_2d", "velodyne", "rotating", "depth"})
    seeds.push_back(made(std::string(name) + ".rawlog"));
  return seeds;
}

std::vector<std::string> sequenceSeeds() {
  std::vector<std::string> seeds;
  for (const std::string& seed : rawlogSeeds())
    for (std::size_t reader = 0; reader < 3; ++reader) seeds.push_back(inputFor(reader, seed));
  return seeds;
}

std::vector<std::string> mapSeeds() {
  CPoleMap map;
  map.setPoles({tests::variedMapPole(1, 2), tests::variedMapPole(-5, 3)});
  map.info["origin"] = "invented";
  return {contentOf(map), contentOf(CPoleMap())};
}

}  // namespace

std::vector<Target> mrptTargets() {
  const auto poles = [] { return std::vector<std::string>{contentOf(samples::observation())}; };
  return {{"observation_poles", readPoles, poles},
          {"pole_map_archive", readMap, mapSeeds},
          {"rawlog", readRawlog, rawlogSeeds},
          {"rawlog_poles", readSequence, sequenceSeeds}};
}

}  // namespace polemcl::fuzz
