#include "LiveObjects.h"

#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CText.h>
#include <polemcl/report/LiveScene.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace polemcl::report::live {
namespace {

using mrpt::opengl::CSetOfLines;
using mrpt::opengl::CSetOfObjects;
using mrpt::opengl::CSetOfTriangles;

constexpr double aboveGround = 0.06;  // m; the grid would flicker through

mrpt::opengl::CCylinder::Ptr makePole(double x, double y, double radius, double bottom, double top,
                                      const TColor& color) {
  const auto drawn = static_cast<float>(radius);
  const auto height = static_cast<float>(std::max(top - bottom, 0.1));
  auto cylinder = mrpt::opengl::CCylinder::Create(drawn, drawn, height);
  cylinder->setSlicesCount(10);
  cylinder->setLocation(x, y, bottom);
  cylinder->setColor_u8(color);
  return cylinder;
}

mrpt::math::TPoint3Df corner(const Pose2D& pose, double ahead, double left, double z) {
  const Pose2D place = compose(pose, {ahead, left, 0});
  return {static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(z)};
}

void insertFace(CSetOfTriangles& triangles, const mrpt::math::TPoint3Df& a,
                const mrpt::math::TPoint3Df& b, const mrpt::math::TPoint3Df& c,
                const TColor& color) {
  mrpt::opengl::TTriangle triangle(a, b, c);
  triangle.computeNormals();
  triangle.setColor(color);
  triangles.insertTriangle(triangle);
}

/// A flat band along the points, its edges joined at the bends.
void insertBand(CSetOfTriangles& triangles, const std::vector<Eigen::Vector2d>& points,
                double height, double width, const TColor& color) {
  const auto edge = [&](std::size_t i, double side) {
    const Eigen::Vector2d along =
        points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0];
    const double length = along.norm();
    const Eigen::Vector2d left(-along.y(), along.x());
    const Eigen::Vector2d place = points[i] + (length > 0 ? side * width / 2 / length : 0) * left;
    return mrpt::math::TPoint3Df(static_cast<float>(place.x()), static_cast<float>(place.y()),
                                 static_cast<float>(height));
  };
  for (std::size_t i = 1; i < points.size(); ++i) {
    insertFace(triangles, edge(i - 1, -1), edge(i, -1), edge(i, 1), color);
    insertFace(triangles, edge(i - 1, -1), edge(i, 1), edge(i - 1, 1), color);
  }
}

TColor mixed(const TColor& a, const TColor& b, double share) {
  const auto mix = [&](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + share * (to - from)));
  };
  return {mix(a.R, b.R), mix(a.G, b.G), mix(a.B, b.B)};
}

}  // namespace

TColor colorOf(HealthState state) {
  if (state == HealthState::ok) return {0x00, 0x6d, 0x4e};
  return state == HealthState::degraded ? TColor(0xb3, 0x5c, 0x00) : TColor(0xc0, 0x10, 0x28);
}

CSetOfObjects::Ptr makeMap(const std::vector<MapPole>& poles) {
  auto objects = CSetOfObjects::Create();
  for (const MapPole& pole : poles)
    objects->insert(
        makePole(pole.x, pole.y, std::max(pole.radius, 0.08), pole.bottom, pole.top, mapColor));
  return objects;
}

mrpt::opengl::CPointCloudColoured::Ptr makeDots(const std::vector<MapPole>& poles,
                                                double pointSize) {
  auto points = mrpt::opengl::CPointCloudColoured::Create();
  for (const MapPole& pole : poles)
    points->insertPoint({static_cast<float>(pole.x), static_cast<float>(pole.y), 0.1f, mapColor.R,
                         mapColor.G, mapColor.B, 0xff});
  points->setPointSize(static_cast<float>(pointSize));
  return points;
}

