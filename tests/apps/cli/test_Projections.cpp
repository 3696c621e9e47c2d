#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cli/Projections.h"
#include "support/ExpectHas.h"
#include "support/Refusal.h"

namespace polemcl::test_projections {
namespace {

using namespace polemcl::apps;
using testing_apps::messageOf;

constexpr double kDegree = M_PI / 180;

/// WGS 84 by its definition: the axes of the ellipsoid, and nothing of PROJ.
Eigen::Vector3d upAt(double lat, double lon) {
  return {std::cos(lat * kDegree) * std::cos(lon * kDegree),
          std::cos(lat * kDegree) * std::sin(lon * kDegree), std::sin(lat * kDegree)};
}
Eigen::Vector3d surfaceAt(double lat, double lon) {
  const double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f);
  const Eigen::Vector3d up = upAt(lat, lon);
  const double n = a / std::sqrt(1 - e2 * up.z() * up.z());
  return {n * up.x(), n * up.y(), n * (1 - e2) * up.z()};
}

/// A place of the map, in space: x turned by yaw from east.
Eigen::Vector3d inSpace(const Eigen::Vector2d& place, const io::Datum& datum) {
  const Eigen::Vector3d up = upAt(datum.latitude, datum.longitude);
  const double lon = datum.longitude * kDegree;
  const Eigen::Vector3d east(-std::sin(lon), std::cos(lon), 0);
  const Eigen::Vector3d north = up.cross(east);
  const double c = std::cos(datum.yawDeg * kDegree), s = std::sin(datum.yawDeg * kDegree);
  return surfaceAt(datum.latitude, datum.longitude) + (c * place.x() - s * place.y()) * east +
         (s * place.x() + c * place.y()) * north;
}

const std::vector<io::Datum> datums{
    {42.293227, -83.709657, 0}, {0, 0, 0},        {50.7, 7.1, 90},
    {-33.9, 151.2, -137.5},     {78.2, 15.6, 12}, {36.37, 127.36, 1},
    {1e-7, -1e-7, 0},           {90, 0, 0},       {-90, 12, 45}};

// Against Krüger's series.
TEST(CoordinateSystem, KnowsUtm) {
  const CoordinateSystem utm("EPSG:32633");
  const Eigen::Vector2d found = utm.lonLat({224681.943, 7023875.719});
  EXPECT_NEAR(found.x(), 9.514946883, 1e-9);
  EXPECT_NEAR(found.y(), 63.237904369, 1e-9);
  EXPECT_EQ(CoordinateSystem("EPSG:4326").lonLat(found), found);
}

TEST(MapPlane, PlacesStandAboveTheirLongitudeAndLatitude) {
  for (const io::Datum& datum : datums)
    for (const Eigen::Vector2d& place :
         {Eigen::Vector2d(0, 0), Eigen::Vector2d(10, 0), Eigen::Vector2d(0, 10),
          Eigen::Vector2d(-3000, 2000), Eigen::Vector2d(30000, -40000)}) {
      SCOPED_TRACE(io::datumText(datum) + " " + std::to_string(place.x()));
      const MapPlane plane(datum);
      const Eigen::Vector2d found = plane.lonLat(place);
      const Eigen::Vector3d up = upAt(found.y(), found.x());
      const Eigen::Vector3d off = inSpace(place, datum) - surfaceAt(found.y(), found.x());
      EXPECT_LT(off.cross(up).norm(), 1e-6);  // nothing but height is between
      const Eigen::Vector2d back = plane.place(found);
      EXPECT_LT((back - place).norm(), 1e-6);
    }
}

TEST(MapPlane, EastIsEastAndNorthIsNorth) {
  const Eigen::Vector2d east = MapPlane({50, 8, 0}).lonLat({100, 0}),
                        turned = MapPlane({50, 8, 90}).lonLat({100, 0});
  EXPECT_NEAR(east.x() - 8, 100 / (111320 * std::cos(50 * kDegree)), 1e-5);
  EXPECT_NEAR(east.y(), 50, 1e-7);
  EXPECT_NEAR(turned.x(), 8, 1e-9);
  EXPECT_NEAR(turned.y() - 50, 100 / 111229.0, 1e-5);
}

TEST(MapPlane, RefusesPlacesFarFromTheDatum) {
  const MapPlane plane({50, 8, 0});
  EXPECT_HAS(messageOf([&] { plane.lonLat({1e5, 0}); }), "100 km from the datum 50,8,0");
  EXPECT_HAS(messageOf([&] { plane.place({8, 51}); }), "111 km from the datum 50,8,0");
  EXPECT_HAS(messageOf([&] { plane.place({50, 8}); }), "longitude comes first");
  EXPECT_HAS(messageOf([&] { plane.place({8, -50}); }), "is not on the same map");
}

}  // namespace
}  // namespace polemcl::test_projections
