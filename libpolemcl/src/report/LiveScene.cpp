#include <mrpt/opengl/CGridPlaneXY.h>
#include <polemcl/report/LiveScene.h>
#include <polemcl/report/MapView.h>
#include <polemcl/report/PlotAxes.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <utility>

#include "LiveObjects.h"

namespace polemcl::report {
namespace {

using namespace live;
using mrpt::opengl::COpenGLViewport;

constexpr double degree = M_PI / 180;

/// As printf, for short lines.
__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...) {
  char text[160];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

/// Takes the place of the object of that name; nothing: the object goes.
void put(COpenGLViewport& viewport, const std::string& name,
         const mrpt::opengl::CRenderizable::Ptr& object) {
  if (auto old = viewport.getByName(name)) viewport.removeObject(old);
  if (!object) return;
  object->setName(name);
  viewport.insert(object);
}

/// A viewport over the main one; made when it is first asked for.
COpenGLViewport& panelOf(mrpt::opengl::COpenGLScene& scene, const std::string& name) {
  for (const auto& viewport : scene.viewports())
    if (viewport->getName() == name) return *viewport;
  return *scene.createViewport(name);
}

mrpt::opengl::CGridPlaneXY::Ptr makeGrid(double x, double y, double half, double step) {
  const auto down = [&](double value) {
    return static_cast<float>(std::floor(value / step) * step);
  };
  const auto up = [&](double value) { return static_cast<float>(std::ceil(value / step) * step); };
  auto grid = mrpt::opengl::CGridPlaneXY::Create(down(x - half), up(x + half), down(y - half),
                                                 up(y + half), 0.0f, static_cast<float>(step));
  grid->setColor_u8(groundColor);
  return grid;
}

/// Colours as the legend has them: more from all sides than MRPT's lights give.
void light(COpenGLViewport& viewport) {
  auto& lights = viewport.lightParameters();
  lights.ambient = {0.7f, 0.7f, 0.7f, 1.0f};
  lights.diffuse = {0.45f, 0.45f, 0.45f, 1.0f};
  lights.specular = {0.0f, 0.0f, 0.0f, 1.0f};
}

void frame(COpenGLViewport& viewport, double width) {
  viewport.setCustomBackgroundColor({0.97f, 0.975f, 0.98f});
  viewport.setBorderSize(static_cast<unsigned>(std::lround(width)));
  viewport.setBorderColor(TColor(0x90, 0x98, 0xa4));
  light(viewport);
}

/// OpenGL has single precision only: far from the origin (UTM) poles would dance.
double roundOrigin(double centre) {
  constexpr double far = 10000, step = 1000;  // m
  return std::abs(centre) > far ? std::round(centre / step) * step : 0;
}

/// As seen from another origin; the axes stay.
LiveMoment movedBy(LiveMoment moment, const Eigen::Vector2d& origin) {
  const auto move = [&](auto& place) { place.x -= origin.x(), place.y -= origin.y(); };
  if (moment.estimate) move(moment.estimate->mean);
  for (Pose2D& particle : moment.particles) move(particle);
  for (GlobalHypothesis& place : moment.hypotheses) move(place.pose_map_robot);
  for (WayPoint& point : moment.way) move(point);
  return moment;
}

/// Standard deviation of the position along its worst axis, m.
double spreadOf(const PoseWithCovariance& pose) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(pose.covariance.topLeftCorner<2, 2>(),
                                                            Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(axes.eigenvalues()[1], 0.0));
}

}  // namespace

std::vector<Eigen::Vector2d> ellipse95(const PoseWithCovariance& pose, int corners) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(pose.covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d lengths = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  const double radius = std::sqrt(-2 * std::log(0.05));  // of 95 %, two degrees of freedom
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * M_PI * (i % corners) / corners;
    const Eigen::Vector2d unit(std::cos(angle), std::sin(angle));
    points.emplace_back(Eigen::Vector2d(pose.mean.x, pose.mean.y) +
                        radius * axes.eigenvectors() * lengths.cwiseProduct(unit));
  }
  return points;
}

std::vector<std::string> describe(const LiveMoment& moment) {
  const Health& health = moment.health;
  std::string state = name(health.state);
  if (health.state != HealthState::ok) state += std::string(": ") + name(health.reason);
  if (moment.relocalized) state += " (found by the search)";
  const auto onMap = std::count_if(moment.matches.begin(), moment.matches.end(),
                                   [](const PoleMatch& match) { return match.matched; });
  std::vector<std::string> lines{state, line("time %.1f s, scan %zu", moment.elapsed, moment.scan)};
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
  return lines;
}