CSetOfObjects::Ptr makeObserved(const LiveMoment& moment, bool matched) {
  if (!moment.estimate || moment.matches.size() != moment.poles_robot.size()) return nullptr;
  constexpr double sleeve = 0.12;  // m wider than the pole, so that it shows round a map pole
  constexpr double eye = 1.0;      // m above ground, where the lines of sight begin
  const TColor& color = matched ? matchedColor : unmatchedColor;
  const Pose2D& robot = moment.estimate->mean;
  auto objects = CSetOfObjects::Create();
  auto sights = CSetOfLines::Create();
  sights->setColor_u8(TColor(color.R, color.G, color.B, 0x90));
  sights->setLineWidth(1);
  for (std::size_t i = 0; i < moment.poles_robot.size(); ++i) {
    if (moment.matches[i].matched != matched) continue;
    const PoleDetection& pole = moment.poles_robot[i];
    const Pose2D place = compose(robot, {pole.x, pole.y, 0});
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) continue;
    objects->insert(makePole(place.x, place.y, pole.radius + sleeve, pole.bottom, pole.top, color));
    sights->appendLine(robot.x, robot.y, eye, place.x, place.y, eye);
  }
  if (sights->empty()) return nullptr;
  objects->insert(sights);
  return objects;
}

CSetOfTriangles::Ptr makeWay(const std::vector<WayPoint>& way) {
  constexpr double width = 0.3;  // m
  auto bands = CSetOfTriangles::Create();
  std::vector<Eigen::Vector2d> line;
  const auto finish = [&] {
    insertBand(*bands, line, aboveGround, width, wayColor);
    line.clear();
  };
  for (const WayPoint& point : way) {
    if (!point.joined) finish();
    line.emplace_back(point.x, point.y);
  }
  finish();
  if (bands->getTrianglesCount() == 0) return nullptr;
  bands->setColor_u8(wayColor);
  return bands;
}

CSetOfObjects::Ptr makeArrow(const Pose2D& pose, double length, const TColor& color) {
  // A flat pyramid: a ridge from the tail to the tip, so that light tells the two sides apart.
  const double half = length / 2, wide = 0.32 * length, high = 0.22 * length;
  const auto tip = corner(pose, half, 0, 0.1), notch = corner(pose, -0.6 * half, 0, 0.1),
             left = corner(pose, -half, wide, 0.1), right = corner(pose, -half, -wide, 0.1),
             ridge = corner(pose, -0.4 * half, 0, 0.1 + high);
  auto triangles = CSetOfTriangles::Create();
  insertFace(*triangles, tip, left, ridge, color);
  insertFace(*triangles, tip, ridge, right, color);
  insertFace(*triangles, notch, ridge, left, color);
  insertFace(*triangles, notch, right, ridge, color);
  triangles->setColor_u8(color);
  auto arrow = CSetOfObjects::Create();
  arrow->insert(triangles);
  return arrow;
}

CSetOfObjects::Ptr makeHypotheses(const std::vector<GlobalHypothesis>& places, double length,
                                  int letters) {
  if (places.empty()) return nullptr;
  auto objects = CSetOfObjects::Create();
  for (const GlobalHypothesis& place : places) {
    // Those that nothing speaks for are small, but there.
    const double size = length * (0.4 + 0.6 * std::clamp(place.weight, 0.0, 1.0));
    objects->insert(makeArrow(place.pose_map_robot, size, hypothesisColor));
    auto share = mrpt::opengl::CText::Create(
        std::to_string(std::lround(100 * std::clamp(place.weight, 0.0, 1.0))) + "%");
    share->setFont("sans", letters);
    share->setColor_u8(hypothesisColor);
    share->setLocation(place.pose_map_robot.x, place.pose_map_robot.y, 0.5 * size);
    if (place.weight >= 0.01) objects->insert(share);
  }
  return objects;
}

mrpt::opengl::CPointCloudColoured::Ptr makeParticles(const LiveMoment& moment, double height,
                                                     double pointSize) {
  if (moment.particles.empty()) return nullptr;
  std::vector<std::size_t> order(moment.particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return moment.weights[a] < moment.weights[b];
  });
  auto points = mrpt::opengl::CPointCloudColoured::Create();
  points->reserve(order.size());
  for (std::size_t i : order) {
    const TColor color = mixed(particleLight, particleColor, moment.weights[i]);
    points->insertPoint({static_cast<float>(moment.particles[i].x),
                         static_cast<float>(moment.particles[i].y), static_cast<float>(height),
                         color.R, color.G, color.B, 0xff});
  }
  points->setPointSize(static_cast<float>(pointSize));
  return points;
}

CSetOfTriangles::Ptr makeEllipse(const PoseWithCovariance& pose, double height, double width) {
  const TColor color(0x10, 0x10, 0x10);
  auto band = CSetOfTriangles::Create();
  insertBand(*band, ellipse95(pose), height, width, color);
  band->setColor_u8(color);
  return band;
}

}  // namespace polemcl::report::live
