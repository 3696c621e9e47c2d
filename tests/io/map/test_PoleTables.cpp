#include "io/map/PoleTables.h"
#include "support/IoFiles.h"
#include "support/NumpyFiles.h"
#include "support/Poles.h"

namespace polemcl::test_pole_tables {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

class PoleTables : public FolderTest {};

PoleMapData sample() {
  PoleMapData map;
  for (int i = 0; i < 3; ++i) {
    map.poles.push_back(tests::variedMapPole(1.5 + i, -2.25 * i));
    map.poles.back().count += static_cast<unsigned>(i);
    map.histories.push_back({12, 3, 0.875, 1326585600, i == 1 ? 0.0 : 1331942400});
  }
  return map;
}

TEST_F(PoleTables, CsvComesBack) {
  const PoleMapData before = sample();
  writePoleCsv(path("m.csv"), before.poles, before.histories);
  const PoleMapData after = readPoleCsv(path("m.csv"));
  tests::expectSame(after.poles, before.poles);
  ASSERT_EQ(after.histories.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(after.histories[i].existence, 0.875);
    EXPECT_EQ(after.histories[i].seen, 12u);
    EXPECT_EQ(after.histories[i].missed, 3u);
    EXPECT_EQ(after.histories[i].firstSeen, 1326585600);  // midnight, because CSV stores dates
    EXPECT_EQ(after.histories[i].lastSeen, before.histories[i].lastSeen);
  }
}

TEST_F(PoleTables, CsvOfOthersNeedsOnlyPlaces) {
  const auto map = readPoleCsv(write("o.csv", "name,y,x\nlamp,2,1\nsign,4,3\n"));
  ASSERT_EQ(map.poles.size(), 2u);
  EXPECT_EQ(map.poles[1].x, 3);
  EXPECT_EQ(map.poles[1].y, 4);
  EXPECT_EQ(map.poles[1].radius, 0.1);
  EXPECT_EQ(map.poles[1].count, 1u);
  EXPECT_TRUE(map.histories.empty());
}

TEST_F(PoleTables, CsvRefusesWhatIsWrong) {
  const auto refusal = [&](const std::string& text) {
    return messageOf([&] { readPoleCsv(write("bad.csv", text)); });
  };
  expectIn(refusal("x,z\n1,2\n"), "bad.csv:1", "column named y");
  expectIn(refusal("x,y,count\n1,2,3\n1,2,-3\n"), "bad.csv:3", "count");
  expectIn(refusal("x,y,count\n1,2,0.5\n"), "bad.csv:2", "count");
  expectIn(refusal("x,y,radius\n1,2,a\n"), "bad.csv:2", "'a'");
  expectIn(refusal("x,y,existence,last_seen\n1,2,0.5,2020-13-01\n"), "bad.csv:2", "2020-13-01");
  expectIn(refusal("x,y,radius,radius\n1,2,3,4\n"), "radius");
}

TEST_F(PoleTables, ReadsRadiiOfNpz) {
  const auto read = [&](double radius) {
    const std::string means =
        npy(dictionary("<f8", "False", "(2, 3)"), doubles({1, 2, 0.25, 3, 4, radius}));
    return readPoleNpz(write("m.npz", zip({{"polemeans.npy", means}})));
  };
  const PoleMapData map = read(0.125);
  ASSERT_EQ(map.poles.size(), 2u);
  EXPECT_EQ(map.poles[0].radius, 0.25);
  EXPECT_EQ(map.poles[1].x, 3);
  EXPECT_EQ(map.poles[1].y, 4);
  EXPECT_EQ(map.poles[1].radius, 0.125);
  expectIn(messageOf([&] { read(-1); }), "m.npz", "row 1", "not a radius");
}

TEST_F(PoleTables, ReadsTheAuthorsFiles) {
  POLEMCL_NEEDS_DATA();
  const auto map = readPoleNpz(dataFolder() / "published" / "nclt_map_8_0.50_0.08.npz");
  ASSERT_EQ(map.poles.size(), 1635u);
  for (const MapPole& pole : map.poles) {
    EXPECT_GT(pole.radius, 0.01);
    EXPECT_LT(pole.radius, 1);
  }
  // Its third column is not a radius.
  const auto truth = readPoleNpz(dataFolder() / "published" / "nclt_truth.npz");
  ASSERT_EQ(truth.poles.size(), 1205u);
  EXPECT_EQ(truth.poles.front().radius, 0.1);
}

}  // namespace
}  // namespace polemcl::test_pole_tables
