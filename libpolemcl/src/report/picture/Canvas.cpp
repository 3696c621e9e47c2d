#include "report/picture/Canvas.h"

#include <cairo.h>

#include <cmath>
#include <ostream>

#include <polemcl/core/common/Types.h>
#include "io/file/AtomicFile.h"

namespace polemcl::report {

struct Canvas::Impl {
  cairo_surface_t* surface;
  cairo_t* context;

  Impl(int width, int height)
      : surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
        context(cairo_create(surface)) {}
  ~Impl() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
  }
  void source(const Color& color) {
    cairo_set_source_rgba(context, color.red, color.green, color.blue, color.alpha);
  }
  void path(const std::vector<Eigen::Vector2d>& points) {
    cairo_new_path(context);
    for (const Eigen::Vector2d& point : points) cairo_line_to(context, point.x(), point.y());
  }
  void font(const TextStyle& style) {
    cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context, style.size);
  }
};

Canvas::Canvas(int width, int height) : m_impl(std::make_unique<Impl>(width, height)) {
  if (cairo_status(m_impl->context) != CAIRO_STATUS_SUCCESS)
    throw Error("picture: no image of " + std::to_string(width) + " x " + std::to_string(height) +
                " px: " + cairo_status_to_string(cairo_status(m_impl->context)));
  cairo_set_line_join(m_impl->context, CAIRO_LINE_JOIN_ROUND);
  fill({0, 0, static_cast<double>(width), static_cast<double>(height)}, rgb(0xffffff));
}

Canvas::~Canvas() = default;

void Canvas::fill(const Rect& area, const Color& color) {
  m_impl->source(color);
  cairo_rectangle(m_impl->context, area.x, area.y, area.width, area.height);
  cairo_fill(m_impl->context);
}

void Canvas::outline(const Rect& area, const Color& color, double lineWidth) {
  m_impl->source(color);
  cairo_set_line_width(m_impl->context, lineWidth);
  cairo_rectangle(m_impl->context, area.x, area.y, area.width, area.height);
  cairo_stroke(m_impl->context);
}

void Canvas::line(const std::vector<Eigen::Vector2d>& points, const Color& color, double lineWidth,
                  bool dashed) {
  cairo_t* context = m_impl->context;
  cairo_save(context);
  m_impl->source(color);
  cairo_set_line_width(context, lineWidth);
  cairo_set_line_cap(context, dashed ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
  const double dashes[] = {4 * lineWidth, 3 * lineWidth};
  if (dashed) cairo_set_dash(context, dashes, 2, 0);
  m_impl->path(points);
  cairo_stroke(context);
  cairo_restore(context);
}

void Canvas::polygon(const std::vector<Eigen::Vector2d>& points, const Color& color) {
  m_impl->source(color);
  m_impl->path(points);
  cairo_close_path(m_impl->context);
  cairo_fill(m_impl->context);
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius, const Color& color,
                  const Color& rim, double rimWidth) {
  cairo_t* context = m_impl->context;
  cairo_new_path(context);
  cairo_arc(context, centre.x(), centre.y(), radius, 0, 2 * M_PI);
  m_impl->source(color);
  cairo_fill_preserve(context);
  m_impl->source(rim);
  cairo_set_line_width(context, rimWidth);
  if (rimWidth > 0) cairo_stroke(context);
  cairo_new_path(context);
}

void Canvas::text(const std::string& line, const Eigen::Vector2d& anchor, const TextStyle& style) {
  cairo_t* context = m_impl->context;
  const double share = style.align == Align::left ? 0 : style.align == Align::centre ? 0.5 : 1;
  const double shift = -share * textWidth(line, style);
  cairo_save(context);
  m_impl->font(style);
  cairo_translate(context, anchor.x(), anchor.y());
  if (style.upwards) cairo_rotate(context, -M_PI / 2);
  if (style.halo) {
    cairo_move_to(context, shift, 0);
    cairo_text_path(context, line.c_str());
    m_impl->source(rgb(0xffffff));
    cairo_set_line_width(context, 0.3 * style.size);
    cairo_stroke(context);
  }
  m_impl->source(style.color);
  cairo_move_to(context, shift, 0);
  cairo_show_text(context, line.c_str());
  cairo_restore(context);
}

void Canvas::fittingText(const std::string& line, const Eigen::Vector2d& anchor, double room,
                         TextStyle style) {
  const double width = textWidth(line, style);
  if (width > room) style.size *= room / width;
  text(line, anchor, style);
}

double Canvas::textWidth(const std::string& line, const TextStyle& style) const {
  m_impl->font(style);
  cairo_text_extents_t extents;
  cairo_text_extents(m_impl->context, line.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::clip(const Rect& area) {
  cairo_save(m_impl->context);
  cairo_rectangle(m_impl->context, area.x, area.y, area.width, area.height);
  cairo_clip(m_impl->context);
}

void Canvas::unclip() {
  cairo_restore(m_impl->context);
}

void Canvas::writePng(const std::filesystem::path& file) const {
  // A text that is no UTF-8 puts the context into an error state and ends all drawing.
  const cairo_status_t drawn = cairo_status(m_impl->context);
  if (drawn != CAIRO_STATUS_SUCCESS)
    throw Error(file.string() +
                ": the picture could not be drawn: " + cairo_status_to_string(drawn));
  io::AtomicFile output(file);
  const auto write = [](void* stream, const unsigned char* data, unsigned int size) {
    static_cast<std::ostream*>(stream)->write(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;  // the state of the stream is checked on commit
  };
  std::ostream* stream = &output.stream();
  const cairo_status_t written = cairo_surface_write_to_png_stream(m_impl->surface, write, stream);
  if (written != CAIRO_STATUS_SUCCESS)
    throw Error(file.string() + ": no PNG: " + cairo_status_to_string(written));
  output.commit();
}

}  // namespace polemcl::report
