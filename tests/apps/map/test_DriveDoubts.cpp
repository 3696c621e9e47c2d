/// \file test_DriveDoubts.cpp
/// \brief pole-map build without true poses: what it says of an odometry that is wrong.

#include <functional>

#include "cli/MapPlane.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "map/MapApp.h"
#include "support/ExpectHas.h"
#include "support/StreetTest.h"

namespace polemcl::test_drive_doubts {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

class DriveDoubts : public StreetTest {
 protected:
  Outcome build(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{
        "build",    "--config",           config(),       "--input",      at("in.rawlog"),
        "--output", at("street.polemap"), "--trajectory", at("found.tum")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(mapMain, arguments);
  }
  void driveWithFixes(std::size_t scans) {
    writeStreet(folder / "in", scans);
    import("in");
    writeFixes([](double x) { return x; });
  }
  /// A fix just after each scan. \param along What the receiver says of the x of the truth.
  void writeFixes(const std::function<double(double)>& along) {
    std::string fixes = "time,latitude,longitude,sigma\n";
    const MapPlane plane({48, 9, 0});
    for (const StampedPose2D& at : io::readPlanarTum(folder / "in.tum")) {
      const Eigen::Vector2d lonLat = plane.lonLat({100 + along(at.pose.x), 50 + at.pose.y});
      fixes += io::fixed(at.time + 0.01, 3) + ',' + io::fixed(lonLat.y(), 10) + ',' +
               io::fixed(lonLat.x(), 10) + ",0.02\n";
    }
    writeText(folder / "fixes.csv", fixes);
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

}  // namespace

TEST_F(DriveDoubts, ASlipOfTheOdometryIsToldAndMended) {
  writeStreet(folder / "in", 30);
  import("in");
  const auto right = build();
  ASSERT_EQ(right.code, 0) << right.err;
  EXPECT_EQ(right.err, "");
  EXPECT_EQ(info().count("warnings"), 0u);
  std::string rows;
  std::size_t row = 0;
  for (const std::string& line : io::readLines(folder / "in" / "odometry.txt"))
    rows += (++row == 15 ? "2.7 0 0 0.02 0.01 0.003" : line) + '\n';
  writeText(folder / "in" / "odometry.txt", rows);
  import("in");
  const auto slipped = build();
  ASSERT_EQ(slipped.code, 0) << slipped.err;
  EXPECT_HAS(slipped.err,
             "warning: in.rawlog: the poles contradict 1 motion of its odometry, the "
             "first at 53.000 s");
  EXPECT_HAS(info().at("warnings"), "in.rawlog: the poles contradict 1 motion");
  EXPECT_EQ(slipped.out.find("no odometry leads"), std::string::npos) << slipped.out;
  expectRightPlaces();
}

TEST_F(DriveDoubts, PositionsOfAnotherClockAreTold) {
  driveWithFixes(60);
  const auto right = build({"--gnss", at("fixes.csv")});
  ASSERT_EQ(right.code, 0) << right.err;
  EXPECT_EQ(right.err, "");
  EXPECT_HAS(right.out, "placed by 59 positions from satellites;");
  EXPECT_HAS(right.out, "in.rawlog: its 59 positions from satellites lie 0.0");
  EXPECT_HAS(right.out, "m from its path (median), 0 of them do not fit");
  EXPECT_EQ(info().at("fixes"), "59");
  writeFixes([](double x) { return x < 25 ? x : std::min(2 * x - 25, 55.0); });
  const auto late = build({"--gnss", at("fixes.csv")});
  ASSERT_EQ(late.code, 0) << late.err;
  EXPECT_HAS(late.err, "of 59 positions from satellites do not fit its path, they lie ");
  EXPECT_HAS(late.err, "clock (GPS time is 18 s ahead of UTC)");
  EXPECT_HAS(info().at("warnings"), "do not fit its path");
  EXPECT_LT(std::stoi(info().at("fixes")), 45);
}

TEST_F(DriveDoubts, ADatumNeedsPositionsThatPlaceTheMapThere) {
  driveWithFixes(60);
  expectFailure(build({"--datum", "48,9"}), {"--datum 48,9,0: no drive has five positions",
                                             "--gnss or --truth", "leave out --datum"});
  EXPECT_FALSE(fs::exists(folder / "street.polemap"));
  EXPECT_EQ(build({"--datum", "48,9", "--gnss", at("fixes.csv")}).code, 0);
}

}  // namespace polemcl::test_drive_doubts
