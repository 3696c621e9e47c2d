#include "io/dataset/Nclt.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "io/dataset/NcltFiles.h"
#include "io/dataset/NcltGps.h"
#include "io/dataset/NcltOdometry.h"
#include "io/dataset/ScanFiles.h"
#include "io/dataset/ScanPoses.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

using Turns = std::vector<NcltTurn>;
using TurnMotions = std::vector<std::optional<TurnMotion>>;

void addSync(const fs::path& folder, ScanFolder& result) {
  const auto files = listFiles(folder, ".bin");
  const auto numbers = fileNumbers(files);
  checkScanSizes(files, result.notes, {8, "uint16 x y z, uint8 intensity, laser"});
  for (std::size_t i = 0; i < files.size(); ++i)
    result.scans.push_back({files[i], 0, static_cast<double>(numbers[i]) * 1e-6});
  result.read = [](const ScanEntry& entry) { return readNcltSync(entry.cloud); };
}

/// Times at which the body's pose is needed: three per revolution, or one per scan.
std::vector<double> wantedTimes(const ScanFolder& folder, const Turns& turns) {
  if (turns.empty()) return timesOf(folder);
  std::vector<double> times;
  for (const NcltTurn& turn : turns)
    for (const double time : {turn.begin, turn.middle, turn.end}) times.push_back(time);
  // The last packet of a revolution may have a later time stamp than the first packet of the next
  // one.
  for (std::size_t i = 1; i < times.size(); ++i) times[i] = std::max(times[i], times[i - 1]);
  return times;
}

/// Installs a reader for the revolutions of `file`. Each one is identified by its byte offset.
void readTurns(Turns turns, TurnMotions motions, ScanFolder& result) {
  struct Known {
    Turns turns;
    TurnMotions motions;
  };
  const auto known = std::make_shared<const Known>(Known{std::move(turns), std::move(motions)});
  result.read = [known](const ScanEntry& entry) {
    const auto& all = known->turns;
    const auto turn =
        std::lower_bound(all.begin(), all.end(), entry.offset,
                         [](const NcltTurn& t, std::uint64_t offset) { return t.offset < offset; });
    const auto index = static_cast<std::size_t>(turn - all.begin());
    return readNcltTurn(entry.cloud, all.at(index), known->motions.at(index));
  };
}

/// Motion of the body during each revolution, where odometry is available.
TurnMotions turnMotions(const Turns& turns, const NcltOdometry* odometry) {
  TurnMotions motions(turns.size());
  for (std::size_t i = 0; odometry && i < turns.size(); ++i) {
    const auto& poses = odometry->track().poses();
    const auto &begin = poses[3 * i], &middle = poses[3 * i + 1], &end = poses[3 * i + 2];
    if (begin && middle && end)
      motions[i] = TurnMotion{middle->inverse() * *begin, middle->inverse() * *end};
  }
  return motions;
}

/// Sets the motions between scans. Scans at times without odometry are dropped.
void addMotions(const NcltOdometry& odometry, const fs::path& file, std::size_t posesPerScan,
                const Eigen::Isometry3d& T_robot_body, ScanFolder& result) {
  requireOverlap(result, odometry.track(), file, "odometry");
  const auto& poses = odometry.track().poses();
  std::vector<bool> keep;
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    const auto& here = poses[posesPerScan * i + posesPerScan / 2];
    keep.push_back(here.has_value());
    if (!here) continue;
    if (last) {
      const auto& before = poses[posesPerScan * *last + posesPerScan / 2];
      result.scans[i].motion = odometry.motion(before->inverse() * *here, result.scans[*last].time,
                                               result.scans[i].time, T_robot_body);
    }
    last = i;
  }
  keepScans(result, keep, "at times without odometry");
}

void addTruth(const fs::path& file, const Eigen::Isometry3d& T_robot_body,
              const ReadProgress& progress, ScanFolder& result) {
  Eigen::Isometry3d T_map_truth = Eigen::Isometry3d::Identity();  // truth: north east down
  T_map_truth.linear() << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  const Eigen::Isometry3d T_body_robot = T_robot_body.inverse();
  TrackSampler track(timesOf(result), kTrackGap);
  NumberRowReader rows(file, 7, kNcltPoseLayout, Separator::commas, progress);
  std::vector<double> row;
  std::size_t unused = 0;
  while (rows.next(row)) {
    if (!allFinite(row) ||
        !track.add(row[0] * 1e-6, T_map_truth * ncltPose(row.data() + 1) * T_body_robot))
      ++unused;
  }
  noteUnusedRows(unused, file, result.notes);
  takePoses(result, track, file, "truth", "at times without truth");
}

/// Adds a note with the accuracy of the ground truth, as the dataset states it.
void noteTruthAccuracy(const fs::path& file, const ReadProgress& progress, ScanFolder& result) {
  NumberRowReader rows(file, 22, kNcltCovarianceLayout, Separator::commas, progress);
  std::vector<double> row;
  double sum = 0, worst = 0;
  std::size_t count = 0;
  const double begin = result.scans.front().time, end = result.scans.back().time;
  while (rows.next(row)) {
    const double sigma = std::sqrt(row[1] + row[7]), time = row[0] * 1e-6;
    if (!std::isfinite(sigma) || time < begin || time > end) continue;
    sum += sigma;
    worst = std::max(worst, sigma);
    ++count;
  }
  if (count > 0)
    result.notes.push_back("the truth's own standard deviation in the plane is " +
                           fixed(sum / static_cast<double>(count), 3) + " m in the mean, " +
                           fixed(worst, 3) + " m at worst (" + file.filename().string() + ")");
}

}  // namespace

Eigen::Isometry3d ncltRobotBody() {
  Eigen::Isometry3d T_robot_body = Eigen::Isometry3d::Identity();
  T_robot_body.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return T_robot_body;
}

ScanFolder readNclt(const fs::path& session, const Eigen::Isometry3d& T_robot_body,
                    const ReadProgress& progress) {
  const NcltFiles files = findNcltFiles(session);
  ScanFolder result;
  Turns turns;
  if (!files.sync.empty()) {
    addSync(files.sync, result);
    if (!files.hits.empty())
      result.notes.push_back("scans of velodyne_sync; velodyne_hits.bin is not used");
  } else {
    turns = findNcltTurns(files.hits, result.notes, progress);
    for (const NcltTurn& turn : turns)
      result.scans.push_back({fs::absolute(files.hits), turn.offset, turn.middle});
  }

  std::optional<NcltOdometry> odometry;
  const fs::path& means =
      files.odometry.track.empty() ? files.odometry.steps : files.odometry.track;
  if (!means.empty()) {
    odometry.emplace(files.odometry, wantedTimes(result, turns), result.notes, progress);
    addMotions(*odometry, means, turns.empty() ? 1 : 3, T_robot_body, result);
  }
  if (!turns.empty()) {
    auto motions = turnMotions(turns, odometry ? &*odometry : nullptr);
    readTurns(std::move(turns), std::move(motions), result);
  }
  if (!files.gps.empty()) addNcltFixes(files.gps, progress, result);
  if (files.truth.empty()) {
    result.notes.push_back("no groundtruth_DATE.csv");
  } else {
    addTruth(files.truth, T_robot_body, progress, result);
    if (!files.covariances.empty()) noteTruthAccuracy(files.covariances, progress, result);
  }
  return result;
}

}  // namespace polemcl::io
