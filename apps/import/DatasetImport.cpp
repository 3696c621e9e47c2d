#include "import/DatasetImport.h"

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <random>

#include <polemcl/io/data/Cloud.h>
#include "config/TimingComment.h"
#include "core/common/Angles.h"
#include "core/common/DetectionCheck.h"
#include "core/common/Statistics.h"
#include "io/data/Trajectory.h"
#include "io/dataset/KittiOdometry.h"
#include "io/dataset/KittiRaw.h"
#include "io/dataset/Mulran.h"
#include "io/dataset/Nclt.h"
#include "io/dataset/Rosbag2.h"
#include "io/dataset/ScanFiles.h"
#include "io/dataset/ScanPoses.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "mrpt/rawlog/GnssFixes.h"
#include "mrpt/rawlog/RawlogWriter.h"

namespace polemcl::apps {
namespace {

/// A file that states the timing, where the reader does not.
std::filesystem::path timingFile(const ImportOptions& options) {
  return options.input / "scan_timing.ini";
}

io::ScanFolder readBag(const ImportOptions& options) {
  io::Rosbag2Options bag;
  bag.topics = options.topics;
  bag.readsSensorPose = !options.T_robot_sensor;
  bag.readsTiming = !options.timing && !std::filesystem::exists(timingFile(options));
  bag.readsOdometry = !options.odometry;
  return io::readRosbag2(options.input, bag);
}

io::ScanFolder readDataset(const ImportOptions& options, const Eigen::Isometry3d& T_robot_sensor,
                           const io::ReadProgress& progress) {
  switch (options.dataset) {
    case Dataset::kittiOdometry:
      return io::readKittiOdometry(options.input, T_robot_sensor);
    case Dataset::kittiRaw:
      return io::readKittiRaw(
          options.input, options.calibration.value_or(io::folderNamed(options.input).parent_path()),
          T_robot_sensor);
    case Dataset::nclt:
      return io::readNclt(options.input, T_robot_sensor, progress);
    case Dataset::mulran:
      return io::readMulran(options.input, T_robot_sensor);
    case Dataset::pcd:
      return io::readPcdFolder(options.input, T_robot_sensor);
    case Dataset::rosbag2:
      return readBag(options);
    case Dataset::folder:
      break;
  }
  return io::readScanFolder(options.input, T_robot_sensor);
}

/// Motions since the last scan that was written: composed odometry, or truth with noise.
class MotionSource {
 public:
  explicit MotionSource(const ImportOptions& options)
      : m_options(options), m_generator(options.seed) {}

  /// \brief To be called for every scan of the dataset in turn, written or not.
  void pass(const io::ScanEntry& scan) {
    if (!m_started) return;  // the first scan that is written starts at itself
    if (m_composed && scan.motion)
      m_composed = io::composeMotions(*m_composed, *scan.motion);
    else
      m_composed = scan.motion;
  }

  /// \brief The motion since the last scan that was written, up to this one, which gets written.
  /// None when nothing is known of it.
  std::optional<PoseWithCovariance> take(const io::ScanEntry& scan) {
    std::optional<PoseWithCovariance> motion = m_composed;
    if (!m_started) {
      motion = standstill();
    } else if (m_options.odometryNoise) {
      const Pose2D truth = relative(m_last, io::planar(*scan.T_map_robot));
      motion = io::noisyMotion(truth, *m_options.odometryNoise, m_generator);
      motion->mean.x += m_options.odometryScale * truth.x;
      motion->mean.y += m_options.odometryScale * truth.y;
      motion->mean.yaw = wrapAngle(motion->mean.yaw + m_options.odometryYaw * truth.x);
    }
    m_started = true;
    m_composed.reset();
    if (scan.T_map_robot) m_last = io::planar(*scan.T_map_robot);
    return motion;
  }

 private:
  const ImportOptions& m_options;
  std::mt19937_64 m_generator;
  std::optional<PoseWithCovariance> m_composed;
  Pose2D m_last;
  bool m_started = false;
};

/// Empty where a damaged scan is to be left out.
io::Cloud cloudOf(const io::ScanFolder& folder, const io::ScanEntry& scan,
                  const ImportOptions& options, ImportReport& report) {
  try {
    return folder.read ? folder.read(scan) : io::readKittiBin(scan.cloud);
  } catch (const Error& error) {
    if (options.dataset != Dataset::pcd) throw;
    if (!options.skipDamaged)
      throw Error(std::string(error.what()) + "; --skip-damaged leaves such scans out");
    ++report.damagedScans;
    report.notes.push_back(std::string("left out: ") + error.what());
    return {};
  }
}

/// The cloud as an observation; none when the scan is empty. Counts points in the report.
mrpt::obs::CObservationPointCloud::Ptr makeObservation(const io::ScanFolder& folder,
                                                       const io::ScanEntry& scan,
                                                       const Eigen::Isometry3d& T_robot_sensor,
                                                       const ImportOptions& options,
                                                       ImportReport& report) {
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->sensorLabel = "lidar";
  observation->timestamp = mrpt::Clock::fromDouble(scan.time);
  observation->sensorPose =
      mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T_robot_sensor.matrix()));
  if (!report.embedded) {
    if (std::filesystem::file_size(scan.cloud) == 0) return nullptr;
    observation->setAsExternalStorage(
        scan.cloud.string(),
        mrpt::obs::CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
    return observation;
  }
  const io::Cloud cloud = cloudOf(folder, scan, options, report);
  report.points += cloud.size();
  report.invalidPoints += cloud.invalid;
  if (cloud.size() == 0) return nullptr;
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points->setPointFast(i, cloud.x[i], cloud.y[i], cloud.z[i]);
    points->setPointIntensity(i, cloud.intensity[i]);
  }
  observation->pointcloud = points;
  return observation;
}

