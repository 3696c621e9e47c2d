#include "io/dataset/KittiRaw.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <utility>

#include "core/common/Angles.h"
#include "io/data/Trajectory.h"
#include "io/dataset/ScanFiles.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

constexpr double kEarthRadius = 6378137;  ///< m, as in the devkit
constexpr std::size_t kOxtsFields = 30;
constexpr double kLeastFixSigma = 0.02;  ///< m

/// Times of the frames with these numbers. Lines are selected by frame number, or in order if the
/// file has exactly one line per existing frame.
std::vector<double> readStamps(const fs::path& file, const std::vector<std::uint64_t>& numbers) {
  std::vector<std::string> lines = readLines(file);
  const auto blank = [](const std::string& line) { return trimmed(line).empty(); };
  while (!lines.empty() && blank(lines.back())) lines.pop_back();
  const bool byNumber = lines.size() > numbers.back();
  const bool inOrder =
      lines.size() == numbers.size() && std::none_of(lines.begin(), lines.end(), blank);
  if (!byNumber && !inOrder) {
    throw Error(file.string() + ": " + std::to_string(lines.size()) + " times for " +
                std::to_string(numbers.size()) + " frames up to number " +
                std::to_string(numbers.back()));
  }
  std::vector<double> times;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t line = byNumber ? numbers[i] : i;
    times.push_back(parseKittiTime(lines[line], at(file, line + 1)));
  }
  return times;
}

OxtsPose readOxts(const fs::path& file) {
  const auto rows = readNumberRows(file, kOxtsFields, "lat lon alt roll pitch yaw … of one frame");
  if (rows.size() != 1) {
    throw Error(file.string() + ": " + std::to_string(rows.size()) +
                " lines of numbers, 1 expected");
  }
  const std::vector<double>& v = rows.front().values;
  if (std::abs(v[0]) >= 90 || std::abs(v[1]) > 180) {
    throw Error(at(file, rows.front().line) + "latitude " + significant(v[0], 12) + ", longitude " +
                significant(v[1], 12) + " are out of range");
  }
  return {v[0], v[1], v[2], v[3], v[4], v[5], v[23]};
}

/// Pose of the IMU in the LiDAR frame, from the lines "R: nine numbers" and "T: three numbers".
Eigen::Isometry3d readImuInLidar(const fs::path& file) {
  std::map<std::string, std::vector<double>> fields;
  const auto lines = readLines(file);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    const auto colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string key(trimmed(line.substr(0, colon)));
    if (key == "R" || key == "T") fields[key] = parseNumbers(line.substr(colon + 1), file, i + 1);
  }
  const auto &r = fields["R"], &t = fields["T"];
  if (r.size() != 9 || t.size() != 3) {
    throw Error(file.string() + ": lines R: with nine and T: with three numbers expected, " +
                std::to_string(r.size()) + " and " + std::to_string(t.size()) + " found");
  }
  return poseFromRows({r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2]},
                      file.string() + ": ");
}

/// Scans and oxts frames by number.
struct Drive {
  std::vector<fs::path> scans;
  std::vector<std::uint64_t> scanNumbers, oxtsNumbers;
  std::vector<double> scanTimes;
  std::map<std::uint64_t, fs::path> oxts;
};

std::vector<std::uint64_t> missingFrom(const std::vector<std::uint64_t>& all,
                                       const std::vector<std::uint64_t>& some) {
  std::vector<std::uint64_t> missing;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(),
                      std::back_inserter(missing));
  return missing;
}

Drive listDrive(const fs::path& folder, std::vector<std::string>& notes) {
  Drive drive;
  const fs::path scans = folder / "velodyne_points" / "data";
  if (!fs::is_directory(scans))
    throw Error(folder.string() +
                ": no folder velodyne_points/data in it; name the folder of one drive, such as "
                "2011_09_26_drive_0009_sync");
  drive.scans = listFiles(scans, ".bin");
  const auto oxtsFiles = listFiles(folder / "oxts" / "data", ".txt");
  drive.scanNumbers = fileNumbers(drive.scans);
  drive.oxtsNumbers = fileNumbers(oxtsFiles);
  for (std::size_t i = 0; i < oxtsFiles.size(); ++i) {
    drive.oxts[drive.oxtsNumbers[i]] = oxtsFiles[i];
  }
  checkScanSizes(drive.scans, notes);
  drive.scanTimes = readStamps(folder / "velodyne_points" / "timestamps.txt", drive.scanNumbers);
  for (std::size_t i = 1; i < drive.scanTimes.size(); ++i) {
    if (!(drive.scanTimes[i] > drive.scanTimes[i - 1])) {
      throw Error((folder / "velodyne_points" / "timestamps.txt").string() + ": the time of " +
                  "frame " + std::to_string(drive.scanNumbers[i]) + " is not after that of frame " +
                  std::to_string(drive.scanNumbers[i - 1]));
    }
  }
  const auto lost = missingFrom(drive.oxtsNumbers, drive.scanNumbers);
  const auto unplaced = missingFrom(drive.scanNumbers, drive.oxtsNumbers);
  if (!lost.empty()) notes.push_back("no scan for the oxts frames " + ranges(lost));
  if (!unplaced.empty()) {
    notes.push_back("left out, because they have no oxts frame: scans " + ranges(unplaced));
  }
  return drive;
}

