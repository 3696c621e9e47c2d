#include <cmath>

#include "io/file/Npz.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "support/IoFiles.h"
#include "support/NumpyFiles.h"

namespace polemcl::test_pole_positions {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

using Positions = std::vector<Eigen::Vector2d>;

class PolePositionsTest : public FolderTest {
 protected:
  std::string refusal(const std::string& name, const std::string& content) const {
    const fs::path file = write(name, content);
    return messageOf([&] { readPolePositions(file); });
  }
};

TEST_F(PolePositionsTest, WritesCsvByHand) {
  MapPole p;
  p.x = 1.5;
  p.y = -2;
  p.radius = 0.1;
  p.bottom = 0.3;
  p.top = 5;
  p.confidence = 0.9;
  p.covariance << 0.0004, -0.0001, -0.0001, 1e-7;
  p.count = 12;
  writePoleCsv(path("m.csv"), {p});
  EXPECT_EQ(read(path("m.csv")),
            "x,y,radius,count,bottom,top,confidence,cov_xx,cov_xy,cov_yy\n"
            "1.500000,-2.000000,0.100000,12,0.3,5,0.9,0.0004,-0.0001,1e-07\n");
  EXPECT_EQ(readPolePositions(path("m.csv")), (Positions{{1.5, -2}}));
}

TEST_F(PolePositionsTest, WritesHistories) {
  MapPole p;
  p.x = 1;
  p.radius = 0.1;
  writePoleCsv(path("m.csv"), {p, p}, {{7, 3, 0.875, 951782400, 1331942400}, {0, 0, 0.5, 0, 0}});
  const std::string text = read(path("m.csv"));
  EXPECT_HAS(text, "cov_yy,existence,seen,missed,first_seen,last_seen\n");
  EXPECT_HAS(text, ",0.875,7,3,2000-02-29,2012-03-17\n");
  EXPECT_HAS(text, ",0.5,0,0,,\n");
  EXPECT_EQ(readPolePositions(path("m.csv")).size(), 2u);
}

TEST_F(PolePositionsTest, ReadsCsvByTheNamesOfItsColumns) {
  EXPECT_EQ(readPolePositions(write("m.csv", "id,x,y,radius,top\n0,1,2,0.1,5\n1,-3e1,4.5,0.1,5\n")),
            (Positions{{1, 2}, {-30, 4.5}}));
  EXPECT_EQ(readPolePositions(write(
                "M.CSV", "# made by hand\r\n \"y\" , name,x\r\n\r\n2,\"a, \"\"b\"\"\",1\r\n")),
            (Positions{{1, 2}}));
  EXPECT_TRUE(readPolePositions(write("m.csv", "x,y\n")).empty());
}

TEST_F(PolePositionsTest, ReadsPoleMaps) {
  PoleMapData data;
  data.poles.resize(2);
  data.poles[1].x = 3;
  data.poles[1].y = 4;
  writePoleMap(path("m.polemap"), data);
  EXPECT_EQ(readPolePositions(path("m.polemap")), (Positions{{0, 0}, {3, 4}}));
}

TEST_F(PolePositionsTest, ReadsArraysOfBothNames) {
  for (const char* name : {"poleparams.npy", "polemeans.npy"}) {
    const std::string three =
        npy(dictionary("<f8", "False", "(2, 3)"), doubles({1, 2, 9, 3, 4, 9}));
    EXPECT_EQ(readPolePositions(write("m.npz", zip({{"other.npy", "x"}, {name, three}}))),
              (Positions{{1, 2}, {3, 4}}));
  }
}

TEST_F(PolePositionsTest, RefusesBadInput) {
  expectIn(refusal("m.txt", "1 2\n"), path("m.txt").string(), "'.txt'", ".polemap", ".csv", ".npz");
  expectIn(refusal("m", ""), "unknown kind");
  for (const char* name : {"no.csv", "no.npz", "no.polemap"}) {
    EXPECT_REFUSED(readPolePositions(path(name)), name, "No such file or directory");
  }
  expectIn(refusal("m.csv", "1,2\n3,4\n"), path("m.csv").string() + ":1: ", "named x");
  expectIn(refusal("m.csv", "x,z\n3,4\n"), "named y");
  expectIn(refusal("m.csv", "x,y,x\n3,4,5\n"), "one column named x");
  expectIn(refusal("m.csv", "# only this\n"), "empty");
  expectIn(refusal("m.csv", "x,y\n1,2\n1,2,3\n"), path("m.csv").string() + ":3: ", "3 fields");
  expectIn(refusal("m.csv", "x,y\n1\n"), path("m.csv").string() + ":2: ", "1 fields");
  for (const char* word : {"a", "", "nan", "inf", "1.2.3"}) {
    expectIn(refusal("m.csv", std::string("x,y\n1,") + word + "\n"),
             path("m.csv").string() + ":2: ", "not a finite number");
  }
  expectIn(refusal("m.csv", "x,y,name\n1,2,\"a\n"), path("m.csv").string() + ":2: ", "quote");
  expectIn(refusal("m.npz", zip({{"walls.npy", ""}, {"mappos.npy", ""}})), path("m.npz").string(),
           "poleparams or polemeans", "mappos, walls");
  expectIn(refusal("m.npz", zip({})), "none");
  for (const auto& [shape, told] : std::vector<std::pair<std::string, std::string>>{
           {"(4,)", "(4)"}, {"(4, 1)", "(4x1)"}, {"(2, 2, 1)", "(2x2x1)"}}) {
    const std::string array = npy(dictionary("<f8", "False", shape), doubles({1, 2, 3, 4}));
    expectIn(refusal("m.npz", zip({{"poleparams.npy", array}})), "poleparams", told);
  }
}

TEST_F(PolePositionsTest, RefusesArraysThatAreNotFinite) {
  const std::string array =
      npy(dictionary("<f8", "False", "(2, 2)"), doubles({1, 2, 3, std::nan("")}));
  expectIn(refusal("m.npz", zip({{"poleparams.npy", array}})), "row 1", "not finite");
}

TEST_F(PolePositionsTest, ReadsThePublishedMaps) {
  POLEMCL_NEEDS_DATA();
  const fs::path folder = dataFolder() / "published";
  const Positions truth = readPolePositions(folder / "nclt_truth.npz");
  const Positions map = readPolePositions(folder / "nclt_map_8_0.50_0.08.npz");
  ASSERT_EQ(truth.size(), 1205u);
  ASSERT_EQ(map.size(), 1635u);
  // By brute force: 859 map poles have a truth pole within 1 m, in agreement with the paper's
  // numbers.
  int matches = 0;
  for (const auto& pole : map) {
    bool matched = false;
    for (const auto& other : truth) matched = matched || (pole - other).norm() <= 1.0;
    matches += matched;
  }
  EXPECT_EQ(matches, 859);
  const NpzFile npz(folder / "nclt_map_8_0.50_0.08.npz");
  EXPECT_EQ(npz.names(),
            (std::vector<std::string>{"mapfactors", "mappos", "polemeans", "wallmeans"}));
  EXPECT_EQ(npz.array("mappos").shape, (std::vector<std::size_t>{12999, 2}));
  EXPECT_EQ(npz.array("wallmeans").shape, (std::vector<std::size_t>{0, 2}));
}

TEST_F(PolePositionsTest, ReadsTheTruthOfAllKittiSequences) {
  POLEMCL_NEEDS_DATA();
  const std::size_t expected[] = {598, 419, 783, 163, 205, 321, 236, 136, 846, 382, 194};
  for (int i = 0; i < 11; ++i) {
    const std::string name =
        std::string("kitti_truth_") + (i < 10 ? "0" : "") + std::to_string(i) + ".npz";
    EXPECT_EQ(readPolePositions(dataFolder() / "published" / name).size(), expected[i]) << name;
  }
}

}  // namespace
}  // namespace polemcl::test_pole_positions
