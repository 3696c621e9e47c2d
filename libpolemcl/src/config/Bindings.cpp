#include "config/Bindings.h"

#include "core/sensor/SensorModel.h"

namespace polemcl {
namespace {

const Range positive = Range::above(0), notNegative = Range::atLeast(0),
            share = Range::between(0, 1);

void bind(Binder& b, RangeImageOptions& o) {
  b.section("range_image", "Algorithm 1 of the paper, for method = range_image");
  b.integer("rows", o.rows, Range::between(2, 1024), "px", "height of the range image");
  b.integer("columns", o.columns, Range::between(16, 65536), "px", "width of the range image");
  b.angleDeg("fov_up_deg", o.fovUp, Range::between(-90, 90), "elevation of the upper border");
  b.angleDeg("fov_down_deg", o.fovDown, Range::between(-90, 90),
             "lower border, negative downwards");
  b.number("min_z_m", o.minZ, Range::any(), "m", "lower cut, see heights_above_ground");
  b.number("max_z_m", o.maxZ, Range::any(), "m", "upper cut, see heights_above_ground");
  b.number("max_range_m", o.maxRange, positive, "m", "farther points are not used");
  b.number("epsilon_m", o.epsilon, positive, "m", "range step inside a cluster");
  b.integer("min_pixels", o.minPixels, notNegative, "px", "clusters need strictly more");
  b.integer("max_width_px", o.maxWidthPx, Range::atLeast(1), "px", "widest cluster");
  b.number("min_aspect", o.minAspect, notNegative, "", "least height / width of a cluster");
  b.number("foreground", o.foreground, share, "", "least share of pixels, see foreground_test");
  b.number("min_top_m", o.minTop, Range::any(), "m", "least height of the top");
  b.number("max_bottom_m", o.maxBottom, Range::any(), "m", "greatest height of the bottom");
  b.number("min_height_m", o.minHeight, notNegative, "m", "least top minus bottom");
  b.number("min_radius_m", o.minRadius, notNegative, "m", "thinner circles are refused");
  b.number("max_radius_m", o.maxRadius, positive, "m", "thicker circles are refused");
  b.number("fit_margin_m", o.fitMargin, notNegative, "m", "box of the fit: radius plus this");
  b.number("fit_max_z_m", o.fitMaxZ, Range::any(), "m", "highest point of the fit");
  b.integer("min_fit_points", o.minFitPoints, Range::atLeast(3), "", "least points of the fit");
  b.number("free_ring_m", o.freeRing, notNegative, "m", "width of the free space around a pole");
  b.number("free_share", o.freeShare, notNegative, "", "points allowed there, of the fitted ones");
  b.flag("heights_above_ground", o.heightsAboveGround,
         "true: z + height_m; false: z of the sensor");
  b.choice("project_from", o.projectFrom, {"sensor", "cloud"},
           "origin of the image: the optical centre, or the origin of the clouds");
  b.flag("mirrored", o.mirrored, "true: y counts to the right in the image");
  b.number("coordinate_step_m", o.coordinateStep, Range::between(0, 1), "m",
           "the files hold multiples of this, which are used exactly; 0: as read");
  b.flag("single_precision", o.singlePrecision, "true: projection and fit in float");
  b.flag("clamp_to_view", o.clampToView,
         "true: points outside the image go to its border pixels; false: dropped");
  b.flag(
      "wrap_around", o.wrapAround,
      "true: the image closes at +-180 deg; false: open, no clusters in border rows and columns");
  b.flag("grow_upwards", o.growUpwards, "true: clusters grow up too; false: left, right, below");
  b.choice("foreground_test", o.foregroundTest, {"not_behind", "in_front"},
           "pixels that count for foreground: none beside is nearer, or some are and all farther");
  b.choice("circle_fit", o.circleFit, {"kasa", "kasa_mean", "taubin", "silhouette"},
           "how a circle is fitted");
  b.choice("free_space", o.freeSpace, {"ring", "corners", "cut_corners"},
           "shape of the free space; cut_corners: the lower two cut, as by the authors' code");
}

void bind(Binder& b, ScanLineOptions& o) {
  b.section("scan_line", "Scan lines of real beams, for method = scan_line");
  b.number("max_width_m", o.maxWidth, positive, "m", "widest slice of a pole on one beam");
  b.number("connect_step_m", o.connectStep, positive, "m", "greatest step in range in a slice");
  b.number("edge_step_m", o.edgeStep, positive, "m", "least step to what is behind the edges");
  b.number("stack_reach_m", o.stackReach, positive, "m",
           "greatest step in the plane between slices");
  b.number("stack_gap_m", o.stackGap, notNegative, "m", "greatest height between slices of a pole");
  b.number("min_top_m", o.minTop, notNegative, "m", "least height of the top above local ground");
  b.number("max_bottom_m", o.maxBottom, positive, "m", "greatest height of the lowest return");
  b.number("min_height_m", o.minHeight, notNegative, "m", "least visible height");
  b.number("min_radius_m", o.minRadius, notNegative, "m", "thinner poles are refused");
  b.number("max_radius_m", o.maxRadius, positive, "m", "thicker poles are refused");
  b.integer("min_points", o.minPoints, Range::atLeast(2), "", "least returns of a pole");
  b.angleDeg("max_tilt_deg", o.maxTilt, Range::between(0, 90), "greatest tilt of the axis");
  b.number("max_scatter_m", o.maxScatter, positive, "m", "greatest rms distance of slices from it");
  b.number("min_spacing_m", o.minSpacing, notNegative, "m",
           "nearer poles: the less sure is dropped");
  b.number("min_confidence", o.minConfidence, share, "", "poles below are refused");
  b.number("max_range_m", o.maxRange, positive, "m", "poles farther away are not looked for");
}

}  // namespace

void bind(Binder& b, SensorOptions& o) {
  b.section("sensor", "The LiDAR and how it is mounted");
  b.choice("model", o.model, SensorModel::modelNames(),
           "beams of a data sheet, elevations_deg, or rows from fov_up_deg to fov_down_deg");
  b.flag("upside_down", o.upsideDown, "true: the elevations of the model change sign");
  b.anglesDeg("elevations_deg", o.elevations, Range::between(-90, 90), "beams of model = table");
  b.anglesDeg("lower_elevations_deg", o.lowerElevations, Range::between(-90, 90),
              "lower block of model = table, for sensors of two blocks");
  b.numbers(
      "apex_m", {&o.upperApex, &o.lowerApex}, Range::any(), "m",
      "where the beams of elevations_deg and of lower_elevations_deg start, above the origin");
  b.integer("rows", o.rows, Range::between(2, 1024), "", "beams of model = uniform");
  b.angleDeg("fov_up_deg", o.fovUp, Range::between(-90, 90), "topmost beam of model = uniform");
  b.angleDeg("fov_down_deg", o.fovDown, Range::between(-90, 90), "lowest beam of model = uniform");
  b.integer("columns", o.columns, Range::between(0, 65536), "",
            "firing steps a turn, 0: the model's");
  b.number("height_m", o.height, Range::any(), "m", "optical centre above ground");
  b.numbers("origin", {&o.originX, &o.originY, &o.originZ}, Range::any(), "m",
            "optical centre, x y z along the robot's axes from the origin of the clouds");
  b.number("min_range_m", o.minRange, notNegative, "m", "nearer returns are the vehicle");
  b.number("max_range_m", o.maxRange, positive, "m", "farther returns are not used");
  b.flag("check_beams", o.checkBeams,
         "true: a scan that contradicts the above is refused, looked for in the first three");
  b.check(o);
}

void bind(Binder& b, ExtractionOptions& o) {
  b.section("extraction", "How poles are found");
  b.choice<ExtractionMethod>(
      "method", o.method,
      {{ExtractionMethod::rangeImage, "range_image"}, {ExtractionMethod::scanLine, "scan_line"}},
      "the paper's Algorithm 1, or scan lines of real beams");
  bind(b, o.rangeImage);
  bind(b, o.scanLine);
  b.check(o);
}

void bind(Binder& b, PoleMapOptions& o) {
  b.section("map", "How a map is built");
  b.number("section_length_m", o.sectionLength, positive, "m", "length of a section of the path");
  b.flag("every_scan", o.everyScan, "true: all scans count; false: the middle one of a section");
  b.choice<SectionMiddle>(
      "middle", o.middle, {{SectionMiddle::nearest, "nearest"}, {SectionMiddle::passed, "passed"}},
      "scan nearest to the middle of a section, or the first past it (first implementation)");
  b.choice<MapMerging>("merging", o.merging,
                       {{MapMerging::gated, "gated"}, {MapMerging::boxes, "boxes"}},
                       "by distance to a pole, or all whose boxes overlap and their plain mean "
                       "(first implementation)");
  b.number("merge_distance_m", o.mergeDistance, positive, "m",
           "merging = gated: detections this near are one pole");
  b.choice<PoleCounting>("counting", o.counting,
                         {{PoleCounting::run, "run"}, {PoleCounting::members, "members"}},
                         "sections of one run (paper), or detections (first implementation)");
  b.integer("min_count", o.minCount, Range::atLeast(1), "", "least count of a pole");
  b.integer("max_gap", o.maxGap, notNegative, "", "occupied sections a run may miss it");
  b.number(
      "min_confidence", o.minConfidence, share, "",
      "detections below are not used; scans are searched down to it, 0: to that of [scan_line]");
  b.number("min_share", o.minShare, share, "",
           "of the sections that pass a pole nearby, so many must have seen it");
  b.number("near_range_m", o.nearRange, positive, "m", "for min_share");
  b.number("pose_sigma_m", o.poseSigma, notNegative, "m", "sigma of the true positions");
  b.angleDeg("heading_sigma_deg", o.headingSigma, Range::between(0, 57),
             "sigma of the true headings: far detections count less");
  b.number("unvisited_m", o.unvisited, notNegative, "m",
           "later sessions: only scans this far from all places visited before, 0: all");
  b.check(o);
}

void bind(Binder& b, LikelihoodOptions& o) {
  b.section("likelihood", "How well detections fit a map at a pose");
  b.choice<LikelihoodModel>(
      "model", o.model,
      {{LikelihoodModel::paper, "paper"},
       {LikelihoodModel::mixture, "mixture"},
       {LikelihoodModel::floored, "floored"}},
      "Eq. 3 of the paper, with a share of outliers, or with a floor (first implementation)");
  b.number("sigma_m", o.sigma, positive, "m", "deviation of a detection from its map pole");
  b.number("outlier", o.outlier, Range::inside(0, 1), "", "share of detections not in the map");
  b.number("floor", o.floor, positive, "1/m", "model = floored: added to the normal density");
  b.number("gate_m", o.gate, positive, "m", "farther poles are no match");
  b.flag("weighted", o.weighted, "true: each detection's covariance and confidence count");
  b.check(o);
}

}  // namespace polemcl
