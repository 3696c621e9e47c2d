#pragma once
/// \file ViewOptions.h
/// \brief How a localization is watched. `[view]` in INI files.

#include <optional>
#include <string>

#include "core/common/Binder.h"

namespace polemcl::report {

/// \brief How the first run is watched; results stay the same.
struct ViewOptions {
  bool live = false;        ///< a window that shows the run as it goes
  bool hold = false;        ///< the window stays after the run, until it is closed
  std::string rate = "1x";  ///< speed while a window shows the run, as parseRate() takes it
  int scenes = 0;           ///< scans from one `.3Dscene` to the next; 0: none
  std::string frames;       ///< folder of PNG frames; empty: none
  int frameEvery = 1;       ///< scans from one frame to the next
  int width = 1280;         ///< width of the frames, and of the window at first, pixels
  int height = 720;         ///< height of the same, pixels
  void validate() const;    ///< \throws Error naming the field
};

/// \brief `1x`, `2.5x`, `0.5`: times as fast as it was driven; `max`: as fast as it goes.
/// \return None for `max`. \throws Error on anything else, on zero and negative numbers.
std::optional<double> parseRate(const std::string& text);

void bind(Binder& binder, ViewOptions& options);  ///< `[view]`

}  // namespace polemcl::report
