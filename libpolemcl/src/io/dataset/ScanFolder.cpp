#include "io/dataset/ScanFolder.h"

#include <algorithm>
#include <cmath>

#include "io/data/PcdFile.h"
#include "io/data/Trajectory.h"
#include "io/dataset/ScanFiles.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

constexpr double kNominalPeriod = 0.1;  ///< period of scans without times, s

/// The scans of a folder, with what is needed to assign rows to them.
struct Scans {
  std::vector<fs::path> files;
  std::string place;              ///< where the scans are, for messages
  bool numberedFromZero = false;  ///< names are 0, 1, 2, …: row i belongs to scan i
};

Scans listScans(const fs::path& folder, const std::string& ending, const std::string& place) {
  Scans scans{listFiles(folder, ending), place, true};
  for (std::size_t i = 0; i < scans.files.size(); ++i) {
    scans.numberedFromZero = scans.numberedFromZero && fileNumber(scans.files[i]) == i;
  }
  return scans;
}

/// The time that a name is, s: seconds since 1970 with a fraction, or whole ms, us or ns.
std::optional<double> timeOfName(const std::string& name) {
  constexpr double kEarliest = 1e8, kLatest = 1e10;
  if (name.find_first_not_of("0123456789.") != std::string::npos) return std::nullopt;
  const auto number = parseNumber(name);
  if (!number) return std::nullopt;
  double time = *number;
  if (name.find('.') == std::string::npos)
    time *= name.size() == 13 ? 1e-3 : name.size() == 16 ? 1e-6 : name.size() == 19 ? 1e-9 : 0;
  return time > kEarliest && time < kLatest ? std::optional(time) : std::nullopt;
}

/// Takes the names of the scans as their times, if all are times, and later ones later.
bool takeTimesOfNames(const Scans& scans, ScanFolder& folder) {
  std::vector<double> times;
  for (const fs::path& file : scans.files) {
    const auto time = timeOfName(file.stem().string());
    if (!time || (!times.empty() && *time <= times.back())) return false;
    times.push_back(*time);
  }
  for (std::size_t i = 0; i < times.size(); ++i) folder.scans[i].time = times[i];
  folder.notes.push_back("no times.txt: the names of the files are their times");
  return true;
}

/// What the numbers of the scans say against equal times; empty if they are in turn.
std::string gapOfNumbers(const Scans& scans) {
  for (std::size_t i = 1; i < scans.files.size(); ++i) {
    const auto before = fileNumber(scans.files[i - 1]), number = fileNumber(scans.files[i]);
    if (before && number && *number != *before + 1)
      return ", though numbers are missing, first between " +
             scans.files[i - 1].filename().string() + " and " + scans.files[i].filename().string() +
             ": wrong times spoil the correction of moving scans and the poles' motion. If all "
             "were recorded 0.1 s apart, write times.txt with 0.1 times the number of each";
  }
  return {};
}

/// Checks for one row per scan, or per scan after the first. Throws on fewer rows. More rows give a
/// note, or an error if the assignment is ambiguous.
void checkCount(const fs::path& file, const std::string& what, std::size_t got,
                std::size_t expected, const Scans& scans, std::vector<std::string>& notes) {
  const std::string counts = std::to_string(got) + " " + what + " for " +
                             std::to_string(scans.files.size()) + " scans" + scans.place;
  if (got < expected) {
    throw Error(file.string() + ": " + counts + ", " + std::to_string(expected) +
                " expected; take away the scans that have none");
  }
  if (got == expected) return;
  // As many motions as scans: more likely a list with an extra first row than a list that is too
  // long.
  const bool shifted = expected + 1 == scans.files.size() && got == scans.files.size();
  if (shifted || !scans.numberedFromZero) {
    throw Error(file.string() + ": " + counts + ", " + std::to_string(expected) +
                " expected; which belongs to which scan is not clear" +
                (shifted ? " (the first line is the motion to the second scan)"
                         : " (scans are not numbered 0, 1, 2, …)"));
  }
  notes.push_back(file.filename().string() + ": " + counts + "; the last " +
                  std::to_string(got - expected) + " are not used");
}

void readTimes(const fs::path& file, const Scans& scans, ScanFolder& folder) {
  if (!isThere(file))
    throw Error(file.string() +
                ": No such file or directory; it must give the time of each scan, s, one a line");
  const auto rows = readNumberRows(file, 1, "one time a line, s");
  checkCount(file, "times", rows.size(), scans.files.size(), scans, folder.notes);
  requireIncreasing(file, rows);
  for (std::size_t i = 0; i < folder.scans.size(); ++i) folder.scans[i].time = rows[i].values[0];
}

