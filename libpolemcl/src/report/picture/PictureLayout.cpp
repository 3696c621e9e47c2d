#include "report/picture/PictureLayout.h"

#include <algorithm>

namespace polemcl::report {
namespace {

constexpr double left = 92, right = 32, header = 96, footer = 62;
constexpr double noteGap = 32;    ///< for the words above a strip
constexpr double labelGap = 78;   ///< for the labels of an axis and the words above a strip
constexpr double columnGap = 96;  ///< for the labels of the value axis
constexpr double margin = 1.15;   ///< of the map round its content

PictureLayout stripsBelow(const Rect& page, double aspect) {
  const double free = page.height - labelGap - noteGap;
  PictureLayout layout;
  layout.map = page;
  layout.map.height = std::clamp(margin * aspect * page.width, 0.45 * free, 0.70 * free);
  const double strip = 0.5 * (free - layout.map.height);
  layout.position = {page.x, layout.map.bottom() + labelGap, page.width, strip};
  layout.heading = {page.x, layout.position.bottom() + noteGap, page.width, strip};
  return layout;
}

PictureLayout stripsBeside(const Rect& page, double aspect) {
  const double free = page.width - columnGap;
  PictureLayout layout;
  layout.map = page;
  layout.map.width = std::clamp(margin * page.height / aspect, 0.40 * free, 0.60 * free);
  const double x = layout.map.right() + columnGap, width = free - layout.map.width;
  const double strip = 0.5 * (page.height - 2 * noteGap);
  layout.position = {x, page.y + noteGap, width, strip};
  layout.heading = {x, layout.position.bottom() + noteGap, width, strip};
  return layout;
}

}  // namespace

void requireSize(int width, int height, const std::filesystem::path& file) {
  if (width < 1200 || height < 750)
    throw Error(file.string() + ": a picture of " + std::to_string(width) + " x " +
                std::to_string(height) + " px; at least 1200 x 750 are needed");
}

PictureLayout layoutPicture(int width, int height, const Bounds& bounds, bool withErrors) {
  const Rect page{left, header, width - left - right, height - header - footer};
  if (!withErrors) return {page, {}, {}};
  const double x = std::max(bounds.xMax - bounds.xMin, 1.0);
  const double y = std::max(bounds.yMax - bounds.yMin, 1.0);
  const auto scale = [&](const PictureLayout& layout) {
    return std::min(layout.map.width / x, layout.map.height / y);
  };
  const PictureLayout below = stripsBelow(page, y / x), beside = stripsBeside(page, y / x);
  return scale(beside) > scale(below) ? beside : below;
}

}  // namespace polemcl::report
