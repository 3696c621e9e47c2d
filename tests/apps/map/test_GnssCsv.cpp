#include <gtest/gtest.h>

#include "map/DriveFixFiles.h"
#include "support/IoFiles.h"
#include "support/Refusal.h"

namespace polemcl::apps::test_gnss_csv {

class GnssCsv : public io::test::FolderTest {};

TEST_F(GnssCsv, ReadsFixes) {
  const auto file = write("a.csv",
                          "time,latitude,longitude,sigma,antenna_x,antenna_y\n"
                          "10,48.5,-9.25,1.5,0.4,-0.1\n"
                          "10.5,-90,180,0.02,0,0\n");
  const auto fixes = readGnssCsv(file);
  ASSERT_EQ(fixes.size(), 2u);
  EXPECT_EQ(fixes[0].time, 10);
  EXPECT_EQ(fixes[0].latitude, 48.5);
  EXPECT_EQ(fixes[0].longitude, -9.25);
  EXPECT_EQ(fixes[0].sigma, 1.5);
  EXPECT_EQ(fixes[0].antenna_robot, Eigen::Vector2d(0.4, -0.1));
  EXPECT_EQ(fixes[1].latitude, -90);
  const auto bare = readGnssCsv(write("b.csv", "sigma,longitude,latitude,time\n1,9,48,5\n"));
  EXPECT_EQ(bare.at(0).latitude, 48);
  EXPECT_EQ(bare.at(0).antenna_robot, Eigen::Vector2d(0, 0));
}

TEST_F(GnssCsv, RefusesWhatIsNoFix) {
  const auto rows = [&](const std::string& text) {
    return readGnssCsv(write("c.csv", "time,latitude,longitude,sigma\n" + text));
  };
  EXPECT_REFUSED(rows("1,48,9,1\n2,91,9,1\n"), "c.csv:3", "latitude");
  EXPECT_REFUSED(rows("1,48,-361,1\n"), "c.csv:2", "longitude");
  EXPECT_REFUSED(rows("1,48,9,0\n"), "c.csv:2", "sigma must be above 0");
  EXPECT_REFUSED(rows("2,48,9,1\n1,48,9,1\n"), "c.csv:3", "time goes back");
  EXPECT_REFUSED(rows("nan,48,9,1\n"), "c.csv:2");
  EXPECT_REFUSED(readGnssCsv(write("d.csv", "time,latitude,longitude\n1,2,3\n")), "d.csv", "sigma");
}

}  // namespace polemcl::apps::test_gnss_csv
