#include "report/scene/ViewOptions.h"

#include <charconv>
#include <cmath>

namespace polemcl::report {
namespace {

constexpr double minSide = 160, maxSide = 8192;  // pixels; what OpenGL's textures take, halved

constexpr double minRate = 0.001;  // slower ones never end

void require(bool good, const char* key, int value, const std::string& allowed) {
  if (!good)
    throw Error(std::string("[view] ") + key + " = " + std::to_string(value) + ": allowed is " +
                allowed);
}

}  // namespace

std::optional<double> parseRate(const std::string& text) {
  if (text == "max") return std::nullopt;
  const std::size_t length = text.size() - (!text.empty() && text.back() == 'x');
  double rate = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + length, rate);
  if (error != std::errc{} || stop != text.data() + length || !std::isfinite(rate) ||
      rate < minRate)
    throw Error("rate " + text +
                ": allowed is max, or how many times as fast as it was driven, such as 1x or 2.5x, "
                "at least 0.001x");
  return rate;
}

void ViewOptions::validate() const {
  parseRate(rate);
  require(scenes >= 0, "scenes", scenes, "0 or more");
  require(frameEvery >= 1, "frame_every", frameEvery, "1 or more");
  for (const auto& [key, side] : {std::pair{"width", width}, {"height", height}})
    require(side >= minSide && side <= maxSide, key, side, Range::between(minSide, maxSide).text());
}

void bind(Binder& b, ViewOptions& o) {
  b.section("view", "How the first run is watched; nothing of it changes the results");
  b.flag("live", o.live, "true: a window shows the run as it goes");
  b.flag("hold", o.hold, "true: the window stays until it is closed");
  b.text("rate", o.rate, "with a window: 1x as it was driven, 2.5x faster, max");
  b.integer("scenes", o.scenes, Range::atLeast(0), "scans", "a .3Dscene every so many; 0: none");
  b.text("frames", o.frames, "folder of PNG frames; empty: none");
  b.integer("frame_every", o.frameEvery, Range::atLeast(1), "scans", "a frame every so many");
  b.integer("width", o.width, Range::between(minSide, maxSide), "pixels", "of frames and window");
  b.integer("height", o.height, Range::between(minSide, maxSide), "pixels", "of frames and window");
  b.check(o);
}

}  // namespace polemcl::report
