#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>

#include "sim/world/Street.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_street {
namespace {

using namespace polemcl::sim;

class Street_Track : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (m_folder / name).string(); }
  /// Poses every metre along x, y = 3.
  static std::string trackText(int count) {
    std::string text = "# a track\n";
    for (int i = 0; i < count; ++i) text += "1 0 0 " + std::to_string(i) + " 0 1 0 3 0 0 1 0.5\n";
    return text;
  }

 private:
  testing_apps::TempFolder m_folder;
};
TEST(Street, StraightOneByHand) {
  const Street street(std::vector<Eigen::Vector2d>{{0, 0}, {30, 40}});  // 3-4-5
  EXPECT_NEAR(street.length(), 50, 1e-9);
  const Pose2D middle = street.at(25);
  EXPECT_NEAR(middle.x, 15, 1e-9);
  EXPECT_NEAR(middle.y, 20, 1e-9);
  EXPECT_NEAR(middle.yaw, std::atan2(4, 3), 1e-9);
  const Pose2D left = street.at(25, 5);  // left of (0.6, 0.8) is (-0.8, 0.6)
  EXPECT_NEAR(left.x, 11, 1e-9);
  EXPECT_NEAR(left.y, 23, 1e-9);
  EXPECT_NEAR(street.at(-3).x, 0, 1e-9) << "clamped to the street";
  EXPECT_NEAR(street.at(99).y, 40, 1e-9);
}

TEST(Street, GeneratedOneHasItsLengthAndGentleBends) {
  for (int seed = 1; seed <= 10; ++seed) {
    WorldOptions options;
    options.seed = seed;
    options.length = 800;
    const Street street = Street::make(options);
    EXPECT_NEAR(street.length(), 800, 1.0);
    for (double s = 5; s < 790; s += 5) {
      const double turn = wrapAngle(street.at(s + 5).yaw - street.at(s).yaw);
      ASSERT_LT(std::abs(turn) / 5, 1.0 / 100) << "radius under 100 m";
    }
  }
}

TEST(Street, NoCurvinessMeansStraight) {
  WorldOptions options;
  options.curviness = 0;
  const Street street = Street::make(options);
  const Pose2D a = street.at(0), b = street.at(street.length());
  EXPECT_NEAR(std::hypot(b.x - a.x, b.y - a.y), street.length(), 1e-6);
}

TEST(Street, DistanceEqualsBruteForce) {
  WorldOptions options;
  const Street street = Street::make(options);
  for (int i = 0; i < 200; ++i) {
    const double x = street.at(150).x + 60 * std::sin(i * 1.3),
                 y = street.at(150).y + 60 * std::cos(i * 0.7);
    double nearest = 1e9;
    for (const auto& point : street.points())
      nearest = std::min(nearest, (point - Eigen::Vector2d(x, y)).norm());
    EXPECT_NEAR(street.distance(x, y, 20), std::min(nearest, 20.0), 1e-9);
  }
}

TEST(Street, TheSecondPassOfARoadIsNotFresh) {
  std::vector<Eigen::Vector2d> places;  // 100 m out, back 4 m beside, then 100 m elsewhere
  for (int i = 0; i <= 100; ++i) places.emplace_back(i, 0);
  for (int i = 100; i >= 0; --i) places.emplace_back(i, 4);
  for (int i = 0; i <= 100; ++i) places.emplace_back(-i, 40);
  const Street street(places);
  EXPECT_TRUE(street.fresh(50));
  EXPECT_FALSE(street.fresh(154)) << "on the way back";
  EXPECT_TRUE(street.fresh(street.length() - 50));
}

TEST(Street, RefusesLessThanTwoPlaces) {
  EXPECT_THROW(Street(std::vector<Eigen::Vector2d>{{1, 1}}), Error);
  EXPECT_THROW(Street(std::vector<Eigen::Vector2d>{{1, 1}, {1.1, 1}}), Error) << "10 cm apart";
}

TEST_F(Street_Track, PlainAndGzipGiveTheSameRoad) {
  const std::string text = trackText(40);
  std::ofstream(path("track.txt")) << text;
  const gzFile packed = gzopen(path("track.txt.gz").c_str(), "wb");
  gzwrite(packed, text.data(), static_cast<unsigned>(text.size()));
  gzclose(packed);
  for (const char* file : {"track.txt", "track.txt.gz"}) {
    WorldOptions options;
    options.track = path(file);
    const Street street = Street::make(options);
    EXPECT_NEAR(street.length(), 39, 1e-9) << file;
    EXPECT_NEAR(street.at(10).x, 10, 1e-9) << file;
    EXPECT_NEAR(street.at(10).y, 3, 1e-9) << file;
  }
}

TEST_F(Street_Track, RefusesAMissingFileAndALineOfElevenNumbers) {
  WorldOptions options;
  options.track = path("nowhere.txt");
  EXPECT_THROW(Street::make(options), Error);
  options.track = path("short.txt");
  std::ofstream(options.track) << trackText(3) << "1 0 0 4 0 1 0 3 0 0 1\n";
  EXPECT_REFUSED(Street::make(options), "short.txt:5");
}

}  // namespace
}  // namespace polemcl::test_street
