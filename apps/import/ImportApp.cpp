#include "import/ImportApp.h"

#include <iostream>
#include <string>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "cli/CommandLine.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "core/common/Angles.h"
#include "import/DatasetImport.h"
#include "io/file/ErrorPlace.h"

namespace polemcl::apps {
namespace {

const std::vector<std::tuple<Dataset, const char*, const char*>> kDatasets{
    {Dataset::folder, "folder", "velodyne/*.bin, times.txt, poses.txt, odometry.txt"},
    {Dataset::kittiOdometry, "kitti-odometry", "A sequence of the KITTI odometry benchmark"},
    {Dataset::kittiRaw, "kitti-raw", "A synchronised drive of KITTI raw"},
    {Dataset::nclt, "nclt", "A session of NCLT, in a folder or as its downloader lays it out"},
    {Dataset::mulran, "mulran", "A sequence of MulRan: Ouster/*.bin, global_pose.csv"},
    {Dataset::pcd, "pcd", "*.pcd (also compressed), always embedded; text files as for folder"},
    {Dataset::rosbag2, "rosbag2",
     "A recording of ROS 2 (.mcap, .db3): PointCloud2, Odometry, Imu"}};

/// Options as they are typed.
struct Texts {
  std::string sensorPose, posesOf = "robot", odometryOf = "robot", session, turn;
  ScanTiming timing;
  double cutDeg = 180, yawBiasDeg = 0;
  std::optional<ScanTiming> stated() const;
};

std::optional<ScanTiming> Texts::stated() const {
  if (turn.empty()) return std::nullopt;
  ScanTiming result = timing;
  for (const auto& [value, name] : turnNames())
    if (name == turn) result.turn = value;
  result.cut = cutDeg * degree;
  return result;
}

std::string ownSensorPose(Dataset dataset) {
  return dataset == Dataset::rosbag2 ? "that of /tf_static, else 0"
         : dataset == Dataset::nclt  ? "the body, turned upright, 0 0 0 0 0 180"
         : dataset == Dataset::mulran
             ? "its calibration, 1.7042 -0.021 1.8047 179.6654 0.0003 0.0001"
             : "0";
}

std::string ownTiming(Dataset dataset) {
  const ScanTiming timing = datasetTiming(dataset);
  if (dataset == Dataset::rosbag2) return "scan_timing.ini, if there, else the times of the points";
  return timing.turn == Turn::automatic ? "scan_timing.ini, if there" : name(timing.turn);
}

/// What the robot and its LiDAR did: pose, turn, truth.
void declareSensor(CLI::App& cli, Dataset dataset, ImportOptions& options, Texts& texts) {
  cli.add_option("--sensor-pose", texts.sensorPose, "Frame of the clouds on the robot, m and deg")
      ->type_name("'X Y Z YAW_DEG PITCH_DEG ROLL_DEG'")
      ->default_str(ownSensorPose(dataset))
      ->check(
          [](const std::string& text) { return io::problemOf([&] { parseSensorPose(text); }); });
  auto* turn = cli.add_option("--turn", texts.turn,
                              "How the LiDAR turns while it measures a scan, seen from above; "
                              "compensated: the scans are corrected for motion");
  turn->default_str(ownTiming(dataset))
      ->check(CLI::IsMember({"compensated", "clockwise", "counterclockwise"}));
  cli.add_option("--turn-s", texts.timing.seconds, "Duration of a turn, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->needs(turn);
  auto* cut =
      cli.add_option("--cut-deg", texts.cutDeg, "Azimuth at which a scan begins and ends, deg")
          ->capture_default_str()
          ->needs(turn);
  cli.add_flag("--moving-cut", texts.timing.movingCut, "Each scan begins at its first point")
      ->needs(turn)
      ->excludes(cut);
  cli.add_option("--stamp-turn", texts.timing.stamp,
                 "Moment of the time stamps, as a share of the turn: 0 its begin, 1 its end")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->needs(turn);
  auto* poses = addFile(cli, "--poses", options.poses,
                        "TUM file of true poses, instead of those of the dataset");
  cli.add_option("--poses-of", texts.posesOf, "Whose poses these are")
      ->check(CLI::IsMember({"robot", "sensor"}))
      ->capture_default_str()
      ->needs(poses);
}

/// Options of one dataset only.
void declareOwn(CLI::App& cli, Dataset dataset, ImportOptions& options, Texts& texts) {
  if (dataset == Dataset::nclt)
    cli.add_option("--session", texts.session, "Session, when --input holds several: 2012-01-15")
        ->type_name("DATE");
  if (dataset == Dataset::kittiRaw)
    addFolder(cli, "--calib", options.calibration,
              "Folder of calib_imu_to_velo.txt (default: the one that holds --input)");
  if (dataset == Dataset::pcd)
    cli.add_flag("--skip-damaged", options.skipDamaged,
                 "Leave out files that cannot be read, and tell each");
  if (dataset != Dataset::rosbag2) return;
  auto& topics = options.topics;
  cli.add_option("--cloud-topic", topics.cloud, "Topic of the clouds, when there are several")
      ->type_name("TOPIC");
  cli.add_option("--odometry-topic", topics.odometry,
                 "Topic of the odometry, when there are several")
      ->type_name("TOPIC");
  cli.add_option("--imu-topic", topics.imu,
                 "Topic of an IMU: its gyroscope gives the yaw, instead of the odometry")
      ->type_name("TOPIC");
  cli.add_option("--gnss-topic", topics.fixes,
                 "Topic of the positions from satellites, when there are several")
      ->type_name("TOPIC");
}

void declare(CLI::App& cli, Dataset dataset, ImportOptions& options, Texts& texts) {
  addFolder(cli, "--input", options.input,
            dataset == Dataset::rosbag2 ? "Folder of the bag, or one .mcap or .db3 file"
                                        : "Folder of the dataset")
      ->required();
  markOutput(
      addFile(cli, "--output", options.output, "Rawlog to write, S.rawlog; the truth goes to S.tum")
          ->required(),
      {".tum"});
  cli.add_flag("--embed", options.embed, "Store the clouds inside the rawlog");
  addNumber(cli, "--every", options.every, "Take every N-th scan", CLI::PositiveNumber)
      ->type_name("N");
  cli.add_option("--offset", options.offset, "First scan to take, from 0")
      ->type_name("K")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  auto* odometry = addFile(cli, "--odometry", options.odometry,
                           "TUM file of an odometry, such as that of a LiDAR odometry program, "
                           "instead of that of the dataset");
  cli.add_option("--odometry-of", texts.odometryOf, "Whose poses these are")
      ->check(CLI::IsMember({"robot", "sensor"}))
      ->capture_default_str()
      ->needs(odometry);
  cli.add_option("--odometry-noise", options.odometryNoise,
                 "Make odometry from the true motion, with noise of this share, such as 0.02")
      ->check(CLI::NonNegativeNumber)
      ->default_str("odometry of the dataset")
      ->excludes(odometry);
  addNumber(cli, "--seed", options.seed, "Seed of that noise", CLI::NonNegativeNumber);
  addNumber(cli, "--odometry-scale", options.odometryScale,
            "Make that odometry too long by this share, such as 0.01", CLI::Range(-0.5, 0.5));
  addNumber(cli, "--odometry-yaw-deg-m", texts.yawBiasDeg,
            "Turn that odometry too far, deg per metre", CLI::Range(-10.0, 10.0));
  declareSensor(cli, dataset, options, texts);
  declareOwn(cli, dataset, options, texts);
}

void printImport(const ImportReport& report, const ImportOptions& options) {
  std::cout << options.output.string() << ": " << report.scans << " scans";
  if (report.skipped > 0) std::cout << ", " << report.skipped << " left out as asked";
  if (const std::size_t empty = report.emptyScans - report.damagedScans; empty > 0)
    std::cout << ", " << empty << " empty ones dropped";
  if (report.damagedScans > 0) std::cout << ", " << report.damagedScans << " damaged ones left out";
  if (report.embedded)
    std::cout << "; " << report.points << " points, " << report.invalidPoints
              << " invalid ones dropped";
  std::cout << '\n'
            << (report.hasTruth ? "truth: beside it, .tum\n" : "truth: none in the dataset\n")
            << (report.hasMotion  ? options.odometryNoise ? "odometry: true motion with noise\n"
                                    : options.odometry    ? "odometry: from --odometry\n"
                                                          : "odometry: from the dataset\n"
                : report.hasTruth ? "odometry: none; good for mapping; to localize, give "
                                    "--odometry or --odometry-noise\n"
                                  : "odometry: none; good for mapping, by the poles alone; to "
                                    "localize, give --odometry\n");
  const auto old = std::filesystem::path(options.output).replace_extension(".tum");
  if (!report.hasTruth && std::filesystem::exists(old))
    std::cout << "note: " << old.string() << " is of an earlier import, not of this drive\n";
  for (const auto& note : report.notes) std::cout << "note: " << note << '\n';
}

/// By subcommand; the first one is that of the program.
const Guides kImportGuides{
    {"",
     {{"pole-import folder --input scans --output scans.rawlog",
       "pole-import kitti-odometry --input dataset/sequences/00 --output 00.rawlog"},
      "See the options of one dataset, such as pole-import folder --help."}},
    {"folder",
     {{"pole-import folder --input scans --output scans.rawlog",
       "pole-import folder --input scans --output odd.rawlog --every 2 --offset 1 "
       "--odometry-noise 0.02 --seed 7"},
      "Build a map of the drive: pole-map build --config demo.ini --input scans.rawlog --truth "
      "scans.tum --output street.polemap."}},
    {"kitti-odometry",
     {{"pole-import kitti-odometry --input dataset/sequences/00 --output 00.rawlog "
       "--odometry-noise 0.02"},
      "Build a map of the drive, with the configuration kitti.ini: pole-map build --help."}},
    {"kitti-raw",
     {{"pole-import kitti-raw --input 2011_09_26/2011_09_26_drive_0009_sync --output "
       "0009.rawlog"},
      "Build a map of the drive, with the configuration kitti.ini: pole-map build --help."}},
    {"nclt",
     {{"pole-import nclt --input 2012-01-15 --output 2012-01-15.rawlog",
       "pole-import nclt --input NCLT --session 2012-01-15 --output 2012-01-15.rawlog"},
      "Build a map of the session, with the configuration nclt.ini: pole-map build --help."}},
    {"mulran",
     {{"pole-import mulran --input KAIST01 --output kaist01.rawlog --odometry-noise 0.02 --seed "
       "7"},
      "Build a map of the sequence, with the configuration mulran.ini: pole-map build --help."}},
    {"pcd",
     {{"pole-import pcd --input scans --output drive.rawlog --turn clockwise"},
      "Find out about the LiDAR: pole-extract --inspect drive.rawlog --write-config my.ini. Then "
      "build a map: pole-map build --help."}},
    {"rosbag2",
     {{"pole-import rosbag2 --input bag --output drive.rawlog",
       "pole-import rosbag2 --input bag --output drive.rawlog --cloud-topic /points --imu-topic "
       "/imu --poses truth.tum"},
      "Find out about the LiDAR: pole-extract --inspect drive.rawlog --write-config my.ini. Then "
      "build a map: pole-map build --help."}},
};

}  // namespace

int importMain(int argc, const char* const* argv) {
  CommandLine line("pole-import", "Turns a LiDAR dataset into a rawlog, with the truth beside it.",
                   kImportGuides);
  ImportOptions options;
  Texts texts;
  line.cli().require_subcommand(1);
  std::vector<std::pair<const CLI::App*, Dataset>> commands;
  for (const auto& [dataset, name, description] : kDatasets) {
    auto* command = line.cli().add_subcommand(name, description);
    declare(*command, dataset, options, texts);
    commands.emplace_back(command, dataset);
  }
  return line.run(argc, argv, [&] {
    for (const auto& [command, dataset] : commands)
      if (command->parsed()) options.dataset = dataset;
    if (!texts.sensorPose.empty()) options.T_robot_sensor = parseSensorPose(texts.sensorPose);
    if (!texts.session.empty()) options.input /= texts.session;
    options.timing = texts.stated();
    options.odometryYaw = texts.yawBiasDeg * degree;
    options.posesOfSensor = texts.posesOf == "sensor";
    options.odometryOfSensor = texts.odometryOf == "sensor";
    const auto report = importDataset(options, Progress("import", 0, line.quiet()).updates());
    if (!line.quiet()) printImport(report, options);
  });
}

}  // namespace polemcl::apps
