#pragma once
/// \file SceneParts.h
/// \brief Parts of all scenes: ground, poles, ribbons, dots, a legend. Only stock MRPT objects are
/// used, so that viewers need no plugin.
///
/// Unless stated otherwise, coordinates are those of the scene, m, with the ground at z = 0.

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/mrpt/common/Compatibility.h>

namespace polemcl::scene {

using mrpt::img::TColor;
using Path = std::vector<Eigen::Vector2d>;  ///< positions in order, m

/// The colours also differ in lightness, for colour-blind readers.
inline const TColor textColor(0x20, 0x26, 0x2e), groundColor(0xb4, 0xba, 0xc2),
    truthColor(0x40, 0x48, 0x54), estimateColor(0x00, 0x72, 0xb2);

/// \brief Origin of a scene. OpenGL has single precision only, which is too coarse for UTM
/// coordinates. Scenes more than 10 km from the map's origin get an origin at whole kilometres;
/// others get (0, 0).
Eigen::Vector2d originFor(const Eigen::AlignedBox2d& box_map);
/// \brief Text with that origin, for legends. Empty for (0, 0).
std::string originText(const Eigen::Vector2d& origin_map);

/// \brief White background, light from all sides: colours look as in the legend.
void prepare(viz::Viewport& viewport);
/// \brief Replaces the object with this name; a null object removes it.
void put(viz::Viewport& viewport, const std::string& name, const viz::CVisualObject::Ptr& object);
/// \brief A viewport with a border over the main one; created on first use.
viz::Viewport& panelOf(viz::Scene& scene, const std::string& name, double border);
/// \brief Viewports cannot be taken away: this one becomes a dot without content.
void hidePanel(viz::Viewport& panel);
/// \brief A line of text in a panel. \param x,y As CTextMessageCapable takes them. \param index Of
/// the text in the panel. \param size Height of the letters, pixels.
void addText(viz::Viewport& panel, double x, double y, const std::string& text, std::size_t index,
             double size, const TColor& color = textColor);

/// \brief A grid that covers the box, with lines at multiples of `step`.
viz::CGridPlaneXY::Ptr makeGround(const Eigen::AlignedBox2d& box, double step);

/// \brief An outline on the ground at ten standard deviations, since centimetres cannot be seen.
viz::CSetOfLines::Ptr makeEllipse(const PoleDetection& pole);

/// \brief Inserts a vertical cylinder. \param bottom,top Heights above z = 0, m.
/// Radii below 5 cm are drawn as 5 cm, because thinner poles are not visible.
void drawPole(viz::CSetOfObjects& objects, double x, double y, double radius, double bottom,
              double top, const TColor& color, const std::string& name = "");

struct Dot {
  Eigen::Vector3d place;
  TColor color;
};
/// \brief Squares of constant size in pixels at any distance: poles seen from far away.
viz::CPointCloudColoured::Ptr makeDots(const std::vector<Dot>& dots, double pixels);

/// \brief One triangle of one colour.
void insertFace(viz::CSetOfTriangles& triangles, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& c, const TColor& color);
/// \brief A flat band along the path with joined edges at the bends (software renderers draw lines
/// only one pixel wide). \param left Offset of the band to the left of the path, m.
void insertRibbon(viz::CSetOfTriangles& triangles, const Path& path, double height, double width,
                  const TColor& color, double left = 0);

/// \brief Sets the colour of the object itself, beside that of its faces. (From MRPT 2.14 on its
/// own setColor_u8() calls itself without end.)
void setColor(viz::CSetOfTriangles& triangles, const TColor& color);

/// \brief Colour of a map pole by its number of detections, in classes from 1, 3, 10, 30 and 100.
TColor colorOfCount(std::uint32_t count);

/// \brief A line of the legend. `mark` is the colour of a square before the text.
struct LegendLine {
  std::string text;
  std::optional<TColor> mark = std::nullopt;
  double size = 12;  ///< height of the letters, pixels
  TColor color = textColor;
};
/// \brief One line per colour that occurs, with its number of poles.
std::vector<LegendLine> countLegend(const std::vector<MapPole>& poles);
struct Corner {
  bool right = false, top = false;
  double offset = 10;  ///< from the top or from the bottom, pixels
};
/// \brief A panel in a corner, with the lines from top to bottom.
/// \param scale Factor on the size of letters and marks.
void showLegend(viz::Scene& scene, const std::vector<LegendLine>& lines, double scale = 1,
                Corner corner = {}, const std::string& name = "text");

/// \brief Writes a `.3Dscene`, atomically. \throws Error when it cannot be written.
void save(const viz::Scene& scene, const std::filesystem::path& file);

}  // namespace polemcl::scene
