#include "mrpt/drawing/OverviewScene.h"

#include <algorithm>
#include <cmath>

#include <polemcl/mrpt/common/Compatibility.h>
#include "core/common/Angles.h"
#include "core/common/Covariance.h"
#include "core/common/TickStep.h"
#include "io/file/TextFile.h"

namespace polemcl {
namespace {

using namespace scene;

constexpr double kHighest = 6;         ///< height that must be visible, m
constexpr double kHalfHeight = 0.268;  ///< tangent of half the opening angle of MRPT's cameras
constexpr double kAspect = 1.35;       ///< of a rather narrow viewer window

/// A camera in MRPT's convention, at `distance` from its target.
struct View {
  double azimuth = -90 * degree, elevation = 55 * degree;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  double distance = 0;
  Eigen::Vector3d back() const {
    return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
            std::sin(elevation)};
  }
  Eigen::Vector3d right() const { return {-std::sin(azimuth), std::cos(azimuth), 0}; }
  Eigen::Vector3d up() const { return back().cross(right()); }
};

/// View from the south; streets from one end, so that more of the street is near the camera.
View directionFor(const Path& places) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& place : places) mean += place / static_cast<double>(places.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const auto& place : places) scatter += (place - mean) * (place - mean).transpose();
  const auto axes = principalAxes(scatter);
  constexpr double kSlim = 16;  // ratio of the variances
  View view;
  if (!axes || axes->first <= kSlim * axes->second) return view;
  Eigen::Vector2d axis(axes->x, axes->y);
  if (axis.x() + axis.y() < 0) axis = -axis;
  view.azimuth = std::atan2(axis.y(), axis.x()) + 160 * degree;
  view.elevation = 22 * degree;
  return view;
}

/// Moves the camera as near as possible while all places are visible, on the ground and above it.
void fit(View& view, const Path& places) {
  constexpr double kShare = 0.92, kNearest = 40;  // used share of the window; m
  const double vertical = kShare * kHalfHeight, horizontal = kAspect * vertical;
  const Eigen::Vector3d back = view.back(), right = view.right(), up = view.up();
  // A place is visible if |right| <= horizontal * (distance - back); similarly for up.
  double r[2] = {-HUGE_VAL, -HUGE_VAL}, u[2] = {-HUGE_VAL, -HUGE_VAL};
  for (const auto& place : places)
    for (double z : {0.0, kHighest}) {
      const Eigen::Vector3d p(place.x(), place.y(), z);
      for (int side : {0, 1}) {
        const int sign = side == 0 ? 1 : -1;
        r[side] = std::max(r[side], sign * right.dot(p) + horizontal * back.dot(p));
        u[side] = std::max(u[side], sign * up.dot(p) + vertical * back.dot(p));
      }
    }
  const double away = std::max((r[0] + r[1]) / (2 * horizontal), (u[0] + u[1]) / (2 * vertical));
  view.target = (r[0] - r[1]) / 2 * right + (u[0] - u[1]) / 2 * up;
  view.distance = std::max(away, kNearest);
  // Move the target onto the ground, because viewers rotate about it; the camera stays in place.
  const double slide = view.target.z() / back.z();
  view.target -= slide * back;
  view.distance += slide;
}

/// The corner where the legend hides the fewest places.
Corner emptiest(const View& view, const Path& places) {
  constexpr double kWidth = 0.65, kHeight = 0.6;  // of the legend; the window has 2 by 2
  const auto hidden = [&](const Corner& corner) {
    return std::count_if(places.begin(), places.end(), [&](const Eigen::Vector2d& place) {
      const Eigen::Vector3d p = Eigen::Vector3d(place.x(), place.y(), 0) - view.target;
      const double away = kHalfHeight * (view.distance - view.back().dot(p));
      const double x = view.right().dot(p) / away / kAspect, y = view.up().dot(p) / away;
      return (corner.right ? x : -x) > 1 - kWidth && (corner.top ? y : -y) > 1 - kHeight;
    });
  };
  const Corner corners[] = {{false, false}, {false, true}, {true, true}, {true, false}};
  return *std::min_element(std::begin(corners), std::end(corners),
                           [&](const Corner& a, const Corner& b) { return hidden(a) < hidden(b); });
}

/// Splits a path at gaps and thins it: a drive has more poses than a ribbon needs corners.
std::vector<Path> partsOf(const Path& path, double spacing) {
  constexpr double kGap = 50;  // m
  std::vector<Path> parts;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i == 0 || (path[i] - path[i - 1]).norm() > kGap) parts.emplace_back();
    Path& part = parts.back();
    const bool last = i + 1 == path.size() || (path[i + 1] - path[i]).norm() > kGap;
    if (part.empty() || last || (path[i] - part.back()).norm() >= spacing) part.push_back(path[i]);
  }
  return parts;
}

}  // namespace

