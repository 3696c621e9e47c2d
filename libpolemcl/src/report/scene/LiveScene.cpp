#include "report/scene/LiveScene.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <utility>

#include "core/common/Angles.h"
#include "core/common/Covariance.h"
#include "core/common/TickStep.h"
#include "report/picture/MapView.h"
#include "report/scene/LiveObjects.h"

namespace polemcl::report {
namespace {

using namespace live;
using scene::put;
using viz::Viewport;

/// As printf, for short lines.
__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...) {
  char text[160];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

viz::CGridPlaneXY::Ptr makeGrid(double x, double y, double half, double step) {
  const Eigen::Vector2d centre(x, y), reach(half, half);
  return scene::makeGround({centre - reach, centre + reach}, step);
}

/// Above the vehicle, which it would hide.
viz::CSetOfObjects::Ptr makeTruth(const Pose2D& truth, double length) {
  auto arrow = makeArrow(truth, length, scene::truthColor);
  arrow->setLocation(0, 0, 1);
  return arrow;
}

/// As seen from another origin; the axes stay.
LiveMoment movedBy(LiveMoment moment, const Eigen::Vector2d& origin) {
  const auto move = [&](auto& place) { place.x -= origin.x(), place.y -= origin.y(); };
  if (moment.estimate) move(moment.estimate->mean);
  for (Pose2D& particle : moment.particles) move(particle);
  for (GlobalHypothesis& place : moment.hypotheses) move(place.pose_map_robot);
  for (auto* way : {&moment.way, &moment.trueWay})
    for (WayPoint& point : *way) move(point);
  if (moment.truth) move(*moment.truth);
  return moment;
}

}  // namespace

std::vector<Eigen::Vector2d> ellipse95(const PoseWithCovariance& pose, int corners) {
  // Without a covariance, the ellipse is a point.
  const PrincipalAxes axes =
      principalAxes(pose.covariance.topLeftCorner<2, 2>()).value_or(PrincipalAxes());
  const double radius = std::sqrt(-2 * std::log(0.05));  // of 95 %, two degrees of freedom
  const Eigen::Vector2d first = radius * std::sqrt(axes.first) * Eigen::Vector2d(axes.x, axes.y);
  const Eigen::Vector2d second = radius * std::sqrt(axes.second) * Eigen::Vector2d(-axes.y, axes.x);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * M_PI * (i % corners) / corners;
    points.emplace_back(Eigen::Vector2d(pose.mean.x, pose.mean.y) + std::cos(angle) * first +
                        std::sin(angle) * second);
  }
  return points;
}

std::vector<std::string> describe(const LiveMoment& moment) {
  const Health& health = moment.health;
  std::string state = name(health.state);
  if (health.state != HealthState::ok) state += std::string(": ") + name(health.reason);
  const auto onMap = std::count_if(moment.matches.begin(), moment.matches.end(),
                                   [](const PoleMatch& match) { return match.matched; });
  std::vector<std::string> lines{state, line("time %.1f s, scan %zu", moment.elapsed, moment.scan)};
  if (moment.relocalized) lines.push_back("found by the search");
  if (!moment.estimate) {
    lines.push_back(line("observed poles %zu, places %zu", moment.poles_robot.size(),
                         moment.hypotheses.size()));
    return lines;
  }
  const Pose2D& pose = moment.estimate->mean;
  lines.push_back(line("at %.2f %.2f m, %.1f deg", pose.x, pose.y, pose.yaw / degree));
  lines.push_back(line("matched %.0f %%, now %d of %zu", 100 * health.matchedShare,
                       static_cast<int>(onMap), moment.poles_robot.size()));
  lines.push_back(line("spread %.3f m, %.2f deg", health.spread, health.spreadHeading / degree));
  lines.push_back(
      line("particles %zu, effective %.0f", moment.step.particles, health.effectiveParticles));
  if (const auto error = positionError(moment))
    lines.push_back(
        line("error %.3f m, %.2f deg", *error, wrapAngle(pose.yaw - moment.truth->yaw) / degree));
  return lines;
}

