#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/extraction/PoleExtractor.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include "core/common/Deskew.h"
#include "sim/lidar/Scanner.h"

namespace polemcl::test_moving_scan {
namespace {
using namespace sim;
using V = Eigen::Vector3d;

constexpr double kSpeed = 15;    // m/s
constexpr double kHeight = 1.8;  // m
constexpr int kScans = 60;

/// Means over the scans of one post.
struct Seen {
  double radius = 0, x = 0, y = 0;
  int count = 0;
};

class MovingScan : public ::testing::Test {
 protected:
  /// Ten posts beside the road and one ahead, on a flat empty place.
  MovingScan() : world(worldOf()) {
    sensor.model = "os1_64";
    sensor.height = kHeight;
  }
  static std::vector<V> places() {
    std::vector<V> places{{20, 0, 0}};
    for (const double side : {-1., 1.})
      for (const double x : {-6., -3., 0., 3., 6.}) places.emplace_back(x, side * 6, 0);
    return places;
  }
  static World worldOf() {
    WorldOptions options;
    options.relief = 0;
    const Street street(std::vector<Eigen::Vector2d>{{-60, 0}, {60, 0}});
    std::vector<WorldObject> objects;
    for (const V& place : places()) {
      ObjectBuilder builder(Kind::lampPost, Site{place, 0});
      builder.post(V(0, 0, -0.2), V(0, 0, 4), radius, radius, materials::kMetal);
      objects.push_back(builder.build(static_cast<std::uint32_t>(objects.size()) + 1));
    }
    return World(options, street, Terrain(options, street, {}), std::move(objects), {});
  }
  /// The posts as seen from the middle, at a speed; corrected for it or not.
  std::vector<Seen> see(double speed, bool corrected) const {
    PoleExtractor extractor(sensor, {});
    const Scanner scanner(world, makeLidar("os1_64"));
    const ScanTiming timing{Turn::clockwise, 0.1, M_PI, 0.5};
    Motion motion;
    motion.velocity = V(speed, 0, 0);
    std::vector<Seen> seen(places().size());
    for (int i = 0; i < kScans; ++i) {
      // Elsewhere in each scan, so that the columns meet the posts elsewhere.
      const V from(0.013 * i, 0.007 * i, kHeight);
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = from;
      const SimulatedScan scan = scanner.scan(pose, i, motion);
      std::vector<PoleDetection> poles = extractor.extract(scan.view());
      for (PoleDetection& pole : poles) {
        pole.timeOffset = timing.offset(std::atan2(pole.y, pole.x));
        if (corrected) pole.turnRate = timing.turnRate();
      }
      deskew(poles, {speed, 0, 0});
      for (const PoleDetection& pole : poles)
        for (std::size_t k = 0; k < seen.size(); ++k) {
          const double dx = pole.x + from.x() - places()[k].x(),
                       dy = pole.y + from.y() - places()[k].y();
          if (std::hypot(dx, dy) > 0.3) continue;
          seen[k].radius += pole.radius;
          seen[k].x += dx;
          seen[k].y += dy;
          ++seen[k].count;
        }
    }
    for (Seen& s : seen) {
      s.radius /= s.count;
      s.x /= s.count;
      s.y /= s.count;
    }
    return seen;
  }
  static constexpr double radius = 0.15;
  World world;
  SensorOptions sensor;
};

// The beam turns clockwise: what stands to the right of the way moves with it.
TEST_F(MovingScan, PolesBesideTheRoadKeepTheirRadiusAndPlace) {
  const auto still = see(0, false), moving = see(kSpeed, false), corrected = see(kSpeed, true);
  for (std::size_t k = 0; k < still.size(); ++k) {
    EXPECT_NEAR(corrected[k].radius, still[k].radius, 0.001) << places()[k].transpose();
    EXPECT_NEAR(corrected[k].x, still[k].x, 0.002) << places()[k].transpose();
    EXPECT_NEAR(corrected[k].y, still[k].y, 0.0015) << places()[k].transpose();
    if (std::abs(places()[k].x()) > 3) continue;
    const double right = places()[k].y() < 0 ? 1 : -1;
    EXPECT_GT(right * (moving[k].radius - still[k].radius), 0.004) << places()[k].transpose();
    EXPECT_LT(moving[k].y - still[k].y, -0.003) << places()[k].transpose();
  }
}

}  // namespace
}  // namespace polemcl::test_moving_scan
