#pragma once
// A yard with four poles and no other vertical objects, for extraction.

#include <algorithm>
#include <cmath>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "support/RayCast.h"

namespace polemcl::clouds {

constexpr double kSensorHeight = 1.5;  ///< above ground, m

/// \brief Four poles of 3.2 m, one of them behind the sensor at azimuth ±180°; ground; walls.
inline Scene yard() {
  Scene scene;
  const double top = 3.2 - kSensorHeight;
  for (const auto& [x, y] :
       std::vector<std::pair<double, double>>{{8, 3}, {-9, 0}, {9, -7}, {-6, 7}})
    scene.cylinders.push_back({x, y, 0.1, -3, top});
  scene.walls = {{30, -30, 30, 30}, {30, 30, -30, 30}, {-30, 30, -30, -30}, {-30, -30, 30, -30}};
  for (Wall& wall : scene.walls) wall.top = 6;
  scene.ground = GroundPlane{-kSensorHeight, 0, 0};
  return scene;
}

inline SensorOptions sensorOptions(const std::string& model, bool upsideDown = false) {
  SensorOptions options;
  options.model = model;
  options.upsideDown = upsideDown;
  options.height = kSensorHeight;
  return options;
}

inline PointList castYard(const SensorOptions& sensor, const Scene& scene = yard()) {
  return cast(scene, SensorModel(sensor), {0.015, 0, 5});
}

/// \brief The detection nearest to a place; null if none is within `reach` m.
inline const PoleDetection* nearest(const std::vector<PoleDetection>& poles, double x, double y,
                                    double reach) {
  const PoleDetection* best = nullptr;
  for (const PoleDetection& p : poles) {
    const double distance = std::hypot(p.x - x, p.y - y);
    if (distance < reach) {
      reach = distance;
      best = &p;
    }
  }
  return best;
}

/// \brief Equal to the last bit.
inline bool same(const PoleDetection& a, const PoleDetection& b) {
  return a.x == b.x && a.y == b.y && a.radius == b.radius && a.bottom == b.bottom &&
         a.top == b.top && a.confidence == b.confidence && a.covariance == b.covariance &&
         a.points == b.points;
}
inline bool same(const std::vector<PoleDetection>& a, const std::vector<PoleDetection>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(),
                    [](const PoleDetection& p, const PoleDetection& q) { return same(p, q); });
}

/// \brief Number of rejections for all reasons.
inline std::size_t refused(const ExtractionReport& report) {
  std::size_t sum = 0;
  for (const std::size_t n : report.refused) sum += n;
  return sum;
}

}  // namespace polemcl::clouds
