#include "io/dataset/NcltFiles.h"

#include <algorithm>
#include <regex>
#include <set>

#include <polemcl/core/common/Types.h>
#include "io/dataset/Nclt.h"
#include "io/dataset/ScanFiles.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

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

}  // namespace

bool isNcltSession(const fs::path& session) {
  return isFolder(session) || !placesOf(session).own.empty();
}

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

}  // namespace polemcl::io
