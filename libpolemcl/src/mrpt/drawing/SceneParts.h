#pragma once
/// \file SceneParts.h
/// \brief What all scenes are made of: ground, poles, ribbons, dots, a legend. Stock MRPT objects
/// only, so that viewers need no plugin.
///
/// Coordinates are those of the scene, m, ground at z = 0, unless said otherwise.

#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/common/Types.h"

namespace polemcl::scene {

using mrpt::img::TColor;
using Path = std::vector<Eigen::Vector2d>;  ///< places in order, m

/// Told apart by lightness too, for those who do not see all colours.
inline const TColor textColor(0x20, 0x26, 0x2e), groundColor(0xb4, 0xba, 0xc2),
    truthColor(0x40, 0x48, 0x54), estimateColor(0x00, 0x72, 0xb2);

/// \brief OpenGL has single precision only: at UTM coordinates nothing would be drawn. Scenes more
/// than 10 km off the map's origin get an origin of their own at whole kilometres, else (0, 0).
Eigen::Vector2d originFor(const Eigen::AlignedBox2d& box_map);
/// \brief Names that origin, for legends. Empty for (0, 0).
std::string originText(const Eigen::Vector2d& origin_map);

/// \brief White, and light from all sides: colours are those of the legend.
void prepare(mrpt::opengl::COpenGLViewport& viewport);
/// \brief Takes the place of the object of that name; null: the object goes.
void put(mrpt::opengl::COpenGLViewport& viewport, const std::string& name,
         const mrpt::opengl::CRenderizable::Ptr& object);
/// \brief A viewport over the main one with a border; made when it is first asked for.
mrpt::opengl::COpenGLViewport& panelOf(mrpt::opengl::COpenGLScene& scene, const std::string& name,
                                       double border);

/// \brief A grid at multiples of `step` that covers the box.
mrpt::opengl::CGridPlaneXY::Ptr makeGround(const Eigen::AlignedBox2d& box, double step);

/// \brief Inserts an upright cylinder. \param bottom,top Heights above z = 0, m.
/// Poles with a radius under 5 cm get that radius: thinner ones cannot be seen.
void drawPole(mrpt::opengl::CSetOfObjects& objects, double x, double y, double radius,
              double bottom, double top, const TColor& color, const std::string& name = "");

struct Dot {
  Eigen::Vector3d place;
  TColor color;
};
/// \brief Squares of so many pixels, however far the camera is: poles seen from afar.
mrpt::opengl::CPointCloudColoured::Ptr makeDots(const std::vector<Dot>& dots, double pixels);

/// \brief One triangle of one colour.
void insertFace(mrpt::opengl::CSetOfTriangles& triangles, const Eigen::Vector3d& a,
                const Eigen::Vector3d& b, const Eigen::Vector3d& c, const TColor& color);
/// \brief A flat band along the path, its edges joined at the bends (software renderers draw lines
/// of a pixel only). \param left Its middle lies so far to the left of the path, m.
void insertRibbon(mrpt::opengl::CSetOfTriangles& triangles, const Path& path, double height,
                  double width, const TColor& color, double left = 0);

/// \brief Colour of a map pole by the number of its detections: 1, 3, 10, 30, 100 or more.
TColor colorOfCount(std::uint32_t count);

/// \brief A line of the legend; `mark`: the colour of a square before the text.
struct LegendLine {
  std::string text;
  std::optional<TColor> mark = std::nullopt;
  double size = 12;  ///< of the letters, pixels
  TColor color = textColor;
};
/// \brief The colours of those counts that occur, a line each with the number of poles.
std::vector<LegendLine> countLegend(const std::vector<MapPole>& poles);
struct Corner {
  bool right = false, top = false;
};
/// \brief Panel `text` in a corner, lines from top to bottom.
/// \param scale Letters and marks are so many times larger.
void showLegend(mrpt::opengl::COpenGLScene& scene, const std::vector<LegendLine>& lines,
                double scale = 1, Corner corner = {});

/// \brief Writes a `.3Dscene`, atomically. \throws Error when it cannot be written.
void save(const mrpt::opengl::COpenGLScene& scene, const std::filesystem::path& file);

}  // namespace polemcl::scene
