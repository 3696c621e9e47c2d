#pragma once
// A small drive to draw: along x from 0 to 20 m, four poles beside it.

#include "report/picture/MapView.h"
#include "support/TempFolder.h"

namespace polemcl::report {

inline MapPole poleAt(double x, double y) {
  MapPole pole;
  pole.x = x;
  pole.y = y;
  pole.radius = 0.15;
  pole.bottom = 0.5;
  pole.top = 4.5;
  pole.count = 3;
  return pole;
}

/// Truth along the x axis at 1 m/s; the estimate is `offset` to its left, with a heading error of
/// `turn`.
inline MapView smallDrive(double offset = 0.1, double turn = 0.01) {
  MapView view;
  view.title = "A small drive";
  view.poles = {poleAt(2, 6), poleAt(8, -6), poleAt(14, 6), poleAt(20, -6)};
  for (int i = 0; i <= 20; ++i) {
    view.truth.push_back({static_cast<double>(i), {static_cast<double>(i), 0, 0}});
    view.estimate.push_back({static_cast<double>(i), {static_cast<double>(i), offset, turn}});
  }
  return view;
}

}  // namespace polemcl::report
