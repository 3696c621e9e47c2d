#include "io/dataset/Nclt.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <regex>
#include <set>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "core/common/Angles.h"
#include "io/dataset/NcltOdometry.h"
#include "io/dataset/ScanFiles.h"
#include "io/dataset/ScanPoses.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

/// The files of a session; a path is empty if the file does not exist.
struct NcltFiles {
  fs::path sync, hits;  ///< folder of scans; file of packets
  fs::path truth, covariances;
  fs::path gps;
  NcltOdometryFiles odometry;
};

/// Folders that NCLT's downloader makes for the archives of all sessions.
constexpr const char *kScanArchives = "velodyne_data", *kSensorArchives = "sensor_data";

bool isFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// The folder and its direct subfolders, sorted by name.
std::vector<fs::path> placesIn(const fs::path& folder) {
  std::error_code error, ignored;
  std::vector<fs::path> places;
  for (auto entry = fs::directory_iterator(folder, error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->is_directory(ignored)) places.push_back(entry->path());
  }
  if (error) throw Error("cannot read the folder " + folder.string() + ": " + error.message());
  std::sort(places.begin(), places.end());
  places.insert(places.begin(), folder);
  return places;
}

/// The date "2012-01-15" in a name; empty if the name holds no date.
std::string dateIn(const std::string& name) {
  static const std::regex date("\\d{4}-\\d{2}-\\d{2}");
  std::smatch match;
  return std::regex_search(name, match, date) ? match.str() : std::string();
}

/// Folders in which the files of one session are searched.
struct Places {
  std::string date;              ///< empty: the name of the folder has no date
  fs::path root;                 ///< the folder of all sessions
  std::vector<fs::path> own;     ///< folders with files of this session only
  std::vector<fs::path> shared;  ///< folders with files of several sessions, whose names hold dates
};

Places placesOf(const fs::path& session) {
  const fs::path whole = folderNamed(session);
  Places places;
  places.date = dateIn(whole.filename().string());
  places.root = whole.parent_path();
  if (places.root.filename() == kScanArchives) places.root = places.root.parent_path();
  std::vector<fs::path> folders{session};
  if (!places.date.empty()) {
    for (const std::string end : {"", "_vel"})
      folders.push_back(places.root / kScanArchives / (places.date + end));
    for (const std::string end : {"", "_sen"})
      folders.push_back(places.root / kSensorArchives / (places.date + end));
    places.shared = {places.root, places.root / "ground_truth", places.root / "ground_truth_cov"};
  }
  for (std::size_t i = 0; i < folders.size(); ++i) {
    std::error_code ignored;
    if (!isFolder(folders[i]) || (i > 0 && fs::equivalent(folders[i], session, ignored))) continue;
    const auto found = placesIn(folders[i]);
    places.own.insert(places.own.end(), found.begin(), found.end());
  }
  return places;
}

/// The only match for the name; an empty path if no folder has it.
fs::path findNamed(const std::vector<fs::path>& places, const std::string& name) {
  fs::path found;
  for (const fs::path& place : places) {
    const fs::path here = existing(place / name);
    if (here.empty()) continue;
    if (!found.empty())
      throw Error(found.string() + " and " + here.string() +
                  ": several of these; give the folder of one session, or its date (--session)");
    found = here;
  }
  return found;
}

/// Finds groundtruth_DATE.csv or cov_DATE.csv: the file of the session's date, otherwise the only
/// one.
fs::path findDated(const Places& places, const std::string& prefix) {
  if (!places.date.empty()) {
    const std::string name = prefix + "_" + places.date + ".csv";
    fs::path found = findNamed(places.own, name);
    if (found.empty()) found = findNamed(places.shared, name);
    if (!found.empty()) return found;
  }
  const std::regex pattern(prefix + "(_.*)?\\.csv(\\.gz)?");
  fs::path found;
  std::error_code ignored;
  for (const fs::path& place : places.own) {
    for (const auto& entry : fs::directory_iterator(place, ignored)) {
      if (!std::regex_match(entry.path().filename().string(), pattern)) continue;
      if (!found.empty())
        throw Error(found.string() + " and " + entry.path().string() +
                    ": several of these; keep that of the session");
      found = entry.path();
    }
  }
  return found;
}

bool hasScans(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".bin" && fileNumber(entry.path())) return true;
  }
  return false;
}

/// Dates of the archives that were downloaded, unpacked or not.
std::set<std::string> datesIn(const fs::path& root) {
  std::set<std::string> dates;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(root / kScanArchives, ignored)) {
    const std::string date = dateIn(entry.path().filename().string());
    if (!date.empty()) dates.insert(date);
  }
  return dates;
}

/// The session in a folder of the downloader that holds only one; any other folder unchanged.
fs::path onlySession(const fs::path& folder) {
  if (!isFolder(folder / kScanArchives)) return folder;
  const auto dates = datesIn(folder);
  if (dates.size() == 1) return folder / *dates.begin();
  throw Error((folder / kScanArchives).string() +
              (dates.empty()
                   ? ": no session in it; unpack DATE_vel.tar.gz of NCLT there"
                   : ": several sessions in it; choose one with --session: " + joined(dates)));
}

/// Finds the files, see readNclt(). \throws Error: no scans, several candidates for one file.
NcltFiles findNcltFiles(const fs::path& folder) {
  const fs::path session = onlySession(folder);
  const Places places = placesOf(session);
  NcltFiles files;
  files.sync = findNamed(places.own, "velodyne_sync");
  if (files.sync.empty() && hasScans(session)) files.sync = session;
  files.hits = findNamed(places.own, "velodyne_hits.bin");
  if (files.sync.empty() && files.hits.empty()) {
    const fs::path archive = places.root / kScanArchives / (places.date + "_vel.tar.gz");
    if (isThere(archive)) throw Error(archive.string() + ": is not unpacked; unpack it there");
    throw Error(session.string() + (isNcltSession(session)
                                        ? ": neither velodyne_sync/ nor velodyne_hits.bin in it "
                                          "(DATE_vel.tar.gz of NCLT)"
                                        : ": no such folder, and no session of that name in the "
                                          "velodyne_data/ beside it"));
  }
  files.truth = findDated(places, "groundtruth");
  files.covariances = findDated(places, "cov");
  files.gps = findNamed(places.own, "gps.csv");
  files.odometry = {findNamed(places.own, "odometry_mu_100hz.csv"),
                    findNamed(places.own, "odometry_mu.csv"),
                    findNamed(places.own, "odometry_cov.csv")};
  return files;
}

/// Adds the fixes of `gps.csv`, with a note: rows of mode 2 and 3 (in two and three dimensions),
/// whose angles are in rad. The file states no sigma: 2.5 m is assumed, and that the antenna is at
/// the robot.
void addNcltFixes(const fs::path& file, const ReadProgress& progress, ScanFolder& folder) {
  NumberRowReader rows(file, 8,
                       "utime, mode, satellites, latitude, longitude, altitude, track, speed",
                       Separator::commas, progress);
  std::vector<double> row;
  while (rows.next(row)) {
    if (row[1] != 2 && row[1] != 3) continue;
    GnssFix fix;
    fix.time = row[0] * 1e-6;
    fix.latitude = row[3] / degree;
    fix.longitude = row[4] / degree;
    fix.sigma = kAssumedFixSigma;
    takeFix(fix, folder);
  }
  finishFixes(file.filename().string(), folder);
}

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

bool isNcltSession(const fs::path& session) {
  return isFolder(session) || !placesOf(session).own.empty();
}

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
