#include <polemcl/core/extraction/ExtractionOptions.h>
#include "core/common/Angles.h"
#include "core/common/Binder.h"
#include "core/extraction/ExtractionKeys.h"

namespace polemcl {
namespace {

const Range kAbove0 = Range::above(0), kFrom0 = Range::atLeast(0), k0To1 = Range::between(0, 1);

void bindChoices(Binder& b, RangeImageOptions& o) {
  b.flag("heights_above_ground", o.heightsAboveGround,
         "true: heights are z + height_m; false: z in the frame of the sensor");
  b.choice("project_from", o.projectFrom, {"sensor", "cloud"},
           "origin of the image: the optical centre, or the origin of the clouds");
  b.flag("mirrored", o.mirrored, "true: y counts to the right in the image");
  b.number("coordinate_step_m", o.coordinateStep, Range::between(0, 1), "m",
           "coordinates are rounded to multiples of this step; 0: used as read");
  b.flag("single_precision", o.singlePrecision, "true: projection and fit in float");
  b.choice<ExtractionDetails>(
      "details", o.details,
      {{ExtractionDetails::mended, "mended"},
       {ExtractionDetails::paper, "paper"},
       {ExtractionDetails::authors, "authors"}},
      "where text and code of the authors differ: ours, the text, the code");
}

}  // namespace

void bind(Binder& b, RangeImageOptions& o) {
  b.section("range_image", "Algorithm 1 of the paper, for method = range_image", Tier::expert);
  bindKeys(b, o);
}

void bindKeys(Binder& b, RangeImageOptions& o) {
  b.integer("rows", o.rows, Range::between(0, 1024), "px",
            "height of the range image; 0: a row for each ring of the sensor, fewer where they are "
            "not even");
  b.integer("columns", o.columns, Range::between(0, 65536), "px",
            "width of the range image; 0: 500, or the firing steps of the sensor if fewer");
  b.angleDeg("fov_up_deg", o.fovUp, Range::between(-90, 90),
             "elevation of the upper border; both borders 0: those of the sensor");
  b.angleDeg("fov_down_deg", o.fovDown, Range::between(-90, 90),
             "elevation of the lower border, negative below the horizon");
  b.number("min_z_m", o.minZ, Range::any(), "m", "lower cut, see heights_above_ground");
  b.number("max_z_m", o.maxZ, Range::any(), "m", "upper cut, see heights_above_ground");
  // Cells of 1 m cover the square that the range spans.
  b.number("max_range_m", o.maxRange, Range::aboveUpTo(0, 1000), "m",
           "farther points are not used");
  b.number("epsilon_m", o.epsilon, kAbove0, "m", "greatest step in range inside a cluster");
  b.integer("min_pixels", o.minPixels, kFrom0, "px", "a cluster needs more pixels than this");
  b.integer("max_width_px", o.maxWidthPx, Range::atLeast(1), "px", "greatest width of a cluster");
  b.number("foreground", o.foreground, k0To1, "",
           "least share of a cluster's pixels without a nearer neighbour beside; details = paper: "
           "in front of both neighbours");
  b.number("min_top_m", o.minTop, Range::any(), "m", "least height of a pole's top");
  b.number("max_bottom_m", o.maxBottom, Range::any(), "m", "greatest height of a pole's bottom");
  b.number("min_height_m", o.minHeight, kFrom0, "m", "least distance from bottom to top");
  b.number("fit_max_z_m", o.fitMaxZ, Range::any(), "m", "greatest height of the points fitted");
  b.number("free_ring_m", o.freeRing, kFrom0, "m", "width of the free space round a pole");
  bindChoices(b, o);

  b.require(o.rows != 1, "rows", o.rows, "0, or at least 2");
  b.require(o.columns == 0 || o.columns >= 16, "columns", o.columns, "0, or at least 16");
  b.require(o.fovUp > o.fovDown || (o.fovUp == 0 && o.fovDown == 0), "fov_up_deg", o.fovUp / degree,
            "more than fov_down_deg (negative below the horizon), or both 0");
  b.require(o.maxZ > o.minZ, "max_z_m", o.maxZ, "more than min_z_m");
}

void bind(Binder& b, ScanLineOptions& o) {
  b.section("scan_line", "Scan lines of real beams, for method = scan_line");
  bindKeys(b, o);
}

void bindKeys(Binder& b, ScanLineOptions& o) {
  b.number("min_top_m", o.minTop, kFrom0, "m", "least height of a pole's top above local ground");
  b.number("max_range_m", o.maxRange, Range::aboveUpTo(0, 300), "m",
           "poles farther away are not looked for");
  b.number("min_confidence", o.minConfidence, k0To1, "",
           "poles with a lower confidence are refused");
  b.number("max_radius_m", o.maxRadius, kAbove0, "m", "thicker poles are refused");
  b.tier(Tier::expert);
  b.number("min_height_m", o.minHeight, kFrom0, "m", "least visible height of a pole");

  b.require(o.maxRadius > o.minRadius, "max_radius_m", o.maxRadius, "more than 0.02 m");
}

void bind(Binder& b, ExtractionOptions& o) {
  b.section("extraction", "How poles are found");
  b.choice<ExtractionMethod>(
      "method", o.method,
      {{ExtractionMethod::rangeImage, "range_image"}, {ExtractionMethod::scanLine, "scan_line"}},
      "Algorithm 1 of the paper, or scan lines of real beams");
  bind(b, o.rangeImage);
  bind(b, o.scanLine);
}

}  // namespace polemcl
