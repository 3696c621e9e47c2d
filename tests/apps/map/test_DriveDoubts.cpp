// pole-map build without true poses: what it says of an odometry that is wrong.

#include <sstream>

#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "support/StreetTest.h"

namespace polemcl::test_drive_doubts {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class DriveDoubts : public StreetTest {
 protected:
  void driveWithFixes(std::size_t scans) {
    importStreet("in", scans);
    writeFixes();
  }
  /// Takes scans out of the rawlog; the odometry tells the way over the gap.
  void leaveOut(std::size_t begin, std::size_t end) {
    const auto truth = io::readPlanarTum(folder / "in.tum");
    const auto keep = [&](const char* name, std::size_t shift, const std::string& over) {
      const auto lines = io::readLines(folder / "in" / name);
      std::string kept;
      for (std::size_t i = 0; i < lines.size(); ++i)
        if (i + shift < begin || i + shift > end || (i + shift == end && over.empty()))
          kept += lines[i] + '\n';
        else if (i + shift == end)
          kept += over;
      writeText(folder / "in" / name, kept);
    };
    const Pose2D way = relative(truth[begin - 1].pose, truth[end].pose);
    keep("times.txt", 0, "");
    keep("poses.txt", 0, "");
    keep("odometry.txt", 1,
         io::fixed(way.x, 9) + ' ' + io::fixed(way.y, 9) + ' ' + io::fixed(way.yaw, 9) +
             " 0.02 0.01 0.003\n");
    const fs::path scans = folder / "in" / "velodyne";
    for (std::size_t i = begin; i < truth.size(); ++i)
      if (i + end - begin < truth.size())
        fs::rename(scans / scanName(i + end - begin), scans / scanName(i));
      else
        fs::remove(scans / scanName(i));
    import("in");
  }
  std::map<std::string, std::string> info() const {
    return io::readPoleMap(folder / "street.polemap").info;
  }
  void expectRightPlaces() const {
    const auto truth = io::readPlanarTum(folder / "in.tum"),
               found = io::readPlanarTum(folder / "found.tum");
    ASSERT_EQ(found.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR(found[i].pose.x, truth[i].pose.x, 0.1) << i;
      EXPECT_NEAR(found[i].pose.y, truth[i].pose.y, 0.1) << i;
    }
  }
};

/// The standard deviation of the first pose that a report tells, m.
double certainTo(const std::string& report) {
  const std::string before = "the first pose is certain to ";
  return std::stod(report.substr(report.find(before) + before.size()));
}

/// Five scans without poles in a drive without odometry: 0.1 s apart, so the motion goes on over
/// them.
TEST_F(DriveDoubts, ManyMotionsThatNothingTellsGiveAWarning) {
  writeStreet(folder / "in", 30);
  fs::remove(folder / "in" / "odometry.txt");
  std::string times;
  for (int i = 0; i < 30; ++i) times += io::fixed(50 + 0.1 * i, 3) + '\n';
  writeText(folder / "in" / "times.txt", times);
  import("in");
  const Outcome whole = succeeded(buildWithoutTruth());
  const float ground[] = {10, 0, -1.7F, 0};
  EXPECT_EQ(whole.err.find("neither odometry nor poles"), std::string::npos) << whole.err;
  for (std::size_t i = 10; i < 15; ++i)
    writeText(folder / "in" / "velodyne" / scanName(i),
              {reinterpret_cast<const char*>(ground), 16});
  import("in");
  const Outcome blind = succeeded(buildWithoutTruth());
  EXPECT_HAS(blind.err, "warning: in.rawlog: neither odometry nor poles tell 5 of its 29 motions");
  EXPECT_HAS(blind.err, " s on end, the first before 51.000 s: the path is a guess there");
  EXPECT_HAS(blind.out, "5 go on as before: look there, the first at 51.000 s");
  EXPECT_HAS(blind.out, " m against the first, if 5 guessed motions are right\n");
}

TEST_F(DriveDoubts, ASlipOfTheOdometryIsToldAndMended) {
  importStreet("in", 30);
  const Outcome right = succeeded(buildWithoutTruth());
  EXPECT_EQ(right.err, "");
  EXPECT_EQ(info().count("warnings"), 0u);
  std::string rows;
  std::size_t row = 0;
  for (const std::string& line : io::readLines(folder / "in" / "odometry.txt"))
    rows += (++row == 15 ? "2.7 0 0 0.02 0.01 0.003" : line) + '\n';
  writeText(folder / "in" / "odometry.txt", rows);
  import("in");
  const Outcome slipped = succeeded(buildWithoutTruth());
  EXPECT_HAS(slipped.err,
             "warning: in.rawlog: the poles contradict 1 of the 29 motions of its odometry, the "
             "first at 53.000 s");
  EXPECT_HAS(info().at("warnings"), "in.rawlog: the poles contradict 1 of");
  EXPECT_EQ(slipped.out.find("no odometry leads"), std::string::npos) << slipped.out;
  expectRightPlaces();
}

TEST_F(DriveDoubts, ALidarThatIsTurnedIsTold) {
  const std::string told = "warning: in.rawlog: as the poles pass, the LiDAR points 3.";
  importStreet("in", 30);
  EXPECT_EQ(buildWithoutTruth().err, "");
  std::string rows;  // to the left by 3.2°
  for (const std::string& line : io::readLines(folder / "in" / "odometry.txt")) {
    double x = 0, y = 0, yaw = 0;
    if (std::istringstream(line) >> x >> y >> yaw)
      rows += io::fixed(x - 0.056 * y, 9) + ' ' + io::fixed(y + 0.056 * x, 9) + ' ' +
              io::fixed(yaw, 9) + " 0.02 0.01 0.003\n";
  }
  writeText(folder / "in" / "odometry.txt", rows);
  import("in");
  EXPECT_HAS(buildWithoutTruth().err, told);
  auto truth = io::readTum(folder / "in.tum");
  for (auto& row : truth) row.pose.rotate(Eigen::AngleAxisd(-0.056, Eigen::Vector3d::UnitZ()));
  io::writeTum(folder / "in.tum", truth);
  const auto outcome =
      runProgram(mapMain, {"build", "--config", config(), "--input", at("in.rawlog"), "--truth",
                           at("in.tum"), "--output", at("street.polemap")});
  EXPECT_HAS(outcome.err, told);
}

TEST_F(DriveDoubts, PositionsOfAnotherClockAreTold) {
  driveWithFixes(60);
  const Outcome right = succeeded(buildWithoutTruth({"--gnss", at("fixes.csv")}));
  EXPECT_EQ(right.err, "");
  EXPECT_HAS(right.out, "placed by 59 positions from satellites;");
  EXPECT_HAS(right.out, "in.rawlog: its 59 positions from satellites lie 0.0");
  EXPECT_HAS(right.out, "m from its path (median), 0 of them do not fit");
  EXPECT_EQ(info().at("fixes"), "59");
  writeFixes([](double x) { return x < 25 ? x : std::min(2 * x - 25, 55.0); });
  const Outcome late = succeeded(buildWithoutTruth({"--gnss", at("fixes.csv")}));
  EXPECT_HAS(late.err, "of 59 positions from satellites do not fit its path, they lie ");
  EXPECT_HAS(late.err, "may lie wrong on Earth by far more");
  EXPECT_GT(certainTo(late.out), 5 * certainTo(right.out));
  EXPECT_HAS(late.err, "clock (GPS time is 18 s ahead of UTC)");
  EXPECT_HAS(info().at("warnings"), "do not fit its path");
  EXPECT_LT(std::stoi(info().at("fixes")), 45);
}

TEST_F(DriveDoubts, ADatumNeedsPositionsThatPlaceTheMapThere) {
  driveWithFixes(60);
  expectFailure(
      buildWithoutTruth({"--datum", "48,9"}),
      {"--datum 48,9,0: no drive has five positions", "--gnss or --truth", "leave out --datum"});
  EXPECT_FALSE(fs::exists(folder / "street.polemap"));
  EXPECT_EQ(buildWithoutTruth({"--datum", "48,9", "--gnss", at("fixes.csv")}).code, 0);
}

/// Key frames of a slow robot, a metre and 3 s apart.
TEST_F(DriveDoubts, PositionsBetweenScansThatAreLateButNearAreUsed) {
  driveWithFixes(60);
  std::string slow;
  for (int i = 0; i < 60; ++i) slow += std::to_string(50 + 3 * i) + '\n';
  writeText(folder / "in" / "times.txt", slow);
  import("in");
  writeFixes([](double x) { return x; });
  const Outcome near = succeeded(buildWithoutTruth({"--gnss", at("fixes.csv")}));
  EXPECT_HAS(near.out, "placed by 59 positions");
  EXPECT_EQ(near.out.find("left out"), std::string::npos) << near.out;
}

/// A gap of 15 m and 3 s, the scans 30 to 43.
TEST_F(DriveDoubts, PositionsBetweenScansFarApartAreCounted) {
  driveWithFixes(60);
  leaveOut(30, 44);
  const Outcome gap = succeeded(buildWithoutTruth({"--gnss", at("fixes.csv")}));
  EXPECT_HAS(gap.out, "placed by 44 positions");
  EXPECT_HAS(gap.out,
             "in.rawlog: left out 15 positions from satellites between scans more than 2 s and 10 "
             "m apart");
  const auto rows = io::readLines(folder / "fixes.csv");
  writeText(folder / "few.csv", rows[0] + '\n' + rows[33] + '\n' + rows[34] + '\n');
  expectFailure(buildWithoutTruth({"--gnss", at("few.csv")}),
                {"few.csv: all 2 of its positions", "more than 2 s and 10 m apart"});
}

}  // namespace
}  // namespace polemcl::test_drive_doubts
