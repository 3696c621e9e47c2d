#include <polemcl/core/Types.h>
#include <polemcl/sim/Drive.h>
#include <polemcl/sim/LidarModel.h>
#include <polemcl/sim/Random.h>
#include <polemcl/sim/Scanner.h>
#include <polemcl/sim/Simulation.h>
#include <polemcl/sim/World.h>
#include <tbb/parallel_for.h>

#include <cstdio>
#include <fstream>
#include <mutex>

namespace polemcl::sim {
namespace {
namespace fs = std::filesystem;

/// \brief A file that complains when it could not be written.
class Output {
 public:
  explicit Output(fs::path path)
      : m_path(std::move(path)), m_stream(m_path, std::ios::binary | std::ios::trunc) {}
  void write(const void* data, std::size_t bytes) {
    m_stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  }
  /// \brief A line of numbers with enough digits to come back as they were.
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

void writeScan(const SimulatedScan& scan, const Eigen::Vector3f& origin, std::size_t index,
               const fs::path& directory) {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu", index);
  std::vector<float> points;
  points.reserve(4 * scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
    points.insert(points.end(), {scan.x[i] + origin.x(), scan.y[i] + origin.y(),
                                 scan.z[i] + origin.z(), scan.intensity[i]});
  Output cloud(directory / "velodyne" / (std::string(name) + ".bin"));
  cloud.write(points.data(), points.size() * sizeof(float));
  cloud.close();
  Output labels(directory / "labels" / (std::string(name) + ".label"));
  labels.write(scan.label.data(), scan.label.size() * sizeof(std::uint32_t));
  labels.close();
}

void writeDrive(const Drive& drive, const SimulationOptions& options, const fs::path& directory) {
  Output times(directory / "times.txt"), poses(directory / "poses.txt"),
      odometry(directory / "odometry.txt");
  odometry.line(
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
  times.close();
  poses.close();
  odometry.close();
}

void writePoles(const std::vector<TruePole>& poles, const fs::path& directory) {
  Output file(directory / "poles_gt.csv");
  file.line("id,x,y,radius,top,kind\n");
  for (const TruePole& pole : poles)
    file.line("%u,%.4f,%.4f,%.4f,%.3f,%s\n", pole.id, pole.x, pole.y, pole.radius, pole.top,
              name(pole.kind));
  file.close();
}

/// \brief Mean motion of the sensor about a scan, in its own frame.
Motion motionAt(const Drive& drive, std::size_t i) {
  const std::size_t from = i == 0 ? 0 : i - 1, to = std::min(i + 1, drive.time.size() - 1);
  const Eigen::Isometry3d step = drive.T_map_sensor[from].inverse() * drive.T_map_sensor[to];
  const double duration = drive.time[to] - drive.time[from];
  Motion motion;
  motion.velocity = step.translation() / duration;
  motion.yawRate = std::atan2(step.linear()(1, 0), step.linear()(0, 0)) / duration;
  return motion;
}
}  // namespace

SimulationSummary simulate(const SimulationOptions& options, const fs::path& directory,
                           const std::function<void(std::size_t, std::size_t)>& progress) {
  options.validate();
  const World world = makeWorld(options.world);
  const Drive drive = makeDrive(world, options);
  const Scanner scanner(world, makeLidar(options.sensor, options.upsideDown));
  std::error_code failure;
  for (const char* folder : {"velodyne", "labels"})
    fs::create_directories(directory / folder, failure);
  if (failure) throw Error(directory.string() + ": " + failure.message());
  writeDrive(drive, options, directory);
  writePoles(world.poles(), directory);

  const Eigen::Vector3f origin =
      Eigen::Vector3d(options.originX, options.originY, options.originZ).cast<float>();
  SimulationSummary summary;
  summary.scans = drive.time.size();
  summary.poles = world.poles().size();
  summary.length = options.spacing * static_cast<double>(drive.time.size() - 1);
  std::vector<std::size_t> points(drive.time.size());
  std::size_t done = 0;
  std::mutex mutex;
  tbb::parallel_for(std::size_t{0}, drive.time.size(), [&](std::size_t i) {
    const std::uint64_t seed = hash(options.world.seed, options.world.day, 0x5ca4ull, i);
    const Motion motion = options.motionDistortion ? motionAt(drive, i) : Motion{};
    const SimulatedScan scan = scanner.scan(drive.T_map_sensor[i], seed, drive.time[i], motion);
    writeScan(scan, origin, i, directory);
    points[i] = scan.size();
    const std::lock_guard lock(mutex);
    if (progress) progress(++done, drive.time.size());
  });
  for (const std::size_t count : points) summary.points += count;
  return summary;
}

}  // namespace polemcl::sim
