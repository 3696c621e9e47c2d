#pragma once
/// \file RealismOptions.h
/// \brief What real streets and sensors have and clean models lack. `[realism]` in INI files.

#include <algorithm>

#include "core/common/Binder.h"

namespace polemcl {
class Binder;
}

namespace polemcl::sim {

/// \brief Rates of deviations. With `scale` 0, the default, there are none, and worlds are those of
/// earlier versions byte for byte. Shares are of the poles, each drawn on its own.
struct RealismOptions {
  double scale = 0;  ///< multiplies all rates below; 0: none

  double crooked = 0.15;   ///< share of bent poles and trunks
  double tapered = 0.15;   ///< share of posts that are thicker below and thinner above
  double leaning = 0.2;    ///< share that leans by 1.5 to 6 degrees
  double multiple = 0.06;  ///< share of posts with one or two more 0.3 to 0.6 m beside
  double boxes = 0.12;     ///< share of posts with a box on them
  double ivy = 0.05;       ///< share of poles and trunks with ivy around the lower part
  double hedges = 0.1;     ///< share with a hedge against them

  double rangeBias = 0.012;   ///< standard deviation of each beam's own bias, m
  double rangeWalk = 0.015;   ///< dim returns are longer, bright ones shorter by this, m
  double darkDropout = 0.15;  ///< share of the pulses lost on black surfaces
  double rain = 2;            ///< mm/h (`rain_mm_h`)
  double spray = 0.1;         ///< share of the pulses to the back that meet the car's own spray

  /// \brief A share after scaling, at most 1.
  double share(double rate) const { return std::min(1.0, scale * rate); }
};

void bind(Binder& binder, RealismOptions& options);  ///< `[realism]`

}  // namespace polemcl::sim