void readPoses(const fs::path& file, const Eigen::Isometry3d& T_robot_sensor, const Scans& scans,
               ScanFolder& folder) {
  const auto T_map_sensor = readKittiPoses(file);
  checkCount(file, "poses", T_map_sensor.size(), scans.files.size(), scans, folder.notes);
  const Eigen::Isometry3d T_sensor_robot = T_robot_sensor.inverse();
  for (std::size_t i = 0; i < folder.scans.size(); ++i) {
    folder.scans[i].T_map_robot = T_map_sensor[i] * T_sensor_robot;
  }
}

PoseWithCovariance motionFromRow(const fs::path& file, const NumberRow& row) {
  const std::vector<double>& v = row.values;
  for (int i = 3; i < 6; ++i) {
    if (v[i] < 0) {
      throw Error(at(file, row.line) + "standard deviation " + significant(v[i], 9) +
                  " is negative; expected: dx dy dyaw sx sy syaw");
    }
  }
  // Tolerance for a half turn that was rounded up.
  if (std::abs(v[2]) > M_PI + 1e-3) {
    throw Error(at(file, row.line) + "turn of " + significant(v[2], 9) +
                " rad between two scans; radians within -pi ... pi are expected");
  }
  PoseWithCovariance motion;
  motion.mean = {v[0], v[1], wrapAngle(v[2])};
  motion.covariance = Eigen::Vector3d(v[3] * v[3], v[4] * v[4], v[5] * v[5]).asDiagonal();
  return motion;
}

void readOdometry(const fs::path& file, const Scans& scans, ScanFolder& folder) {
  const auto rows = readNumberRows(file, 6, "dx dy dyaw sx sy syaw (m, m, rad)");
  checkCount(file, "motions", rows.size(), scans.files.size() - 1, scans, folder.notes);
  for (std::size_t i = 1; i < folder.scans.size(); ++i) {
    folder.scans[i].motion = motionFromRow(file, rows[i - 1]);
  }
}

void addScans(const Scans& scans, ScanFolder& folder) {
  for (const fs::path& file : scans.files) folder.scans.push_back({file});
}

/// Reads true poses and odometry, if the files exist.
void readMotions(const fs::path& folder, const Eigen::Isometry3d& T_robot_sensor,
                 const Scans& scans, ScanFolder& result) {
  if (isThere(folder / "poses.txt")) {
    readPoses(folder / "poses.txt", T_robot_sensor, scans, result);
  }
  if (isThere(folder / "odometry.txt")) {
    readOdometry(folder / "odometry.txt", scans, result);
  }
}

}  // namespace

ScanFolder readScanFolder(const fs::path& folder, const Eigen::Isometry3d& T_robot_sensor) {
  if (!fs::is_directory(folder / "velodyne"))
    throw Error(folder.string() +
                ": no folder velodyne in it, for *.bin; *.pcd are read by "
                "`pole-import pcd`");
  const Scans scans = listScans(folder / "velodyne", ".bin", " in velodyne/");
  ScanFolder result;
  checkScanSizes(scans.files, result.notes);
  addScans(scans, result);
  readTimes(folder / "times.txt", scans, result);
  readMotions(folder, T_robot_sensor, scans, result);
  return result;
}

ScanFolder readPcdFolder(const fs::path& folder, const Eigen::Isometry3d& T_robot_sensor) {
  const Scans scans = listScans(folder, ".pcd", "");
  ScanFolder result;
  result.read = [](const ScanEntry& entry) { return readPcd(entry.cloud); };
  checkScanSizes(scans.files, result.notes, {1, "bytes"});  // any size
  addScans(scans, result);
  if (isThere(folder / "times.txt")) {
    readTimes(folder / "times.txt", scans, result);
  } else if (!takeTimesOfNames(scans, result)) {
    for (std::size_t i = 0; i < result.scans.size(); ++i)
      result.scans[i].time = kNominalPeriod * static_cast<double>(i);
    result.nominalTimes = true;
    result.notes.push_back("no times.txt: scans are assumed to be 0.1 s apart" +
                           gapOfNumbers(scans));
  }
  readMotions(folder, T_robot_sensor, scans, result);
  return result;
}

void takeFix(const GnssFix& fix, ScanFolder& folder) {
  if (isOnGlobe(fix) && std::isfinite(fix.time)) folder.fixes.push_back(fix);
}

void finishFixes(const std::string& source, ScanFolder& folder) {
  std::stable_sort(folder.fixes.begin(), folder.fixes.end(),
                   [](const GnssFix& a, const GnssFix& b) { return a.time < b.time; });
  folder.notes.push_back(source + ": " + std::to_string(folder.fixes.size()) +
                         " positions from satellites");
}

}  // namespace polemcl::io
