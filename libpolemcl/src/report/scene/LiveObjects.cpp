#include "report/scene/LiveObjects.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <polemcl/mrpt/common/Compatibility.h>
#include "report/scene/LiveScene.h"

namespace polemcl::report::live {
namespace {

using viz::CSetOfLines;
using viz::CSetOfObjects;
using viz::CSetOfTriangles;

constexpr double aboveGround = 0.1;  // m; the grid would flicker through

Eigen::Vector3d corner(const Pose2D& pose, double ahead, double left, double z) {
  const Pose2D place = compose(pose, {ahead, left, 0});
  return {place.x, place.y, z};
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

TColor pathColorOf(HealthState state) {
  if (state == HealthState::ok) return scene::estimateColor;
  return state == HealthState::degraded ? TColor(0xf0, 0xb0, 0x00) : colorOf(state);
}

CSetOfObjects::Ptr makeMap(const std::vector<MapPole>& poles) {
  auto objects = CSetOfObjects::Create();
  for (const MapPole& pole : poles)
    scene::drawPole(*objects, pole.x, pole.y, std::max(pole.radius, 0.08), pole.bottom, pole.top,
                    mapColor);
  return objects;
}

viz::CPointCloudColoured::Ptr makeDots(const std::vector<MapPole>& poles, double pointSize) {
  std::vector<scene::Dot> dots;
  dots.reserve(poles.size());
  for (const MapPole& pole : poles) dots.push_back({{pole.x, pole.y, 0.1}, mapColor});
  return scene::makeDots(dots, pointSize);
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
    scene::drawPole(*objects, place.x, place.y, pole.radius + sleeve, pole.bottom, pole.top, color);
    sights->appendLine(robot.x, robot.y, eye, place.x, place.y, eye);
  }
  if (sights->empty()) return nullptr;
  objects->insert(sights);
  return objects;
}

namespace {

/// \param colorAt Of the band that leads to a point.
template <class ColorAt>
CSetOfTriangles::Ptr makeBands(const std::vector<WayPoint>& way, double height, double width,
                               const ColorAt& colorAt) {
  auto bands = CSetOfTriangles::Create();
  scene::Path line;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (!way[i].joined) line.clear();
    line.emplace_back(way[i].x, way[i].y);
    const bool goesOn = i + 1 < way.size() && way[i + 1].joined;
    if (goesOn && (line.size() == 1 || way[i + 1].state == way[i].state)) continue;
    scene::insertRibbon(*bands, line, height, width, colorAt(way[i]));
    line.erase(line.begin(), line.end() - 1);  // the next band begins where this one ends
  }
  if (bands->getTrianglesCount() == 0) return nullptr;
  scene::setColor(*bands, colorAt(way.back()));
  return bands;
}

}  // namespace

CSetOfTriangles::Ptr makeWay(const std::vector<WayPoint>& way) {
  constexpr double width = 0.6;  // m
  return makeBands(way, aboveGround, width,
                   [](const WayPoint& point) { return pathColorOf(point.state); });
}

CSetOfTriangles::Ptr makeTrueWay(const std::vector<WayPoint>& way, double width) {
  return makeBands(way, 3 * aboveGround, width, [](const WayPoint&) { return scene::truthColor; });
}

viz::CPointCloudColoured::Ptr makePoints(const LiveMoment& moment, double pointSize) {
  if (!moment.estimate || moment.points_robot.empty()) return nullptr;
  constexpr double high = 5;  // m above ground, from where on they are darkest
  std::vector<scene::Dot> dots;
  dots.reserve(moment.points_robot.size());
  for (const auto& point : moment.points_robot) {
    const Pose2D place = compose(moment.estimate->mean, {point.x, point.y, 0});
    const double share = std::clamp(point.z / high, 0.0, 1.0);
    dots.push_back({{place.x, place.y, point.z}, mixed(lowPoint, highPoint, share)});
  }
  return scene::makeDots(dots, pointSize);
}

CSetOfObjects::Ptr makeArrow(const Pose2D& pose, double length, const TColor& color) {
  // A flat pyramid: a ridge from the tail to the tip, so that light tells the two sides apart.
  const double half = length / 2, wide = 0.32 * length, high = 0.22 * length;
  const auto tip = corner(pose, half, 0, 0.1), notch = corner(pose, -0.6 * half, 0, 0.1),
             left = corner(pose, -half, wide, 0.1), right = corner(pose, -half, -wide, 0.1),
             ridge = corner(pose, -0.4 * half, 0, 0.1 + high);
  auto triangles = CSetOfTriangles::Create();
  scene::insertFace(*triangles, tip, left, ridge, color);
  scene::insertFace(*triangles, tip, ridge, right, color);
  scene::insertFace(*triangles, notch, ridge, left, color);
  scene::insertFace(*triangles, notch, right, ridge, color);
  scene::setColor(*triangles, color);
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
    auto share = viz::CText::Create(
        std::to_string(std::lround(100 * std::clamp(place.weight, 0.0, 1.0))) + "%");
    share->setFont("sans", letters);
    share->setColor_u8(hypothesisColor);
    share->setLocation(place.pose_map_robot.x, place.pose_map_robot.y, 0.5 * size);
    if (place.weight >= 0.01) objects->insert(share);
  }
  return objects;
}

viz::CPointCloudColoured::Ptr makeParticles(const LiveMoment& moment, double height,
                                            double pointSize) {
  if (moment.particles.empty()) return nullptr;
  std::vector<std::size_t> order(moment.particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return moment.weights[a] < moment.weights[b];
  });
  std::vector<scene::Dot> dots;
  dots.reserve(order.size());
  for (std::size_t i : order)
    dots.push_back({{moment.particles[i].x, moment.particles[i].y, height},
                    mixed(particleLight, particleColor, moment.weights[i])});
  return scene::makeDots(dots, pointSize);
}

CSetOfTriangles::Ptr makeEllipse(const PoseWithCovariance& pose, double height, double width) {
  auto band = CSetOfTriangles::Create();
  scene::insertRibbon(*band, ellipse95(pose), height, width, ellipseColor);
  scene::setColor(*band, ellipseColor);
  return band;
}

}  // namespace polemcl::report::live