/// Adds a note if a scan and its oxts frame differ in time by more than half a LiDAR revolution.
void noteOffsets(const fs::path& file, const Drive& drive, std::vector<std::string>& notes) {
  const auto times = readStamps(file, drive.oxtsNumbers);
  double worst = 0;
  std::uint64_t worstNumber = 0;
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    const auto found =
        std::lower_bound(drive.oxtsNumbers.begin(), drive.oxtsNumbers.end(), drive.scanNumbers[i]);
    if (found == drive.oxtsNumbers.end() || *found != drive.scanNumbers[i]) continue;
    const double offset = std::abs(times[found - drive.oxtsNumbers.begin()] - drive.scanTimes[i]);
    if (offset <= worst) continue;
    worst = offset;
    worstNumber = drive.scanNumbers[i];
  }
  if (worst <= 0.05) return;
  notes.push_back("scan and oxts frame are up to " + fixed(worst, 3) + " s apart (frame " +
                  std::to_string(worstNumber) + ")");
}

}  // namespace

Eigen::Isometry3d mercatorPose(const OxtsPose& measurement, double scale) {
  return poseFromAngles(
      {scale * kEarthRadius * measurement.longitude * degree,
       scale * kEarthRadius * std::log(std::tan(M_PI / 4 + measurement.latitude * degree / 2)),
       measurement.altitude},
      measurement.roll, measurement.pitch, measurement.yaw);
}

double parseKittiTime(std::string_view text, const std::string& where) {
  const std::string moment(trimmed(text));
  std::tm parts{};
  const char* const end = ::strptime(moment.c_str(), "%Y-%m-%d %H:%M:%S", &parts);
  const std::string tail = end == moment.c_str() + 19 ? end : "none";
  const int day = parts.tm_mday, second = std::exchange(parts.tm_sec, 0);
  const auto minute = static_cast<double>(::timegm(&parts));
  const bool isFraction = tail.size() > 1 && tail.front() == '.' &&
                          tail.find_first_not_of("0123456789", 1) == std::string::npos;
  // A day that does not exist has become another one.
  if (parts.tm_mday != day || second > 60 || !(tail.empty() || isFraction))
    throw Error(where + "'" + moment.substr(0, 40) +
                "' is not a time; expected: YYYY-MM-DD hh:mm:ss.fraction");
  return minute + second + *parseNumber("0" + tail);
}

ScanFolder readKittiRaw(const fs::path& drive, const fs::path& calibration,
                        const Eigen::Isometry3d& T_robot_sensor) {
  ScanFolder result;
  const Drive frames = listDrive(drive, result.notes);
  if (!isThere(calibration / "calib_imu_to_velo.txt"))
    throw Error(calibration.string() +
                ": no calib_imu_to_velo.txt in it; --calib names the folder of the calibration of "
                "that day");
  const Eigen::Isometry3d T_imu_robot =
      (T_robot_sensor * readImuInLidar(calibration / "calib_imu_to_velo.txt")).inverse();
  if (isThere(drive / "oxts" / "timestamps.txt")) {
    noteOffsets(drive / "oxts" / "timestamps.txt", frames, result.notes);
  }

  const OxtsPose first = readOxts(frames.oxts.begin()->second);
  const double scale = std::cos(first.latitude * degree);
  const Eigen::Isometry3d T_world_first = mercatorPose(first, scale);
  // Levelled: use only the heading of the first frame, so that the map's z axis points up.
  Eigen::Isometry3d T_world_map = spatial(planar(T_world_first));
  T_world_map.translation().z() = first.altitude;

  for (std::size_t i = 0; i < frames.scans.size(); ++i) {
    const auto oxts = frames.oxts.find(frames.scanNumbers[i]);
    if (oxts == frames.oxts.end()) continue;
    const OxtsPose measured = readOxts(oxts->second);
    result.scans.push_back({frames.scans[i], 0, frames.scanTimes[i],
                            T_world_map.inverse() * mercatorPose(measured, scale) * T_imu_robot});
    takeFix({frames.scanTimes[i], measured.latitude, measured.longitude,
             std::max(measured.accuracy, kLeastFixSigma),
             T_imu_robot.inverse().translation().head<2>()},
            result);
  }
  if (result.scans.empty()) {
    throw Error(drive.string() + ": no scan has the number of an oxts frame (scans " +
                ranges(frames.scanNumbers) + ", oxts " + ranges(frames.oxtsNumbers) + ")");
  }
  return result;
}

}  // namespace polemcl::io
