#include "simulate/SimulatedPoles.h"

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "io/data/Trajectory.h"
#include "io/file/AtomicFile.h"
#include "io/file/ErrorPlace.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "sim/detections/DetectionSampler.h"

namespace polemcl::apps {
namespace {

/// Scans worked on at a time: enough for the threads, few enough for the memory.
constexpr std::size_t kScansAtOnce = 64;

/// The time of a scan in whole microseconds, as times.txt keeps it.
mrpt::Clock::time_point stampOf(const sim::Drive& drive, std::size_t i) {
  return mrpt::Clock::fromDouble(std::round(drive.time[i] * 1e6) / 1e6);
}

PoseWithCovariance motionTo(const sim::Drive& drive, std::size_t i) {
  if (i == 0) return standstill();
  const sim::OdometryStep& step = drive.odometry[i - 1];
  PoseWithCovariance motion;
  motion.mean = {step.dx, step.dy, step.dyaw};
  motion.covariance = Eigen::Vector3d(step.sx, step.sy, step.syaw).cwiseAbs2().asDiagonal();
  return motion;
}

/// Takes the poles of one scan after the other to the files.
class PoleDriveWriter {
 public:
  PoleDriveWriter(const sim::SimulationOptions& options, const PoleDriveFiles& files)
      : m_options(options), m_files(files), m_rawlog(files.rawlog.string()), m_truth(files.truth) {}

  void write(const sim::Drive& drive, std::size_t i, const CObservationPoles::Ptr& observation) {
    observation->timestamp = stampOf(drive, i);
    m_rawlog.write(makeActions(motionTo(drive, i), observation->timestamp), observation);
    m_poses.push_back({mrpt::Clock::toDouble(observation->timestamp),
                       sim::cloudFrame(drive.T_map_sensor[i], m_options)});
    ++m_summary.scans;
    m_summary.poles += observation->poles.size();
    m_summary.points += observation->points;
  }

  PoleDriveSummary commit(const sim::World& world, const AllSettings& settings) {
    io::AtomicFiles together;
    io::writeTum(m_truth, m_poses);
    sim::writeTruePoles(m_files.poles, world.poles());
    saveSettings(settings, m_files.config.string());
    m_rawlog.commit();
    together.commit();
    m_summary.truePoles = world.poles().size();
    m_summary.length = m_options.spacing * static_cast<double>(m_summary.scans - 1);
    return m_summary;
  }

 private:
  sim::SimulationOptions m_options;
  PoleDriveFiles m_files;
  RawlogWriter m_rawlog;
  io::AtomicFile m_truth;
  std::vector<io::StampedPose3D> m_poses;
  PoleDriveSummary m_summary;
};

/// Works on the scans in blocks: in parallel within one, written in order after each.
void writeInBlocks(const sim::Drive& drive, PoleDriveWriter& writer,
                   const std::function<CObservationPoles::Ptr(std::size_t)>& polesOf,
                   const std::function<void(std::size_t)>& progress) {
  const std::size_t scans = drive.time.size();
  std::vector<CObservationPoles::Ptr> block(kScansAtOnce);
  for (std::size_t first = 0; first < scans; first += kScansAtOnce) {
    const std::size_t end = std::min(first + kScansAtOnce, scans);
    tbb::parallel_for(first, end, [&](std::size_t i) { block[i - first] = polesOf(i); });
    for (std::size_t i = first; i < end; ++i) writer.write(drive, i, block[i - first]);
    if (progress) progress(end);
  }
}

mrpt::obs::CObservationPointCloud cloudOf(const sim::SimulatedScan& scan) {
  mrpt::obs::CObservationPointCloud observation;
  observation.sensorLabel = "lidar";
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
    points->setPointFast(i, scan.x[i], scan.y[i], scan.z[i]);
  observation.pointcloud = points;
  return observation;
}

}  // namespace

PoleDriveFiles poleDriveFiles(const std::filesystem::path& rawlog) {
  if (rawlog.extension() != ".rawlog")
    throw Error("--poles " + rawlog.string() +
                ": the name must end in .rawlog (truth and true poles go beside it)");
  const auto beside = [&](const char* end) {
    auto path = rawlog;
    path.replace_extension();
    return std::filesystem::path(path.string() + end);
  };
  return {rawlog, beside(".tum"), beside("_poles_gt.csv"), beside("_config.ini")};
}

PoleDriveSummary castPoles(const sim::SimulatedDrive& drive, const AllSettings& settings,
                           const PoleDriveFiles& files, const sim::ScanFolderWriter* folder,
                           const std::function<void(std::size_t)>& progress) {
  const ObservationPoleExtractorOptions options = settings.poleExtraction();
  tbb::enumerable_thread_specific<ObservationPoleExtractor> extractions(
      [&options] { return ObservationPoleExtractor(options); });
  extractions.local();  // refuses bad options before anything is written
  PoleDriveWriter writer(drive.options(), files);
  const auto polesOf = [&](std::size_t i) {
    const sim::SimulatedScan scan = drive.scan(i);
    if (folder) folder->write(i, scan);
    ObservationPoleExtractor& extraction = extractions.local();
    if (drive.options().motionDistortion) extraction.setRecordedTiming(timingOf(drive.lidar()));
    extraction.checkNext(i < 3);  // by index, so that the threads have no say in it
    return io::located("simulated scan " + std::to_string(i) + ": ",
                       [&] { return extraction.process(cloudOf(scan)); });
  };
  writeInBlocks(drive.drive(), writer, polesOf, progress);
  return writer.commit(drive.world(), settings);
}

PoleDriveSummary samplePoles(const sim::SimulatedDrive& drive, const AllSettings& settings,
                             const PoleDriveFiles& files,
                             const std::function<void(std::size_t)>& progress) {
  const std::string& file = drive.options().detections;
  auto options = drive.options();
  options.sensor = drive.lidar().name;  // more exact than "table"
  const auto model = sim::readDetectionModel(file);
  const auto sampler = io::located(
      file + ": ", [&] { return sim::DetectionSampler(model, drive.world(), options); });
  PoleDriveWriter writer(drive.options(), files);
  const auto polesOf = [&](std::size_t i) {
    auto observation = std::make_shared<CObservationPoles>();
    observation->sensorLabel = "lidar";
    observation->points = sampler.model().points;
    observation->poles = sampler.sample(i, drive.drive().T_map_sensor[i]);
    observation->visibilityRange = sampler.visibilityRange(drive.drive().T_map_sensor[i]);
    return observation;
  };
  writeInBlocks(drive.drive(), writer, polesOf, progress);
  return writer.commit(drive.world(), settings);
}

}  // namespace polemcl::apps