LiveScene::LiveScene(const std::vector<MapPole>& map, std::string title, double textScale)
    : m_title(std::move(title)), m_textScale(textScale), m_map(map), m_scene(viz::Scene::Create()) {
  MapView view;
  view.poles = map;
  const Bounds bounds = boundsOf(view);
  const Eigen::AlignedBox2d box_map(Eigen::Vector2d(bounds.xMin, bounds.yMin),
                                    Eigen::Vector2d(bounds.xMax, bounds.yMax));
  m_origin = scene::originFor(box_map);
  for (MapPole& pole : m_map) pole.x -= m_origin.x(), pole.y -= m_origin.y();
  m_centre = box_map.center() - m_origin;
  m_extent = std::max(box_map.sizes().maxCoeff(), 20.0);
  const auto viewport = m_scene->getViewport();
  scene::prepare(*viewport);
  viewport->setViewportClipDistances(0.5f, static_cast<float>(std::max(6 * m_extent, 2000.0)));
  put(*viewport, "map", makeMap(m_map));
  m_scene->enableFollowCamera(true);
}

const viz::CCamera& LiveScene::camera() const {
  return m_scene->getViewport()->getCamera();
}

void LiveScene::show(const LiveMoment& moment) {
  const LiveMoment moved = movedBy(moment, m_origin);
  aim(moved);
  showObjects(moved);
  showClose(moment);
  showText(moment);
}

void LiveScene::aim(const LiveMoment& moment) {
  auto& camera = m_scene->getViewport()->getCamera();
  if (!moment.estimate) {
    m_aimed.reset();
    camera.setPointingAt(static_cast<float>(m_centre.x()), static_cast<float>(m_centre.y()), 0);
    constexpr double farthest = 8000;  // m; SceneViewer3D draws up to 10 km
    camera.setZoomDistance(static_cast<float>(std::min(2.1 * m_extent, farthest)));
    camera.setAzimuthDegrees(-90);
    camera.setElevationDegrees(80);
    return;
  }
  constexpr double ahead = 7, gentle = 12;  // m
  const Pose2D& pose = moment.estimate->mean;
  double heading = pose.yaw;
  if (m_aimed && !moment.relocalized) {
    const double driven = std::hypot(pose.x - m_aimed->x, pose.y - m_aimed->y);
    heading = m_aimed->yaw + wrapAngle(pose.yaw - m_aimed->yaw) * (1 - std::exp(-driven / gentle));
  }
  m_aimed = Pose2D{pose.x, pose.y, wrapAngle(heading)};
  const Pose2D target = compose(*m_aimed, {ahead, 0, 0});
  camera.setPointingAt(static_cast<float>(target.x), static_cast<float>(target.y), 1);
  camera.setZoomDistance(56);
  camera.setAzimuthDegrees(static_cast<float>(heading / degree + 180));
  camera.setElevationDegrees(28);
}

