#pragma once
/// \file Canvas.h
/// \brief A page to draw on: smooth lines, shapes and text on a pixel image, by Cairo.

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace polemcl::report {

/// \brief Red, green, blue, opacity, each in [0, 1].
struct Color {
  double red = 0, green = 0, blue = 0, alpha = 1;
};
/// \brief 0xRRGGBB as a colour.
constexpr Color rgb(unsigned hex, double alpha = 1) {
  return {((hex >> 16) & 255) / 255.0, ((hex >> 8) & 255) / 255.0, (hex & 255) / 255.0, alpha};
}

/// Colours that all pictures share, told apart by colour-blind eyes (Okabe and Ito 2008).
inline constexpr Color ink = rgb(0x1f2328), white = rgb(0xffffff), poleColor = rgb(0xd55e00);

/// \brief Upper left corner and size, px.
struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

enum class Align { left, centre, right };

struct TextStyle {
  double size = 15;  ///< height of the font, px
  Color color;
  Align align = Align::left;
  bool bold = false;
  bool upwards = false;  ///< turned by 90°, read from below
  bool halo = false;     ///< a white edge, for text upon a drawing
};

/// \brief A white image. Coordinates in px from the upper left corner, x right, y down.
class Canvas {
 public:
  /// \throws Error when the image cannot be made (too large).
  Canvas(int width, int height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void fill(const Rect& area, const Color& color);
  void outline(const Rect& area, const Color& color, double lineWidth);
  void line(const std::vector<Eigen::Vector2d>& points, const Color& color, double lineWidth,
            bool dashed = false);
  void polygon(const std::vector<Eigen::Vector2d>& points, const Color& color);
  /// \brief A text that becomes smaller rather than wider than `room`, px.
  void fittingText(const std::string& line, const Eigen::Vector2d& anchor, double room,
                   TextStyle style);
  /// \brief A filled disc with a rim of another colour (width 0: no rim).
  void disc(const Eigen::Vector2d& centre, double radius, const Color& color, const Color& rim,
            double rimWidth);
  /// \brief One line of text; `anchor` is on the baseline, at the side `align` says.
  void text(const std::string& line, const Eigen::Vector2d& anchor, const TextStyle& style);
  double textWidth(const std::string& line, const TextStyle& style) const;
  /// \brief Nothing is drawn outside `area` until unclip().
  void clip(const Rect& area);
  void unclip();

  /// \brief Writes the image, atomically. \throws Error when it cannot be written.
  void writePng(const std::filesystem::path& file) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl::report