LiveScene::LiveScene(const std::vector<MapPole>& map, std::string title, double textScale,
                     Centre centre)
    : m_title(std::move(title)),
      m_textScale(textScale),
      m_centre(centre),
      m_scene(mrpt::opengl::COpenGLScene::Create()) {
  MapView view;
  view.poles = map;
  const Bounds map_m = boundsOf(view);
  m_origin = {roundOrigin((map_m.xMin + map_m.xMax) / 2),
              roundOrigin((map_m.yMin + map_m.yMax) / 2)};
  if (m_origin.x() != 0 || m_origin.y() != 0)
    m_title += line(", less %.0f %.0f m", m_origin.x(), m_origin.y());
  for (MapPole& pole : view.poles) pole.x -= m_origin.x(), pole.y -= m_origin.y();
  m_map = view.poles;
  const Bounds bounds = boundsOf(view);
  m_centreX = (bounds.xMin + bounds.xMax) / 2;
  m_centreY = (bounds.yMin + bounds.yMax) / 2;
  m_extent = std::max({bounds.xMax - bounds.xMin, bounds.yMax - bounds.yMin, 20.0});
  const auto viewport = m_scene->getViewport();
  viewport->setCustomBackgroundColor({1.0f, 1.0f, 1.0f});
  light(*viewport);
  viewport->setViewportClipDistances(0.5f, static_cast<float>(std::max(6 * m_extent, 2000.0)));
  put(*viewport, "map", makeMap(m_map));
}

const mrpt::opengl::CCamera& LiveScene::camera() const {
  return m_scene->getViewport()->getCamera();
}

void LiveScene::show(const LiveMoment& moment) {
  Eigen::Vector2d origin = m_origin;
  if (m_centre == Centre::vehicle && moment.estimate)
    origin = {moment.estimate->mean.x, moment.estimate->mean.y};
  const Eigen::Vector2d map = m_origin - origin;
  aim(movedBy(moment, m_origin), map);
  showObjects(movedBy(moment, origin), map);
  showClose(moment);
  showText(moment);
}

void LiveScene::aim(const LiveMoment& moment, const Eigen::Vector2d& map) {
  auto& camera = m_scene->getViewport()->getCamera();
  if (!moment.estimate) {
    m_aimed.reset();
    camera.setPointingAt(static_cast<float>(m_centreX), static_cast<float>(m_centreY), 0);
    camera.setZoomDistance(static_cast<float>(2.1 * m_extent));
    camera.setAzimuthDegrees(-90);
    camera.setElevationDegrees(80);
    return;
  }
  constexpr double ahead = 14, gentle = 12;  // m
  const Pose2D& pose = moment.estimate->mean;
  double heading = pose.yaw;
  if (m_aimed && !moment.relocalized) {
    const double driven = std::hypot(pose.x - m_aimed->x, pose.y - m_aimed->y);
    heading = m_aimed->yaw + wrapAngle(pose.yaw - m_aimed->yaw) * (1 - std::exp(-driven / gentle));
  }
  m_aimed = Pose2D{pose.x, pose.y, wrapAngle(heading)};
  const Pose2D target = compose(*m_aimed, {ahead, 0, 0});
  camera.setPointingAt(static_cast<float>(target.x + map.x()),
                       static_cast<float>(target.y + map.y()), 1);
  camera.setZoomDistance(52);
  camera.setAzimuthDegrees(static_cast<float>(heading / degree + 180));
  camera.setElevationDegrees(24);
}

void LiveScene::showObjects(const LiveMoment& moment, const Eigen::Vector2d& map) {
  COpenGLViewport& viewport = *m_scene->getViewport();
  const bool known = moment.estimate.has_value();
  const Pose2D pose = known ? moment.estimate->mean : Pose2D{m_centreX, m_centreY, 0};
  put(viewport, "ground",
      known ? makeGrid(pose.x, pose.y, 150, 5)
            : makeGrid(pose.x, pose.y, 0.6 * m_extent, tickStep(m_extent, 40)));
  viewport.getByName("map")->setLocation(map.x(), map.y(), 0);
  put(viewport, "dots", known ? nullptr : makeDots(m_map, 4 * m_textScale));
  put(viewport, "way", makeWay(moment.way));
  put(viewport, "vehicle", known ? makeArrow(pose, 3, colorOf(moment.health.state)) : nullptr);
  put(viewport, "ellipse", known ? makeEllipse(*moment.estimate, 0.08, 0.08) : nullptr);
  put(viewport, "particles", makeParticles(moment, 0.1, 3 * m_textScale));
  put(viewport, "matched", makeObserved(moment, true));
  put(viewport, "unmatched", makeObserved(moment, false));
  const double length = known ? 5 : std::max(0.04 * m_extent, 5.0);
  put(viewport, "hypotheses",
      makeHypotheses(moment.hypotheses, length, static_cast<int>(16 * m_textScale)));
}

