/// \file test_GlobalLocalizerOnMaps.cpp
/// \brief Global localization where poles and roads are real: a published map of a campus against
/// poles labelled by hand, and the roads of a city drive.

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <polemcl/core/global_localization/GlobalLocalizer.h>
#include "io/file/Npz.h"
#include "io/map/PolePositions.h"
#include "support/PoleCity.h"

namespace polemcl::test_global_localizer_on_maps {

using namespace polemcl;
using tests::Way;

namespace {

std::filesystem::path dataFolder() {
  const char* folder = std::getenv("POLEMCL_DATA");
  return folder ? folder : "";
}

/// x and y of a gzipped KITTI trajectory, points half a metre or more apart.
Way readRoad(const std::filesystem::path& file) {
  Way road;
  gzFile stream = gzopen(file.c_str(), "rb");
  char line[1024];
  while (stream && gzgets(stream, line, sizeof line)) {
    double p[12];
    char* at = line;
    for (double& value : p) value = std::strtod(at, &at);
    const Eigen::Vector2d place(p[3], p[7]);
    if (road.empty() || (place - road.back()).norm() > 0.5) road.push_back(place);
  }
  if (stream) gzclose(stream);
  return road;
}

/// 61 m of the road, either way; not where the road folds back in a way no car drives.
Way pieceOf(const Way& road, sim::Random& random) {
  for (;;) {
    const auto first = random.below(static_cast<int>(road.size()) - 62);
    Way travel(road.begin() + first, road.begin() + first + 61);
    if (random.chance(0.5)) std::reverse(travel.begin(), travel.end());
    bool smooth = true;
    for (std::size_t i = 1; i < travel.size(); ++i)
      smooth = smooth &&
               std::abs(relative(tests::poseOn(travel, i - 1), tests::poseOn(travel, i)).yaw) < 0.5;
    if (smooth) return travel;
  }
}

struct Count {
  int right = 0, wrong = 0;  ///< the others stay undecided
};

/// Starts anywhere on the road, asks every five metres, takes the first answer.
Count starts(const std::vector<MapPole>& map, const tests::Surroundings& things, const Way& road,
             int count) {
  const GlobalLocalizer localizer(map);
  sim::Random random(2024);
  Count result;
  for (int i = 0; i < count; ++i) {
    LocalSubmap submap;
    bool resolved = false;
    for (const tests::Frame& frame : tests::drive(things, pieceOf(road, random), {}, random)) {
      submap.add(frame.motion, frame.poles_robot);
      if (resolved || submap.frames() % 5 != 0) continue;
      const GlobalResult answer = localizer.localize(submap);
      if (answer.verdict != GlobalVerdict::resolved) continue;
      resolved = true;
      const Pose2D error = relative(frame.truth, answer.hypotheses[0].pose_map_robot);
      const bool right =
          std::hypot(error.x, error.y) <= 0.5 && std::abs(error.yaw) <= 2 * M_PI / 180;
      ++(right ? result.right : result.wrong);
    }
  }
  return result;
}

}  // namespace

/// Half of this map's poles are labelled. Two thirds of the labelled poles are on the map, 0.16 m
/// off in the median. Unlabelled things are taken for a pole again in half of the cases.
TEST(GlobalLocalizerOnMaps, FindsTheRobotInAPublishedMap) {
  if (dataFolder().empty()) GTEST_SKIP() << "POLEMCL_DATA is not set";
  const std::filesystem::path folder = dataFolder() / "published";
  tests::Surroundings things;
  things.poles = io::readPolePositions(folder / "nclt_truth.npz");
  std::vector<MapPole> map;
  sim::Random random(5);
  for (const Eigen::Vector2d& place : io::readPolePositions(folder / "nclt_map_8_0.50_0.08.npz")) {
    map.emplace_back();
    map.back().x = place.x();
    map.back().y = place.y();
    const bool labelled = std::any_of(things.poles.begin(), things.poles.end(),
                                      [&](const auto& pole) { return (pole - place).norm() < 1; });
    if (!labelled && random.chance(0.5)) things.clutter.push_back(place);
  }
  const io::NumberArray drive = io::NpzFile(folder / "nclt_map_8_0.50_0.08.npz").array("mappos");
  Way road;
  for (std::size_t i = 0; i < drive.shape[0]; ++i) {
    const Eigen::Vector2d place(drive.values[2 * i], drive.values[2 * i + 1]);
    if (road.empty() || (place - road.back()).norm() > 0.3) road.push_back(place);
  }
  const Count count = starts(map, things, tests::drivable(road), 200);
  EXPECT_GE(count.right, 196);
  EXPECT_LE(count.wrong, 1);
  RecordProperty("right", count.right);
  RecordProperty("wrong", count.wrong);
}

TEST(GlobalLocalizerOnMaps, FindsTheRobotOnTheRoadsOfARealDrive) {
  if (dataFolder().empty()) GTEST_SKIP() << "POLEMCL_DATA is not set";
  const Way road = tests::drivable(readRoad(dataFolder() / "tracks" / "kaist02.txt.gz"));
  ASSERT_GT(road.size(), 5000u);
  std::size_t poles[2] = {};
  for (int dense : {0, 1}) {
    tests::CityOptions options;
    options.seed = 1201;
    options.density = dense ? 4 : 1;
    const tests::PoleCity city(options, road);
    poles[dense] = city.map().size();
    const Count count = starts(city.map(), city.surroundings(), road, 200);
    EXPECT_GE(count.right, 196) << poles[dense];
    EXPECT_LE(count.wrong, 1) << poles[dense];
    RecordProperty(dense ? "rightDense" : "rightSparse", count.right);
  }
  EXPECT_LT(poles[0], 1000u);
  EXPECT_GT(poles[1], 2000u);
  RecordProperty("polesSparse", static_cast<int>(poles[0]));
  RecordProperty("polesDense", static_cast<int>(poles[1]));
}

}  // namespace polemcl::test_global_localizer_on_maps
