#include "io/dataset/Mulran.h"

#include <algorithm>
#include <cmath>

#include "core/common/Angles.h"
#include "io/data/Trajectory.h"
#include "io/dataset/ScanFiles.h"
#include "io/dataset/ScanPoses.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

/// Path in the folder or in its sensor_data/; empty if the file is in neither.
fs::path findIn(const fs::path& sequence, const std::string& name) {
  const fs::path here = existing(sequence / name);
  return here.empty() ? existing(sequence / "sensor_data" / name) : here;
}

/// Converts nanoseconds to seconds. The whole seconds are converted separately: a double cannot
/// hold all digits of the nanoseconds.
double seconds(std::uint64_t nanoseconds) {
  constexpr std::uint64_t kSecond = 1000000000;
  const std::uint64_t whole = nanoseconds / kSecond;
  return static_cast<double>(whole) + static_cast<double>(nanoseconds % kSecond) * 1e-9;
}

void addMulranTruth(const fs::path& file, const Eigen::Isometry3d& T_base_robot,
                    ScanFolder& result) {
  TrackSampler track(timesOf(result), kTrackGap);
  NumberRowReader rows(file, 13, "time in ns, the vehicle's pose as row-major 3x4 matrix [R|t], m",
                       Separator::commas);
  std::vector<double> row, matrix;
  std::size_t unused = 0;
  while (rows.next(row)) {
    matrix.assign(row.begin() + 1, row.end());
    if (!allFinite(row) ||
        !track.add(row[0] * 1e-9, poseFromRows(matrix, rows.at()) * T_base_robot))
      ++unused;
  }
  noteUnusedRows(unused, file, result.notes);
  takePoses(result, track, file, "truth", "at times without truth");
}

void addMulranFixes(const fs::path& file, ScanFolder& result) {
  NumberRowReader rows(file, 13, "time in ns, latitude, longitude, altitude, 3x3 covariance",
                       Separator::commas);
  std::vector<double> row;
  while (rows.next(row)) {
    GnssFix fix;
    fix.time = row[0] * 1e-9;
    fix.latitude = row[1];
    fix.longitude = row[2];
    const double variance = (row[4] + row[8]) / 2;
    fix.sigma = variance > 0 && std::isfinite(variance) ? std::sqrt(variance) : kAssumedFixSigma;
    takeFix(fix, result);
  }
  finishFixes(file.filename().string(), result);
}

/// Adds a note about scans that were recorded but are missing in the folder.
void noteMissing(const fs::path& file, const std::vector<std::uint64_t>& names,
                 ScanFolder& result) {
  const auto lines = readLines(file);
  std::size_t missing = 0, all = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view word = trimmed(lines[i]);
    if (word.empty()) continue;
    const auto stamp = fileNumber(fs::path(std::string(word) + ".bin"));
    if (!stamp)
      throw Error(at(file, i + 1) + "'" + std::string(word.substr(0, 40)) +
                  "' is not a time; expected: one time in ns a line");
    ++all;
    if (!std::binary_search(names.begin(), names.end(), *stamp)) ++missing;
  }
  if (missing > 0)
    result.notes.push_back(file.filename().string() + ": " + std::to_string(missing) + " of its " +
                           std::to_string(all) + " times have no scan in Ouster/");
}

}  // namespace

Eigen::Isometry3d mulranBaseLidar() {
  return poseFromAngles({1.7042, -0.021, 1.8047}, 0.0001 * degree, 0.0003 * degree,
                        179.6654 * degree);
}

ScanFolder readMulran(const fs::path& sequence, const Eigen::Isometry3d& T_robot_lidar) {
  const fs::path ouster = findIn(sequence, "Ouster");
  const auto files = listFiles(ouster.empty() ? sequence / "Ouster" : ouster, ".bin");
  const auto names = fileNumbers(files);
  ScanFolder result;
  checkScanSizes(files, result.notes);
  for (std::size_t i = 0; i < files.size(); ++i)
    result.scans.push_back({files[i], 0, seconds(names[i])});
  const fs::path stamps = findIn(sequence, "ouster_front_stamp.csv");
  if (!stamps.empty()) noteMissing(stamps, names, result);
  const fs::path truth = findIn(sequence, "global_pose.csv");
  if (!truth.empty())
    addMulranTruth(truth, mulranBaseLidar() * T_robot_lidar.inverse(), result);
  else
    result.notes.push_back("no global_pose.csv");
  const fs::path gps = findIn(sequence, "gps.csv");
  if (!gps.empty()) addMulranFixes(gps, result);
  return result;
}

}  // namespace polemcl::io
