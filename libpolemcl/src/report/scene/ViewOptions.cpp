#include "report/scene/ViewOptions.h"

#include <charconv>
#include <cmath>

#include "core/common/Binder.h"
#include "io/file/ErrorPlace.h"

namespace polemcl::report {
namespace {

constexpr double minRate = 0.001;  // slower ones never end

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

void bind(Binder& b, ViewOptions& o) {
  b.section("view", "How the first run is watched; results stay the same");
  b.flag("live", o.live, "true: a window shows the run as it goes");
  b.flag("hold", o.hold, "true: the window stays until it is closed");
  b.text("rate", o.rate, "speed with a window: 1x as it was driven, 2.5x, or max");
  b.integer("scenes", o.scenes, Range::atLeast(0), "scans",
            "number of scans from one .3Dscene to the next; 0: no scenes");
  b.text("frames", o.frames, "folder of PNG frames; empty: no frames");
  b.integer("frame_every", o.frameEvery, Range::atLeast(1), "scans",
            "number of scans from one frame to the next");
  b.require(io::problemOf([&] { parseRate(o.rate); }).empty(), "rate", o.rate,
            "max, or a factor on the recorded speed such as 1x or 2.5x, at least 0.001x");
}

void ViewOptions::validate() const {
  checkOptions(*this);
}

}  // namespace polemcl::report
