#include "core/extraction/ExtractionOptions.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/common/Angles.h"
#include "core/common/Types.h"

namespace polemcl {
namespace {

void requireExtraction(bool good, const char* section, const char* key, double value,
                       const char* allowed) {
  if (good) return;
  std::ostringstream text;
  text << "[" << section << "] " << key << " = " << value << ": allowed is " << allowed;
  throw Error(text.str());
}

void requireOneOf(const std::string& key, const std::string& value,
                  const std::vector<std::string>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return;
  std::string text = "[range_image] " + key + " = " + value + ": allowed are ";
  for (const auto& one : allowed) text += (one == allowed.front() ? "" : ", ") + one;
  throw Error(text);
}

}  // namespace

void RangeImageOptions::validate() const {
  const auto check = [](bool good, const char* key, double value, const char* allowed) {
    requireExtraction(good, "range_image", key, value, allowed);
  };
  check(rows >= 2 && rows <= 1024, "rows", rows, "2 to 1024");
  check(columns >= 16 && columns <= 65536, "columns", columns, "16 to 65536");
  check(fovUp > fovDown, "fov_up_deg", fovUp / degree,
        "more than fov_down_deg (negative below the horizon)");
  check(maxZ > minZ, "max_z_m", maxZ, "more than min_z_m");
  // Cells of 1 m cover the square that the range spans.
  check(maxRange > 0 && maxRange <= 1000, "max_range_m", maxRange, "more than 0, at most 1000");
  check(epsilon > 0, "epsilon_m", epsilon, "more than 0");
  check(minPixels >= 0, "min_pixels", minPixels, "0 or more");
  check(maxWidthPx >= 1, "max_width_px", maxWidthPx, "1 or more");
  check(minAspect >= 0, "min_aspect", minAspect, "0 or more");
  check(foreground >= 0 && foreground <= 1, "foreground", foreground, "0 to 1");
  check(maxRadius > minRadius && minRadius >= 0, "max_radius_m", maxRadius,
        "more than min_radius_m");
  check(std::isfinite(minTop), "min_top_m", minTop, "a number");
  check(std::isfinite(maxBottom), "max_bottom_m", maxBottom, "a number");
  check(minHeight >= 0, "min_height_m", minHeight, "0 or more");
  check(fitMargin >= 0, "fit_margin_m", fitMargin, "0 or more");
  check(std::isfinite(fitMaxZ), "fit_max_z_m", fitMaxZ, "a number");
  check(minFitPoints >= 3, "min_fit_points", minFitPoints, "3 or more");
  check(freeRing >= 0, "free_ring_m", freeRing, "0 or more");
  check(freeShare >= 0, "free_share", freeShare, "0 or more");
  check(coordinateStep >= 0 && coordinateStep <= 1, "coordinate_step_m", coordinateStep, "0 to 1");
  requireOneOf("project_from", projectFrom, {"sensor", "cloud"});
  requireOneOf("foreground_test", foregroundTest, {"not_behind", "in_front"});
  requireOneOf("circle_fit", circleFit, {"kasa", "kasa_mean", "taubin", "silhouette"});
  requireOneOf("free_space", freeSpace, {"ring", "corners", "cut_corners"});
}

void ScanLineOptions::validate() const {
  const auto check = [](bool good, const char* key, double value, const char* allowed) {
    requireExtraction(good, "scan_line", key, value, allowed);
  };
  check(maxWidth > 0, "max_width_m", maxWidth, "more than 0");
  check(connectStep > 0, "connect_step_m", connectStep, "more than 0");
  check(edgeStep >= connectStep, "edge_step_m", edgeStep, "connect_step_m or more");
  // Cells of twice the reach cover the square that the range spans.
  check(stackReach >= 0.05, "stack_reach_m", stackReach, "0.05 or more");
  check(maxRange > 0 && maxRange <= 300, "max_range_m", maxRange, "more than 0, at most 300");
  check(stackGap >= 0, "stack_gap_m", stackGap, "0 or more");
  check(std::isfinite(minTop), "min_top_m", minTop, "a number");
  check(std::isfinite(maxBottom), "max_bottom_m", maxBottom, "a number");
  check(minHeight >= 0, "min_height_m", minHeight, "0 or more");
  check(maxRadius > minRadius && minRadius >= 0, "max_radius_m", maxRadius,
        "more than min_radius_m");
  check(maxTilt > 0 && maxTilt <= 85 * degree, "max_tilt_deg", maxTilt / degree,
        "more than 0, at most 85");
  check(minSpacing >= 0, "min_spacing_m", minSpacing, "0 or more");
  check(maxScatter > 0, "max_scatter_m", maxScatter, "more than 0");
  check(minPoints >= 2, "min_points", minPoints, "2 or more");
  check(minConfidence >= 0 && minConfidence <= 1, "min_confidence", minConfidence, "0 to 1");
}

void ExtractionOptions::validate() const {
  rangeImage.validate();
  scanLine.validate();
}

}  // namespace polemcl
