// Global localization where poles and roads are real: a published map of a campus against
// poles labelled by hand, and the roads of a city drive.

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include "core/global_localization/GlobalLocalizer.h"
#include "io/file/Npz.h"
#include "io/map/PoleTables.h"
#include "support/PoleCity.h"
#include "support/TempFolder.h"

namespace polemcl::test_global_localizer_on_maps {
namespace {

using testing_apps::dataFolder;
using tests::Way;

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

/// Poles, trunks and signs that a network found on a real drive (HeLiPR): gzipped lines
/// x,y,z,class. The file has each thing several times, about half a metre apart.
std::vector<Eigen::Vector2d> readConstellation(const std::filesystem::path& file) {
  std::vector<Eigen::Vector2d> poles;
  gzFile stream = gzopen(file.c_str(), "rb");
  char line[256];
  double x = 0, y = 0;
  while (stream && gzgets(stream, line, sizeof line)) {
    if (std::sscanf(line, "%lf,%lf", &x, &y) != 2) continue;  // the header
    const Eigen::Vector2d place(x, y);
    if (std::none_of(poles.begin(), poles.end(),
                     [&](const Eigen::Vector2d& pole) { return (pole - place).norm() < 1; }))
      poles.push_back(place);
  }
  if (stream) gzclose(stream);
  return poles;
}

/// The direction in which the poles within 30 m are spread most: along the street.
double alongStreet(const std::vector<Eigen::Vector2d>& poles, const Eigen::Vector2d& place) {
  double xx = 0, xy = 0, yy = 0;
  for (const Eigen::Vector2d& pole : poles) {
    const Eigen::Vector2d d = pole - place;
    if (d.norm() > 30) continue;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  return 0.5 * std::atan2(2 * xy, xx - yy);
}

double clearance(const std::vector<Eigen::Vector2d>& poles, const Eigen::Vector2d& place) {
  double least = 1e9;
  for (const Eigen::Vector2d& pole : poles) least = std::min(least, (pole - place).norm());
  return least;
}

/// 61 m of a drive among the poles: it begins 3 to 8 m beside one of them, along the street, and
/// steers where there is room. None that comes nearer than 1.5 m to a pole, or has none within 15
/// m.
Way drawnAmong(const std::vector<Eigen::Vector2d>& poles, sim::Random& random) {
  for (;;) {
    const Eigen::Vector2d& beside = poles[random.below(static_cast<int>(poles.size()))];
    const double bearing = random.uniform(-M_PI, M_PI), range = random.uniform(3, 8);
    Way way{beside + range * Eigen::Vector2d(std::cos(bearing), std::sin(bearing))};
    double heading = alongStreet(poles, way[0]) + (random.chance(0.5) ? M_PI : 0);
    while (way.size() < 61) {
      double best = -1e9, turn = 0;
      for (const double change : {-0.08, -0.04, 0.0, 0.04, 0.08}) {
        const Eigen::Vector2d ahead(std::cos(heading + change), std::sin(heading + change));
        const double room = std::min({clearance(poles, way.back() + 3 * ahead),
                                      clearance(poles, way.back() + 8 * ahead), 5.0});
        if (room - 5 * std::abs(change) > best) best = room - 5 * std::abs(change), turn = change;
      }
      heading += turn;
      way.emplace_back(way.back() + Eigen::Vector2d(std::cos(heading), std::sin(heading)));
      const double room = clearance(poles, way.back());
      if (room < 1.5 || room > 15) break;
    }
    if (way.size() == 61) return way;
  }
}

struct Count {
  int right = 0, wrong = 0;  ///< the others stay undecided
};

/// Starts on ways of 61 m, asks every five metres, takes the first answer.
Count starts(const std::vector<MapPole>& map, const tests::Surroundings& things,
             const std::function<Way(sim::Random&)>& drawWay, int count) {
  const GlobalLocalizer localizer(map);
  sim::Random random(2024);
  Count result;
  for (int i = 0; i < count; ++i) {
    LocalSubmap submap;
    bool resolved = false;
    for (const tests::Frame& frame : tests::drive(things, drawWay(random), {}, random)) {
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
  const Way smooth = tests::drivable(road);
  const Count count = starts(
      map, things, [&](sim::Random& r) { return pieceOf(smooth, r); }, 200);
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
    const Count count = starts(
        city.map(), city.surroundings(), [&](sim::Random& r) { return pieceOf(road, r); }, 200);
    EXPECT_GE(count.right, 196) << poles[dense];
    EXPECT_LE(count.wrong, 1) << poles[dense];
    RecordProperty(dense ? "rightDense" : "rightSparse", count.right);
  }
  EXPECT_LT(poles[0], 1000u);
  EXPECT_GT(poles[1], 2000u);
  RecordProperty("polesSparse", static_cast<int>(poles[0]));
  RecordProperty("polesDense", static_cast<int>(poles[1]));
}

/// Where poles stand in two real cities, as a network found them. The map lacks 10 % of them,
/// 5 % of the map's are gone, and detections are drawn. No setting was chosen on these maps.
TEST(GlobalLocalizerOnMaps, FindsTheRobotAmongThePolesOfRealCities) {
  if (dataFolder().empty()) GTEST_SKIP() << "POLEMCL_DATA is not set";
  for (const char* name : {"KAIST04", "DCC04"}) {
    const auto poles =
        readConstellation(dataFolder() / "real_pole_maps" / (std::string(name) + ".csv.gz"));
    ASSERT_GT(poles.size(), 1000u) << name;
    tests::CityOptions options;
    options.seed = 1301;
    const auto city = tests::PoleCity::ofPoles(options, poles);
    const Count count = starts(
        city.map(), city.surroundings(), [&](sim::Random& r) { return drawnAmong(poles, r); }, 200);
    EXPECT_GE(count.right, 196) << name;
    EXPECT_LE(count.wrong, 1) << name;
    RecordProperty(std::string("right") + name, count.right);
    RecordProperty(std::string("wrong") + name, count.wrong);
    RecordProperty(std::string("poles") + name, static_cast<int>(city.map().size()));
  }
}

}  // namespace
}  // namespace polemcl::test_global_localizer_on_maps
