#include "fuzz/Fuzz.h"
#include "io/dataset/KittiOdometry.h"
#include "io/dataset/KittiRaw.h"
#include "io/dataset/Mulran.h"
#include "io/dataset/Nclt.h"
#include "io/dataset/ScanFolder.h"
#include "io/dataset/ScanPoses.h"
#include "io/rosbag/Bag.h"

namespace polemcl::fuzz {
namespace {

namespace fs = std::filesystem;

/// A dataset whose text files are arbitrary; the scans are there.
struct Layout {
  const char* folder;
  std::vector<std::string> scans;
  std::vector<std::string> texts;  ///< the pieces of the input
  io::ScanFolder (*read)(const fs::path& folder);
};

const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();

io::ScanFolder readBagFolder(const fs::path& folder) {
  io::bagFiles(folder);
  return {};
}
io::ScanFolder readPlain(const fs::path& folder) {
  io::ScanFolder read = io::readScanFolder(folder, kHere);
  io::takeTumPoses(read, folder / "poses.tum", kHere);
  return read;
}

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> all{
      {"plain",
       {"velodyne/000000.bin", "velodyne/000001.bin"},
       {"times.txt", "poses.txt", "odometry.txt", "poses.tum"},
       readPlain},
      {"pcd",
       {"a.pcd", "b.pcd"},
       {"times.txt", "poses.txt", "odometry.txt"},
       [](const fs::path& path) { return io::readPcdFolder(path, kHere); }},
      {"sequences/00",
       {"velodyne/000000.bin", "velodyne/000001.bin"},
       {"times.txt", "calib.txt", "poses.txt"},
       [](const fs::path& path) { return io::readKittiOdometry(path, kHere); }},
      {"raw",
       {"velodyne_points/data/0000000000.bin", "velodyne_points/data/0000000001.bin"},
       {"velodyne_points/timestamps.txt", "oxts/timestamps.txt", "oxts/data/0000000000.txt",
        "oxts/data/0000000001.txt", "calib_imu_to_velo.txt"},
       [](const fs::path& path) { return io::readKittiRaw(path, path, kHere); }},
      {"mulran",
       {"Ouster/1561000000000000000.bin", "Ouster/1561000000100000000.bin"},
       {"global_pose.csv", "ouster_front_stamp.csv", "gps.csv"},
       [](const fs::path& path) { return io::readMulran(path, io::mulranBaseLidar()); }},
      {"2012-01-08",
       {"velodyne_sync/1326652795000000.bin", "velodyne_sync/1326652795200000.bin"},
       {"groundtruth_2012-01-08.csv", "odometry_mu_100hz.csv", "odometry_mu.csv",
        "odometry_cov.csv", "gps.csv"},
       [](const fs::path& path) { return io::readNclt(path, io::ncltRobotBody()); }},
      {"bag", {"a_0.db3"}, {"metadata.yaml"}, readBagFolder}};
  return all;
}

/// The folders with their scans.
void prepare(const Layout& layout) {
  for (const auto* names : {&layout.scans, &layout.texts})
    for (const std::string& name : *names)
      fs::create_directories((folder() / layout.folder / name).parent_path());
  for (const std::string& name : layout.scans)
    fileOf(std::string(layout.folder) + "/" + name, std::string(32, '\x3f'));
}

/// Texts that the input has no piece for are not there.
void readFolder(std::string_view bytes) {
  static const bool prepared = [] {
    for (const Layout& layout : layouts()) prepare(layout);
    return true;
  }();
  if (!prepared || bytes.empty()) return;
  const Layout& layout = layouts()[static_cast<unsigned char>(bytes.front()) % layouts().size()];
  const auto texts = pieces(bytes.substr(1), layout.texts.size());
  for (std::size_t i = 0; i < layout.texts.size(); ++i) {
    const std::string name = std::string(layout.folder) + "/" + layout.texts[i];
    if (i < texts.size())
      fileOf(name, texts[i]);
    else
      fs::remove(folder() / name);
  }
  const io::ScanFolder read = layout.read(folder() / layout.folder);
  if (read.read)
    for (const io::ScanEntry& scan : read.scans) read.read(scan);
}

std::vector<std::string> folderSeeds() {
  const std::string pose = "1 0 0 0 0 1 0 0 0 0 1 0\n", next = "1 0 0 1 0 1 0 0 0 0 1 0\n";
  const std::string tum = "100 0 0 0 0 0 0 1\n101 1 0 0 0 0 0 1\n";
  const std::string motion = "1 0 0 0.02 0.01 0.003\n", times = "100\n100.5\n";
  const std::string calibration = "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n";
  const std::string stamps = "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.064389445\n";
  const std::string oxts = "49.01 8.43 112 0.03 0.01 -0.5 1 2 3\n";
  const std::string imu = "calib_time: 25-May-2012\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n";
  const auto row = [](const std::string& time) { return time + ",1,0,0,0,0,1,0,0,0,0,1,0\n"; };
  const std::string utimes[] = {"1326652794000000", "1326652796000000"};
  std::string truth, covariance;
  for (const std::string& utime : utimes) {
    truth += utime + ",1,2,3,0.01,0.02,0.5\n";
    covariance += utime + ",1,0,0,0,0,0,1,0,0,0,0,1,0,0,0,1,0,0,1,0,1\n";
  }
  const std::string gps = utimes[0] + ",3,8,0.738,-1.461,270,0,0\n";
  const std::string yaml =
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
      "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n"
      "    - a_0.db3\n";
  return {inputFor(0, joined({times, pose + next, motion, tum})),
          inputFor(1, joined({times, pose + next, motion})),
          inputFor(2, joined({"0\n0.1\n", calibration, pose + next})),
          inputFor(3, joined({stamps, stamps, oxts, oxts, imu})),
          inputFor(4, joined({row("1560999999900000000") + row("1561000000200000000"),
                              "1561000000000000000\n1561000000100000000\n",
                              "1561000000000000000,36.3,127.3,50,1,0,0,0,1,0,0,0,1\n"})),
          inputFor(5, joined({truth, truth, truth, covariance, gps})),
          inputFor(6, yaml)};
}

}  // namespace

std::vector<Target> folderTargets() {
  return {{"folders", readFolder, folderSeeds}};
}

}  // namespace polemcl::fuzz
