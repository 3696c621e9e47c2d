#include "report/picture/Pictures.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/common/Binder.h"
#include "core/extraction/range_image/RangeImageExtractor.h"
#include "io/file/AtomicFile.h"
#include "io/file/Process.h"

namespace polemcl::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double widestScan = 60;  // m to each side
constexpr double degreesOfRadian = 180 / M_PI;

void draw(const Json& picture, const std::filesystem::path& file) {
  io::AtomicFile output(file);  // a file that cannot be written is told before it is drawn
  const std::string text = picture.dump(-1, ' ', false, Json::error_handler_t::replace);
  try {
    output.stream() << io::runFilter(io::pythonScript("draw.py"), text);
  } catch (const Error& error) {
    throw Error(file.string() + ": the picture could not be drawn: " + error.what());
  }
  output.commit();
}

/// Millimetres, in few letters.
double shortened(double metres) {
  return std::round(metres * 1e3) / 1e3;
}

Json placesOf(const std::vector<MapPole>& poles) {
  Json places = Json::array();
  for (const MapPole& pole : poles) places.push_back({pole.x, pole.y, pole.radius});
  return places;
}

Json placesOf(const std::vector<MapDiff::Pair>& pairs) {
  Json places = Json::array();
  for (const auto& [before, after, distance] : pairs)
    places.push_back({before.x, before.y, after.x, after.y});
  return places;
}

/// A list of places for each drive.
Json linesOf(const std::vector<StampedPose2D>& path) {
  Json lines = Json::array();
  for (const auto& drive : drivesOf(path)) {
    Json& line = lines.emplace_back(Json::array());
    for (const StampedPose2D& pose : drive) line.push_back({pose.pose.x, pose.pose.y});
  }
  return lines;
}

/// Null unless there are errors to draw.
Json errorsOf(const MapView& view) {
  if (view.truth.size() < 2 || view.estimate.empty()) return {};
  const TrajectoryErrors errors = evaluateTrajectory(view.truth, view.estimate, Sampling::perPose);
  if (errors.errors.empty()) return {};
  Json json = {{"poses", errors.poses},
               {"distance", distanceDriven(view.truth, errors.errors)},
               {"means", {errors.posMean, errors.angMeanDeg}},
               {"rmse", {errors.posRmse, errors.angRmseDeg}}};
  for (const PoseError& error : errors.errors) {
    json["position"].push_back(error.position);
    json["heading"].push_back(std::abs(error.heading) * degreesOfRadian);
  }
  return json;
}

/// How far to each side the scan is shown, m.
double reachOf(const ScanView& view) {
  double reach = 12;
  for (const PoleDetection& pole : view.poles) {
    if (!std::isfinite(pole.x + pole.y + pole.radius + pole.top + pole.confidence))
      throw Error("a pole of the picture has a number that is not finite");
    reach = std::max({reach, std::abs(pole.x) + 3, std::abs(pole.y) + 3});
  }
  return std::min(reach, widestScan);
}

/// The test that refused a segment.
const char* refusingTest(const std::optional<RejectionReason>& rejection) {
  if (!rejection) return "none";
  switch (*rejection) {
    case RejectionReason::notForeground:
      return "foreground";
    case RejectionReason::tooLow:
    case RejectionReason::startsTooHigh:
    case RejectionReason::tooShort:
      return "height";
    case RejectionReason::badFit:
      return "circle";
    case RejectionReason::notFree:
      return "free space";
    default:
      return "shape";
  }
}

}  // namespace

void drawMapPng(const MapView& view, const std::filesystem::path& file) {
  boundsOf(view);  // all is finite, and there is something
  Json loops = Json::array();
  for (const auto& [first, second] : view.loops)
    loops.push_back({first.x(), first.y(), second.x(), second.y()});
  draw({{"kind", "map"},
        {"title", view.title},
        {"poles", placesOf(view.poles)},
        {"truth", linesOf(view.truth)},
        {"estimate", linesOf(view.estimate)},
        {"loops", loops},
        {"errors", errorsOf(view)}},
       file);
}

void drawDiffPng(const MapDiff& diff, const std::string& title, const std::filesystem::path& file) {
  if (diff.same.empty() && diff.moved.empty() && diff.appeared.empty() && diff.vanished.empty())
    throw Error("picture: nothing to show: both maps are empty");
  draw({{"kind", "diff"},
        {"title", title},
        {"same", placesOf(diff.same)},
        {"moved", placesOf(diff.moved)},
        {"new", placesOf(diff.appeared)},
        {"vanished", placesOf(diff.vanished)}},
       file);
}

void drawScanPng(const ScanView& view, const std::filesystem::path& file) {
  if (view.points.size == 0) throw Error(file.string() + ": a scan without points to draw");
  Json points = Json::array(), poles = Json::array();
  for (std::size_t i = 0; i < view.points.size; ++i) {
    const double x = view.points.x[i], y = view.points.y[i], z = view.points.z[i];
    if (std::abs(x) <= widestScan && std::abs(y) <= widestScan && std::isfinite(z))
      points.push_back({shortened(x), shortened(y), shortened(z - view.ground)});
  }
  for (const PoleDetection& pole : view.poles)
    poles.push_back({pole.x, pole.y, pole.radius, pole.top, pole.confidence});
  draw({{"kind", "scan"},
        {"title", view.title},
        {"reach", reachOf(view)},
        {"points", points},
        {"poles", poles}},
       file);
}

void drawRangeImagePng(const RangeImageView& view, const std::filesystem::path& file) {
  if (view.points.size == 0) throw Error(file.string() + ": a scan without points to draw");
  checkOptions(view.options);
  RangeImageExtractor extractor(SensorModel(view.sensor), view.sensor, view.options);
  std::vector<PoleDetection> poles;
  ExtractionReport report;
  std::vector<SegmentOutcome> outcomes;
  extractor.extract(view.points, poles, report, &outcomes);
  const RangeImage& image = extractor.image();
  Json ranges = Json::array(), segments = Json::array();
  for (int row = 0; row < image.rows(); ++row)
    for (int column = 0; column < image.columns(); ++column)  // 0: no return that is used
      ranges.push_back(shortened(image.range(row, column)));
  for (const SegmentOutcome& outcome : outcomes) {
    Json pixels = Json::array();
    for (const Pixel& pixel : outcome.pixels)
      pixels.push_back(image.index(pixel.row, pixel.column));
    segments.push_back({{"refused_by", refusingTest(outcome.rejection)}, {"pixels", pixels}});
  }
  draw({{"kind", "range image"},
        {"title", view.title},
        {"rows", image.rows()},
        {"columns", image.columns()},
        {"max_range", view.options.maxRange},
        {"ranges", ranges},
        {"segments", segments}},
       file);
}

}  // namespace polemcl::report