void LiveScene::showObjects(const LiveMoment& moment) {
  Viewport& viewport = *m_scene->getViewport();
  const bool known = moment.estimate.has_value();
  const Pose2D pose = known ? moment.estimate->mean : Pose2D{m_centre.x(), m_centre.y(), 0};
  const double length = known ? 5 : std::max(0.04 * m_extent, 5.0);
  put(viewport, "ground",
      known ? makeGrid(pose.x, pose.y, 150, 5)
            : makeGrid(pose.x, pose.y, 0.6 * m_extent, tickStep(m_extent, 40)));
  put(viewport, "dots", known ? nullptr : makeDots(m_map, 4 * m_textScale));
  put(viewport, "way", makeWay(moment.way));
  put(viewport, "true_way", makeTrueWay(moment.trueWay, known ? 0.2 : 0.004 * m_extent));
  put(viewport, "true_vehicle",
      moment.truth ? makeTruth(*moment.truth, known ? 1.5 : 0.6 * length) : nullptr);
  put(viewport, "points", makePoints(moment, 2 * m_textScale));
  put(viewport, "vehicle", known ? makeArrow(pose, 3, colorOf(moment.health.state)) : nullptr);
  put(viewport, "ellipse", known ? makeEllipse(*moment.estimate, 0.1, 0.08) : nullptr);
  put(viewport, "particles", makeParticles(moment, 0.15, 3 * m_textScale));
  put(viewport, "matched", makeObserved(moment, true));
  put(viewport, "unmatched", makeObserved(moment, false));
  put(viewport, "hypotheses",
      makeHypotheses(moment.hypotheses, length, static_cast<int>(16 * m_textScale)));
}

void LiveScene::showClose(const LiveMoment& moment) {
  Viewport& viewport = scene::panelOf(*m_scene, "close", m_textScale);
  Viewport& caption = scene::panelOf(*m_scene, "caption", m_textScale);
  if (!moment.estimate) {
    for (Viewport* panel : {&viewport, &caption}) scene::hidePanel(*panel);
    return;
  }
  // Steps, so that it does not breathe with every update.
  const double spread = largestSigma(moment.estimate->covariance.topLeftCorner<2, 2>());
  const double half = tickStep(3 * std::max(spread, 0.005), 1);
  const double step = tickStep(2 * half, 8);
  caption.setViewportPosition(0.75, 0.02, 0.24, 0.05);
  viewport.setViewportPosition(0.75, 0.07, 0.24, 0.34);
  viewport.setViewportClipDistances(static_cast<float>(0.01 * half),
                                    static_cast<float>(100 * half));
  auto& camera = viewport.getCamera();
  camera.setOrthogonal();
  camera.setPointingAt(0, 0, 0);
  // MRPT's orthogonal cameras show 0.27 of this to either side.
  camera.setZoomDistance(static_cast<float>(half / 0.27));
  camera.setAzimuthDegrees(-90);
  camera.setElevationDegrees(90);
  const Pose2D& pose = moment.estimate->mean;
  const LiveMoment near = movedBy(moment, {pose.x, pose.y});
  put(viewport, "ground", makeGrid(0, 0, 2 * half, step));
  put(viewport, "particles", makeParticles(near, 0.01 * half, 3 * m_textScale));
  put(viewport, "ellipse", makeEllipse(*near.estimate, 0.02 * half, 0.015 * half));
  scene::addText(caption, 8 * m_textScale, 12 * m_textScale,
                 line("particles, y up, grid %g m", step), 0, 11 * m_textScale);
}

void LiveScene::showText(const LiveMoment& moment) {
  std::vector<scene::LegendLine> lines;
  for (const std::string& text : describe(moment)) lines.push_back({text, {}, 13});
  lines.front().size = 18;
  lines.front().color = colorOf(moment.health.state);
  lines.insert(lines.begin() + 1, {m_title, {}, 13});
  lines.insert(lines.end(), {{"map poles", mapColor},
                             {"observed poles on the map", matchedColor},
                             {"observed poles not on the map", unmatchedColor},
                             {"path while ok", pathColorOf(HealthState::ok)},
                             {"path while degraded", pathColorOf(HealthState::degraded)},
                             {"path while lost", pathColorOf(HealthState::lost)},
                             {"particles, the heavier the darker", particleColor},
                             {"95 % of the estimate's positions", ellipseColor},
                             {"places supposed by the search", hypothesisColor}});
  if (!moment.trueWay.empty()) lines.push_back({"true path", scene::truthColor});
  if (!m_origin.isZero()) lines.push_back({scene::originText(m_origin)});
  scene::showLegend(*m_scene, lines, m_textScale);
}

}  // namespace polemcl::report
