#include "sim/drive/Simulation.h"

#include <tbb/parallel_for.h>

#include <cstdio>
#include <fstream>
#include <mutex>

#include <polemcl/core/common/Types.h>
#include "config/TimingComment.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "sim/lidar/LidarModel.h"

namespace polemcl::sim {
namespace {
namespace fs = std::filesystem;

/// \brief A file that reports failed writes.
class Output {
 public:
  explicit Output(fs::path path)
      : m_path(std::move(path)), m_stream(m_path, std::ios::binary | std::ios::trunc) {}
  void write(const void* data, std::size_t bytes) {
    m_stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  }
  /// \brief A line of numbers.
  template <class... Numbers>
  void line(const char* format, Numbers... numbers) {
    char text[512];
    const int length = std::snprintf(text, sizeof text, format, numbers...);
    write(text, static_cast<std::size_t>(length));
  }
  void close() {
    m_stream.close();
    if (m_stream.fail())
      throw Error(m_path.string() +
                  ": cannot be written; is the disk full or the folder read-only?");
  }

 private:
  fs::path m_path;
  std::ofstream m_stream;
};

void writeDrive(const Drive& drive, const SimulationOptions& options, const LidarModel& lidar,
                const fs::path& directory) {
  Output times(directory / "times.txt"), poses(directory / "poses.txt"),
      odometry(directory / "odometry.txt");
  odometry.line(
      "%s",
      "# dx dy dyaw sx sy syaw: motion since the scan before, in its frame (m, m, rad), and "
      "standard deviations\n");
  for (std::size_t i = 0; i < drive.time.size(); ++i) {
    times.line("%.6f\n", drive.time[i]);
    const Eigen::Isometry3d pose = cloudFrame(drive.T_map_sensor[i], options);
    const auto& matrix = pose.matrix();
    for (int row = 0; row < 3; ++row)
      poses.line("%.9f %.9f %.9f %.9f%s", matrix(row, 0), matrix(row, 1), matrix(row, 2),
                 matrix(row, 3), row == 2 ? "\n" : " ");
    if (i == 0) continue;
    const OdometryStep& step = drive.odometry[i - 1];
    odometry.line("%.9f %.9f %.9f %.3e %.3e %.3e\n", step.dx, step.dy, step.dyaw, step.sx, step.sy,
                  step.syaw);
  }
  if (options.motionDistortion) {
    const std::string text = timingComment(timingOf(lidar));
    Output timing(directory / "scan_timing.ini");
    timing.write(text.data(), text.size());
    timing.close();
  }
  times.close();
  poses.close();
  odometry.close();
}

/// \brief Mean motion of the sensor around a scan, in its own frame.
Motion motionAt(const Drive& drive, std::size_t i) {
  const std::size_t from = i == 0 ? 0 : i - 1, to = std::min(i + 1, drive.time.size() - 1);
  const auto& T = drive.T_map_sensor;
  const Eigen::Isometry3d step = T[from].inverse() * T[to];
  const double duration = drive.time[to] - drive.time[from];
  Motion motion;
  motion.velocity =
      T[i].linear().transpose() * (T[to].translation() - T[from].translation()) / duration;
  motion.yawRate = std::atan2(step.linear()(1, 0), step.linear()(0, 0)) / duration;
  return motion;
}
}  // namespace

SimulatedDrive::SimulatedDrive(const SimulationOptions& options, const SensorOptions& beams)
    : m_options((options.validate(), options)),
      m_lidar(makeLidar(options, beams)),
      m_world(makeWorld(options.world)),
      m_drive(makeDrive(m_world, options)),
      m_scanner(m_world, m_lidar) {}

double SimulatedDrive::length() const {
  return m_options.spacing * static_cast<double>(scans() - 1);
}

SimulatedScan SimulatedDrive::scan(std::size_t i) const {
  const WorldOptions& world = m_options.world;
  const std::uint64_t seed = driveSeed(m_options, hash(world.seed, world.day, 0x5ca4ull, i));
  const Motion motion = m_options.motionDistortion ? motionAt(m_drive, i) : Motion{};
  SimulatedScan scan = m_scanner.scan(m_drive.T_map_sensor[i], seed, motion);
  const Eigen::Vector3f origin =
      Eigen::Vector3d(m_options.originX, m_options.originY, m_options.originZ).cast<float>();
  for (std::size_t k = 0; k < scan.size(); ++k) {
    scan.x[k] += origin.x();
    scan.y[k] += origin.y();
    scan.z[k] += origin.z();
  }
  return scan;
}

ScanFolderWriter::ScanFolderWriter(const SimulatedDrive& drive, const fs::path& directory)
    : m_directory(directory) {
  std::error_code failure;
  for (const char* folder : {"velodyne", "labels"})
    fs::create_directories(directory / folder, failure);
  if (failure) throw Error(directory.string() + ": " + failure.message());
  writeDrive(drive.drive(), drive.options(), drive.lidar(), directory);
  writeTruePoles(directory / "poles_gt.csv", drive.world().poles());
}

void ScanFolderWriter::write(std::size_t i, const SimulatedScan& scan) const {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu", i);
  std::vector<float> points;
  points.reserve(4 * scan.size());
  for (std::size_t k = 0; k < scan.size(); ++k)
    points.insert(points.end(), {scan.x[k], scan.y[k], scan.z[k], scan.intensity[k]});
  Output cloud(m_directory / "velodyne" / (std::string(name) + ".bin"));
  cloud.write(points.data(), points.size() * sizeof(float));
  cloud.close();
  Output labels(m_directory / "labels" / (std::string(name) + ".label"));
  labels.write(scan.label.data(), scan.label.size() * sizeof(std::uint32_t));
  labels.close();
}

void writeTruePoles(const fs::path& file, const std::vector<TruePole>& poles) {
  io::AtomicFile out(file);
  out.stream() << "id,x,y,radius,top,kind\n";
  for (const TruePole& pole : poles)
    out.stream() << pole.id << ',' << io::fixed(pole.x, 4) << ',' << io::fixed(pole.y, 4) << ','
                 << io::fixed(pole.radius, 4) << ',' << io::fixed(pole.top, 3) << ','
                 << name(pole.kind) << '\n';
  out.commit();
}

SimulationSummary simulate(const SimulationOptions& options, const fs::path& directory,
                           const std::function<void(std::size_t, std::size_t)>& progress,
                           const SensorOptions& beams) {
  const SimulatedDrive drive(options, beams);
  const ScanFolderWriter folder(drive, directory);
  SimulationSummary summary;
  summary.scans = drive.scans();
  summary.poles = drive.world().poles().size();
  summary.length = drive.length();
  std::vector<std::size_t> points(drive.scans());
  std::size_t done = 0;
  std::mutex mutex;
  tbb::parallel_for(std::size_t{0}, drive.scans(), [&](std::size_t i) {
    const SimulatedScan scan = drive.scan(i);
    folder.write(i, scan);
    points[i] = scan.size();
    const std::lock_guard lock(mutex);
    if (progress) progress(++done, drive.scans());
  });
  for (const std::size_t count : points) summary.points += count;
  return summary;
}

}  // namespace polemcl::sim
