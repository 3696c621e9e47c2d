#include "io/data/GnssCsv.h"
#include "support/IoFiles.h"

namespace polemcl::test_gnss_csv {

using namespace polemcl::io;
using namespace polemcl::io::test;

class GnssCsvTest : public FolderTest {
 protected:
  std::vector<GnssFix> load(const std::string& rows,
                            const std::string& header = "time,latitude,longitude,sigma\n") const {
    return readGnssCsv(write("gnss.csv", header + rows));
  }
  std::string place(int line) const {
    return path("gnss.csv").string() + ":" + std::to_string(line) + ": ";
  }
};

TEST_F(GnssCsvTest, ReadsColumnsInAnyOrder) {
  const auto fixes = load("# a drive\n0.5,a,-180,-90,10\n2.5,b,180,90,10\n3,c,8.5,49,10.25\n",
                          "sigma,name,longitude,latitude,time\n");
  ASSERT_EQ(fixes.size(), 3u);
  EXPECT_EQ(fixes[0].latitude, -90);
  EXPECT_EQ(fixes[1].longitude, 180);
  EXPECT_EQ(fixes[1].time, fixes[0].time) << "two receivers";
  EXPECT_EQ(fixes[2].time, 10.25);
  EXPECT_EQ(fixes[2].latitude, 49);
  EXPECT_EQ(fixes[2].longitude, 8.5);
  EXPECT_EQ(fixes[2].sigma, 3);
  EXPECT_EQ(fixes[2].antenna_robot, Eigen::Vector2d(0, 0));
  EXPECT_TRUE(load("").empty());
}

TEST_F(GnssCsvTest, RefusesWhatIsNoFix) {
  EXPECT_REFUSED(load("1,90.5,8,1\n"), place(2), "latitude 90.5;", "-90 to 90");
  EXPECT_REFUSED(load("1,-91,8,1\n"), place(2), "latitude -91;");
  EXPECT_REFUSED(load("1,49,8,1\n2,49,180.25,1\n"), place(3), "longitude 180.25;", "-180 to 180");
  EXPECT_REFUSED(load("1,49,8,0\n"), place(2), "sigma 0;", "above 0");
  EXPECT_REFUSED(load("1,49,8,-1\n"), place(2), "sigma -1;");
  EXPECT_REFUSED(load("2,49,8,1\n1.5,49,8,1\n"), place(3), "time 1.500 is before", "2.000");
  EXPECT_REFUSED(load("1,nan,8,1\n"), place(2), "finite");
  EXPECT_REFUSED(load("1,49,8\n", "time,latitude,longitude\n"), place(1), "sigma");
}

}  // namespace polemcl::test_gnss_csv