std::vector<mrpt::obs::CObservationGPS::Ptr> gnssObservations(const io::ScanFolder& folder) {
  std::vector<mrpt::obs::CObservationGPS::Ptr> observations;
  for (const GnssFix& fix : folder.fixes) observations.push_back(gnssObservation(fix));
  return observations;
}

void checkTimes(const ImportOptions& options, const io::ScanFolder& folder) {
  for (const io::ScanEntry& scan : folder.scans)
    if (!isTimeInSeconds(scan.time))
      throw Error(options.input.string() + ": " + scan.cloud.filename().string() +
                  " has the time " + io::significant(scan.time, 17) +
                  "; seconds from 0 to 1e11 are allowed (larger ones look like milli-, micro- or "
                  "nanoseconds)");
}

/// Times in other units pass for seconds; no LiDAR is so slow.
std::optional<std::string> slowNote(const io::ScanFolder& folder) {
  constexpr double kSlow = 5;  // s
  std::vector<double> steps;
  for (std::size_t i = 1; i < folder.scans.size(); ++i)
    steps.push_back(folder.scans[i].time - folder.scans[i - 1].time);
  const auto middle = quantile(steps, 0.5);
  if (!middle || *middle < kSlow) return std::nullopt;
  return "scans are " + io::significant(*middle, 4) + " s apart (median): times must be in seconds";
}

void checkSelection(const ImportOptions& options, const io::ScanFolder& folder) {
  const std::string where = options.input.string() + ": ";
  if (const std::size_t last = folder.scans.back().number; options.offset > last)
    throw Error(where + "--offset " + std::to_string(options.offset) +
                " leaves no scan; there are " + std::to_string(last + 1) + ", numbered from 0");
  if (options.odometryNoise && !folder.scans.front().T_map_robot)
    throw Error(where +
                "--odometry-noise needs true poses, and there are none; --poses gives some");
}

bool selected(std::size_t index, const ImportOptions& options) {
  return index >= options.offset && (index - options.offset) % options.every == 0;
}

/// The truth goes beside the rawlog, whatever it is called.
std::filesystem::path truthBeside(std::filesystem::path rawlog) {
  return rawlog.replace_extension(".tum");
}

ScanTiming timingOf(const ImportOptions& options, const io::ScanFolder& folder) {
  if (options.timing) return *options.timing;
  const auto file = timingFile(options);
  if (std::filesystem::exists(file)) return timingInFile(file.string());
  return folder.timing.turn != Turn::automatic ? folder.timing : datasetTiming(options.dataset);
}

/// Poses in a camera's frame move along z, as no vehicle does.
std::optional<std::string> climbNote(const std::vector<io::StampedPose3D>& truth) {
  Eigen::AlignedBox3d box;
  for (const auto& stamped : truth) box.extend(stamped.pose.translation());
  constexpr double kSteep = 0.2;  // no street climbs so much as a whole
  if (box.isEmpty() || box.sizes().z() < 5 ||
      box.sizes().z() < kSteep * box.sizes().head<2>().norm())
    return std::nullopt;
  return "the true poses span " + io::fixed(box.sizes().z(), 1) + " m in z and " +
         io::fixed(box.sizes().head<2>().norm(), 1) +
         " m in x and y: z must point up, so these may be in the frame of a camera, or those of "
         "the LiDAR where the camera's are expected (--poses FILE.tum --poses-of sensor)";
}

/// Both files appear together, when both are complete.
void publish(RawlogWriter& rawlog, std::optional<io::AtomicFile>& truthFile,
             const std::vector<io::StampedPose3D>& truth) {
  io::AtomicFiles together;
  if (truthFile) io::writeTum(*truthFile, truth);
  rawlog.commit();
  together.commit();
}

}  // namespace

void ImportOptions::validate() const {
  if (every < 1) throw Error("--every 0 takes no scan: a number from 1 on is allowed");
  if (odometryNoise && !(*odometryNoise >= 0 && std::isfinite(*odometryNoise)))
    throw Error("--odometry-noise " + io::significant(*odometryNoise, 6) +
                ": a share of 0 or more is allowed, such as 0.02 for 2 %");
  if ((odometryScale != 0 || odometryYaw != 0) && !odometryNoise)
    throw Error(
        "--odometry-scale and --odometry-yaw-deg-m change the odometry that "
        "--odometry-noise makes: give that as well (0 for none)");
  if (!(std::abs(odometryScale) <= 0.5) || !(std::abs(odometryYaw) <= 10 * degree))
    throw Error("--odometry-scale must lie in -0.5 to 0.5, --odometry-yaw-deg-m in -10 to 10");
  const auto extension = output.extension();
  if (extension != ".rawlog")
    throw Error("--output " + output.string() +
                ": the name must end in .rawlog (the truth goes beside it as .tum)");
}

