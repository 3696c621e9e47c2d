#include "mrpt/drawing/SceneParts.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include <polemcl/mrpt/common/Compatibility.h>
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"

namespace polemcl::scene {
namespace {

using viz::CSetOfTriangles;
using viz::Scene;
using viz::Viewport;

double roundOrigin(double centre) {
  constexpr double kFar = 10000, kStep = 1000;  // m
  return std::abs(centre) > kFar ? std::round(centre / kStep) * kStep : 0;
}

mrpt::math::TPoint3Df pointOf(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

void light(Viewport& viewport) {
  setLight(viewport.lightParameters(), 0.8f, 0.28f, 0.0f);
}

struct CountClass {
  std::uint32_t least;
  TColor color;
  const char* text;
};
constexpr std::size_t kCountClasses = 6;
/// From light to dark, without the blue and the grey of the paths.
const CountClass& classOf(std::uint32_t count) {
  static const CountClass classes[kCountClasses] = {
      {100, {0x46, 0x03, 0x9f}, "100 or more"}, {30, {0x9c, 0x17, 0x9e}, "30 to 99"},
      {10, {0xd8, 0x45, 0x6c}, "10 to 29"},     {3, {0xed, 0x79, 0x33}, "3 to 9"},
      {1, {0xf5, 0xb7, 0x00}, "1 or 2"},        {0, {0x8a, 0x93, 0x9f}, "not stated"}};
  return *std::find_if(std::begin(classes), std::end(classes),
                       [&](const CountClass& c) { return count >= c.least; });
}

/// MRPT's fonts are ASCII only: replaces each other UTF-8 character by one `?`.
std::string asciiOf(const std::string& text) {
  std::string ascii;
  for (unsigned char c : text)
    if ((c & 0xc0) != 0x80) ascii += c < 0x80 ? static_cast<char>(c) : '?';
  return ascii;
}

}  // namespace

Eigen::Vector2d originFor(const Eigen::AlignedBox2d& box_map) {
  if (box_map.isEmpty()) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d centre = box_map.center();
  return {roundOrigin(centre.x()), roundOrigin(centre.y())};
}

std::string originText(const Eigen::Vector2d& origin_map) {
  if (origin_map.isZero()) return "";
  return "origin: x " + io::fixed(origin_map.x(), 0) + ", y " + io::fixed(origin_map.y(), 0) +
         " m of the map";
}

void prepare(Viewport& viewport) {
  viewport.setCustomBackgroundColor({1.0f, 1.0f, 1.0f});
  light(viewport);
}

void put(Viewport& viewport, const std::string& name, const viz::CVisualObject::Ptr& object) {
  if (auto old = viewport.getByName(name)) viewport.removeObject(old);
  if (!object) return;
  object->setName(name);
  viewport.insert(object);
}

Viewport& panelOf(Scene& scene, const std::string& name, double border) {
  Viewport* panel = nullptr;
  for (const auto& viewport : scene.viewports())
    if (viewport->getName() == name) panel = viewport.get();
  if (!panel) panel = scene.createViewport(name).get();
  panel->setCustomBackgroundColor({0.97f, 0.975f, 0.98f});
  panel->setBorderSize(static_cast<unsigned>(std::lround(border)));
  panel->setBorderColor(TColor(0x90, 0x98, 0xa4));
  light(*panel);
  return *panel;
}

void hidePanel(Viewport& panel) {
  panel.clear();
  panel.clearTextMessages();
  panel.setBorderSize(0);
  panel.setViewportPosition(0, 0, 0.001, 0.001);
}

void addText(Viewport& panel, double x, double y, const std::string& text, std::size_t index,
             double size, const TColor& color) {
  viz::TFontParams font;
  font.vfont_name = "sans";
  font.vfont_scale = static_cast<float>(size);
  font.color = mrpt::img::TColorf(color);
  panel.addTextMessage(x, y, asciiOf(text), index, font);
}

viz::CGridPlaneXY::Ptr makeGround(const Eigen::AlignedBox2d& box, double step) {
  const auto down = [&](double value) {
    return static_cast<float>(std::floor(value / step) * step);
  };
  const auto up = [&](double value) { return static_cast<float>(std::ceil(value / step) * step); };
  auto grid = viz::CGridPlaneXY::Create(down(box.min().x()), up(box.max().x()), down(box.min().y()),
                                        up(box.max().y()), 0.0f, static_cast<float>(step));
  grid->setColor_u8(groundColor);
  return grid;
}

viz::CSetOfLines::Ptr makeEllipse(const PoleDetection& pole) {
  constexpr int kCorners = 32;
  constexpr double kDeviations = 10, kHeight = 0.02;  // m
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(pole.covariance);
  const Eigen::Matrix2d shape =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  auto ellipse = viz::CSetOfLines::Create();
  Eigen::Vector2d before = kDeviations * shape.col(0);
  for (int i = 1; i <= kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    const Eigen::Vector2d corner =
        kDeviations * shape * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    ellipse->appendLine(before.x(), before.y(), 0.0, corner.x(), corner.y(), 0.0);
    before = corner;
  }
  ellipse->setLineWidth(2);
  ellipse->setLocation(pole.x, pole.y, kHeight);
  ellipse->setColor_u8(TColor(40, 80, 200));
  ellipse->setName("10 standard deviations");
  return ellipse;
}

void drawPole(viz::CSetOfObjects& objects, double x, double y, double radius, double bottom,
              double top, const TColor& color, const std::string& name) {
  const auto drawn = static_cast<float>(std::max(radius, 0.05));
  const auto height = static_cast<float>(std::max(top - bottom, 0.1));
  auto cylinder = viz::CCylinder::Create(drawn, drawn, height);
  cylinder->setSlicesCount(12);
  cylinder->setLocation(x, y, bottom);
  cylinder->setColor_u8(color);
  cylinder->setName(name);
  objects.insert(cylinder);
}

viz::CPointCloudColoured::Ptr makeDots(const std::vector<Dot>& dots, double pixels) {
  auto points = viz::CPointCloudColoured::Create();
  points->reserve(dots.size());
  for (const Dot& dot : dots) {
    const auto p = pointOf(dot.place);
    points->insertPoint({p.x, p.y, p.z, dot.color.R, dot.color.G, dot.color.B, 0xff});
  }
  points->setPointSize(static_cast<float>(pixels));
  points->enableVariablePointSize(false);
  return points;
}

void insertFace(CSetOfTriangles& triangles, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& c, const TColor& color) {
  viz::TTriangle triangle(pointOf(a), pointOf(b), pointOf(c));
  triangle.computeNormals();
  triangle.setColor(color);
  triangles.insertTriangle(triangle);
}

void insertRibbon(CSetOfTriangles& triangles, const Path& path, double height, double width,
                  const TColor& color, double left) {
  const auto edge = [&](std::size_t i, double side) -> Eigen::Vector3d {
    const Eigen::Vector2d along = path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0];
    const double length = along.norm();
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d place =
        path[i] + (length > 0 ? (left + side * width / 2) / length : 0) * across;
    return {place.x(), place.y(), height};
  };
  for (std::size_t i = 1; i < path.size(); ++i) {
    insertFace(triangles, edge(i - 1, -1), edge(i, -1), edge(i, 1), color);
    insertFace(triangles, edge(i - 1, -1), edge(i, 1), edge(i - 1, 1), color);
  }
}

void setColor(CSetOfTriangles& triangles, const TColor& color) {
  triangles.viz::CVisualObject::setColor_u8(color);
}

TColor colorOfCount(std::uint32_t count) {
  return classOf(count).color;
}

std::vector<LegendLine> countLegend(const std::vector<MapPole>& poles) {
  std::vector<LegendLine> lines{{std::to_string(poles.size()) + " poles, coloured by detections"}};
  for (std::uint32_t least : {100, 30, 10, 3, 1, 0}) {
    const CountClass& wanted = classOf(least);
    const auto found = std::count_if(poles.begin(), poles.end(), [&](const MapPole& pole) {
      return classOf(pole.count).least == least;
    });
    if (found > 0)
      lines.push_back({std::string(wanted.text) + ": " + std::to_string(found), wanted.color});
  }
  return lines;
}

void showLegend(Scene& scene, const std::vector<LegendLine>& lines, double scale, Corner corner,
                const std::string& name) {
  constexpr double kMargin = 10, kSpacing = 6, kMark = 10, kIndent = 18;  // pixels
  constexpr double kLetter = 0.82;  // width of a letter relative to its size
  double height = 2 * kMargin - kSpacing, width = 0;
  for (const LegendLine& line : lines) {
    height += line.size + kSpacing;
    width = std::max(width, kLetter * line.size * static_cast<double>(line.text.size()) +
                                (line.mark ? kIndent : 0));
  }
  width += 2 * kMargin;
  // MRPT: negative counts from the far side.
  const auto place = [&](bool far, double offset, double length) {
    return far ? -(offset + length) * scale : offset * scale;
  };
  Viewport& panel = panelOf(scene, name, scale);
  panel.setViewportPosition(place(corner.right, 10, width),
                            place(corner.top, corner.offset, height), width * scale,
                            height * scale);
  panel.getCamera().setNoProjection();
  panel.clearTextMessages();
  std::vector<Dot> marks;
  double y = height - kMargin;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LegendLine& line = lines[i];
    y -= line.size;
    // Without projection, a viewport reaches from -1 to 1.
    if (line.mark)
      marks.push_back(
          {{2 * (kMargin + kMark / 2) / width - 1, 2 * (y + line.size / 2) / height - 1, 0},
           *line.mark});
    addText(panel, (kMargin + (line.mark ? kIndent : 0)) * scale, y * scale, line.text, i,
            line.size * scale, line.color);
    y -= kSpacing;
  }
  put(panel, "marks", makeDots(marks, kMark * scale));
}

void save(const Scene& scene, const std::filesystem::path& file) {
  // Written to memory first: MRPT's file streams do not report a full disk.
  mrpt::io::CMemoryStream bytes;
  mrpt::serialization::archiveFrom(bytes) << scene;
  io::writeFile(file, {static_cast<const char*>(bytes.getRawBufferData()),
                       static_cast<std::size_t>(bytes.getTotalBytesCount())});
}

}  // namespace polemcl::scene