void LiveScene::showClose(const LiveMoment& moment) {
  auto* viewport = &panelOf(*m_scene, "close");
  auto& caption = panelOf(*m_scene, "caption");
  if (!moment.estimate) {  // viewports cannot be taken away: this one is a dot without content
    viewport->clear();
    caption.clearTextMessages();
    for (COpenGLViewport* panel : {viewport, &caption}) {
      panel->setBorderSize(0);
      panel->setViewportPosition(0, 0, 0.001, 0.001);
    }
    return;
  }
  // Steps, so that it does not breathe with every update.
  const double half = tickStep(3 * std::max(spreadOf(*moment.estimate), 0.005), 1);
  const double step = tickStep(2 * half, 8);
  caption.setViewportPosition(0.75, 0.02, 0.24, 0.05);
  viewport->setViewportPosition(0.75, 0.07, 0.24, 0.34);
  viewport->setViewportClipDistances(static_cast<float>(0.01 * half),
                                     static_cast<float>(100 * half));
  frame(caption, m_textScale);
  frame(*viewport, m_textScale);
  auto& camera = viewport->getCamera();
  camera.setOrthogonal();
  camera.setPointingAt(0, 0, 0);
  // MRPT's orthogonal cameras show 0.27 of this to either side.
  camera.setZoomDistance(static_cast<float>(half / 0.27));
  camera.setAzimuthDegrees(-90);
  camera.setElevationDegrees(90);
  const Pose2D& pose = moment.estimate->mean;
  const LiveMoment near = movedBy(moment, {pose.x, pose.y});
  put(*viewport, "ground", makeGrid(0, 0, 2 * half, step));
  put(*viewport, "particles", makeParticles(near, 0.01 * half, 3 * m_textScale));
  put(*viewport, "ellipse", makeEllipse(*near.estimate, 0.02 * half, 0.015 * half));
  mrpt::opengl::TFontParams font;
  font.vfont_name = "sans";
  font.vfont_scale = static_cast<float>(11 * m_textScale);
  font.color = mrpt::img::TColorf(textColor);
  caption.addTextMessage(8 * m_textScale, 12 * m_textScale,
                         line("particles, y up, grid %g m", step), 0, font);
}

void LiveScene::showText(const LiveMoment& moment) {
  const std::vector<std::pair<TColor, std::string>> legend{
      {mapColor, "map poles"},
      {matchedColor, "observed poles on the map"},
      {unmatchedColor, "observed poles not on the map"},
      {wayColor, "way of the estimate"},
      {particleColor, "particles, the heavier the darker"},
      {hypothesisColor, "places supposed by the search"}};
  const auto lines = describe(moment);
  constexpr double left = 12, row = 19, large = 18, small = 12;  // pixels
  double y = 12;                                                 // from the bottom
  const double height = y + row * static_cast<double>(legend.size() + lines.size() + 1) + 2 * large;
  COpenGLViewport& panel = panelOf(*m_scene, "text");
  panel.setViewportPosition(10 * m_textScale, 10 * m_textScale, 330 * m_textScale,
                            height * m_textScale);
  frame(panel, m_textScale);
  panel.clearTextMessages();
  std::size_t index = 0;
  const auto write = [&](double size, const TColor& color, const std::string& text) {
    mrpt::opengl::TFontParams font;
    font.vfont_name = "sans";
    font.vfont_scale = static_cast<float>(size * m_textScale);
    font.color = mrpt::img::TColorf(color);
    panel.addTextMessage(left * m_textScale, y * m_textScale, text, index++, font);
    y += row;
  };
  for (auto entry = legend.rbegin(); entry != legend.rend(); ++entry)
    write(small, entry->first, entry->second);
  y += large / 2;
  for (std::size_t i = lines.size() - 1; i >= 1; --i) write(small + 1, textColor, lines[i]);
  write(small + 1, textColor, m_title);
  y += large / 4;
  write(large, colorOf(moment.health.state), lines[0]);
}

}  // namespace polemcl::report