Eigen::Isometry3d datasetSensorPose(Dataset dataset) {
  if (dataset == Dataset::nclt) return io::ncltRobotBody();
  if (dataset == Dataset::mulran) return io::mulranBaseLidar();
  return Eigen::Isometry3d::Identity();
}

ScanTiming datasetTiming(Dataset dataset) {
  switch (dataset) {
    case Dataset::kittiOdometry:
    case Dataset::nclt:
      return {Turn::compensated};
    case Dataset::kittiRaw:  // begins at the back, stamped when it faces forward
      return {Turn::clockwise, 0.1, M_PI, 0.5};
    case Dataset::mulran:  // begins at the plug, which points backwards: along x of the clouds
      return {Turn::clockwise, 0.1, 0, 0};
    case Dataset::folder:
    case Dataset::pcd:
    case Dataset::rosbag2:
      break;
  }
  return {};
}

ImportReport importDataset(const ImportOptions& options,
                           const std::function<void(std::size_t, std::size_t)>& progress) {
  options.validate();
  RawlogWriter rawlog(options.output.string());  // throws before the long work, not after it
  Eigen::Isometry3d T_robot_sensor =
      options.T_robot_sensor.value_or(datasetSensorPose(options.dataset));
  auto folder = readDataset(options, T_robot_sensor, progress);
  for (std::size_t i = 0; i < folder.scans.size(); ++i) folder.scans[i].number = i;
  if (folder.T_robot_sensor) T_robot_sensor = *folder.T_robot_sensor;
  const auto robotIn = [&](bool sensor) {
    return sensor ? T_robot_sensor.inverse() : Eigen::Isometry3d::Identity();
  };
  if (options.poses) io::takeTumPoses(folder, *options.poses, robotIn(options.posesOfSensor));
  if (options.odometry)
    io::takeTumMotions(folder, *options.odometry, robotIn(options.odometryOfSensor));
  checkTimes(options, folder);
  checkSelection(options, folder);

  ImportReport report;
  report.notes = folder.notes;
  if (const auto note = slowNote(folder)) report.notes.push_back(*note);
  report.embedded = options.embed || folder.read;
  std::optional<io::AtomicFile> truthFile;
  if (folder.scans.front().T_map_robot) truthFile.emplace(truthBeside(options.output));
  std::vector<io::StampedPose3D> truth;
  MotionSource motions(options);
  GnssWriter gnss(rawlog, gnssObservations(folder));
  if (const ScanTiming timing = timingOf(options, folder); timing.turn != Turn::automatic)
    rawlog.writeComment(timingComment(timing), folder.scans.front().time);
  for (std::size_t i = 0; i < folder.scans.size(); ++i) {
    const auto& scan = folder.scans[i];
    motions.pass(scan);
    if (progress) progress(i, folder.scans.size());
    if (!selected(scan.number, options)) {
      ++report.skipped;
      continue;
    }
    const auto observation = makeObservation(folder, scan, T_robot_sensor, options, report);
    if (!observation) {
      ++report.emptyScans;
      continue;
    }
    const auto motion = motions.take(scan);
    if (report.scans > 0 && motion) report.hasMotion = true;
    gnss.writeBefore(observation->timestamp);
    rawlog.write(makeActions(motion, observation->timestamp), observation);
    // The time as the rawlog keeps it (steps of 100 ns), so that both files agree to the digit.
    const double time = mrpt::Clock::toDouble(observation->timestamp);
    if (scan.T_map_robot) truth.push_back({time, *scan.T_map_robot});
    ++report.scans;
  }
  if (report.scans == 0)
    throw Error(options.input.string() + ": no usable scan, all " +
                std::to_string(report.emptyScans) + " selected ones are empty" +
                (report.damagedScans > 0 ? " or damaged" : ""));
  gnss.writeRest();
  publish(rawlog, truthFile, truth);
  if (const auto note = climbNote(truth)) report.notes.push_back(*note);
  report.hasTruth = truthFile.has_value();
  return report;
}

Eigen::Isometry3d parseSensorPose(const std::string& text) {
  std::vector<double> values;
  for (const std::string& word : io::wordsOf(text)) {
    const auto value = io::parseNumber(word);
    if (!value || !std::isfinite(*value)) throw Error("`" + word + "` is not a number");
    values.push_back(*value);
  }
  if (values.size() != 6)
    throw Error("six numbers are needed, \"x y z yaw_deg pitch_deg roll_deg\", not " +
                std::to_string(values.size()));
  return io::poseFromAngles({values[0], values[1], values[2]}, values[5] * degree,
                            values[4] * degree, values[3] * degree);
}

}  // namespace polemcl::apps