OverviewScene::OverviewScene(const Path& places_map, const std::string& title)
    : m_scene(viz::Scene::Create()), m_content(viz::CSetOfObjects::Create()) {
  Eigen::AlignedBox2d box_map;
  for (const auto& place : places_map) box_map.extend(place);
  if (box_map.isEmpty()) box_map.extend(Eigen::Vector2d::Zero());
  m_origin = originFor(box_map);
  m_box = box_map.translated(-m_origin);
  for (const auto& place : places_map) m_places.push_back(place - m_origin);
  if (m_places.empty()) m_places.push_back(m_box.center());
  m_extent = std::max(m_box.sizes().maxCoeff(), 10.0);
  constexpr double kLongest = 20;  // units
  m_unit = std::pow(10, std::max(0.0, std::ceil(std::log10(m_extent / kLongest))));
  m_legend.push_back({title, {}, 15});
}

void OverviewScene::addPoles(const std::string& name, const std::vector<MapPole>& poles,
                             const std::function<TColor(const MapPole&)>& color) {
  constexpr double kPixels = 7;
  auto objects = viz::CSetOfObjects::Create();
  std::vector<Dot> dots;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const MapPole& pole = poles[i];
    const Eigen::Vector2d place = Eigen::Vector2d(pole.x, pole.y) - m_origin;
    drawPole(*objects, place.x(), place.y(), pole.radius, pole.bottom, pole.top, color(pole),
             "pole " + std::to_string(i));
    dots.push_back({{place.x(), place.y(), pole.top}, color(pole)});
  }
  objects->setName(name);
  m_content->insert(objects);
  auto points = makeDots(dots, kPixels);
  points->setName(name + " dots");
  m_content->insert(points);
}

void OverviewScene::addRibbons(const std::string& name, const std::vector<Path>& paths_map,
                               const Ribbon& ribbon) {
  // Heights that viewers can resolve: grid, truth and estimate lie above each other.
  const double height = std::max(0.03, m_extent / 5000) * (ribbon.above       ? 3
                                                           : ribbon.bothSides ? 1
                                                                              : 2);
  const double width = ribbon.width > 0 ? ribbon.width : std::max(1.0, m_extent / 500);
  auto triangles = viz::CSetOfTriangles::Create();
  for (const Path& path : paths_map)
    for (Path& part : partsOf(path, width / 2)) {
      for (auto& place : part) place -= m_origin;
      if (ribbon.bothSides)
        for (double side : {-0.8, 0.8})
          insertRibbon(*triangles, part, height, width / 2, ribbon.color, side * width);
      else
        insertRibbon(*triangles, part, height, width, ribbon.color);
    }
  triangles->setName(name);
  setColor(*triangles, ribbon.color);
  m_content->insert(triangles);
}

void OverviewScene::addLegend(const std::vector<LegendLine>& lines) {
  m_legend.insert(m_legend.end(), lines.begin(), lines.end());
}

double OverviewScene::addGround() {
  const double step = tickStep(m_extent, 30);
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(step);
  const auto ground = makeGround({m_box.min() - margin, m_box.max() + margin}, step);
  ground->setName("ground");
  m_content->insert(ground);
  float x[2], y[2];
  ground->getPlaneLimits(x[0], x[1], y[0], y[1]);
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector2d place(x[corner % 2], y[corner / 2]), place_map = place + m_origin;
    auto label =
        viz::CText::Create(io::fixed(place_map.x(), 0) + ", " + io::fixed(place_map.y(), 0));
    label->setFont("sans", 20);
    label->setColor_u8(textColor);
    label->setLocation(place.x(), place.y(), 0);
    m_content->insert(label);
  }
  return step;
}

viz::Scene::Ptr OverviewScene::finish() {
  const auto viewport = m_scene->getViewport();
  prepare(*viewport);
  const double step = addGround();
  m_content->setScale(static_cast<float>(1 / m_unit));
  m_content->setName("map");
  viewport->insert(m_content);

  View view = directionFor(m_places);
  fit(view, m_places);
  auto& camera = viewport->getCamera();
  const Eigen::Vector3f target = (view.target / m_unit).cast<float>();
  camera.setPointingAt(target.x(), target.y(), target.z());
  camera.setZoomDistance(static_cast<float>(view.distance / m_unit));
  camera.setAzimuthDegrees(static_cast<float>(view.azimuth / degree));
  camera.setElevationDegrees(static_cast<float>(view.elevation / degree));
  m_scene->enableFollowCamera(true);

  addLegend({{"grid " + io::fixed(step, 0) + " m"}});
  if (m_unit > 1) m_legend.back().text += ", 1 unit of the viewer: " + io::fixed(m_unit, 0) + " m";
  if (!m_origin.isZero()) addLegend({{originText(m_origin)}});
  showLegend(*m_scene, m_legend, 1, emptiest(view, m_places));
  return m_scene;
}

}  // namespace polemcl
