#include "extract/ExtractApp.h"

#include <iostream>

#include "cli/CommandLine.h"
#include "cli/Progress.h"
#include "cli/RawlogActions.h"
#include "extract/InspectApp.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "mrpt/observation/ObservationPoints.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "report/picture/RangeImagePicture.h"
#include "report/picture/ScanPicture.h"

namespace polemcl::apps {
namespace {

constexpr int reasons = static_cast<int>(RejectionReason::count_);

void add(const ExtractionReport& scan, ExtractionReport& sum) {
  sum.points += scan.points;
  sum.invalid += scan.invalid;
  sum.outOfView += scan.outOfView;
  sum.outOfRange += scan.outOfRange;
  sum.candidates += scan.candidates;
  for (int i = 0; i < reasons; ++i) sum.refused[i] += scan.refused[i];
}

void writeRows(std::ostream& out, const PoleScan& scan) {
  for (const auto& pole : scan.observation->polesInRobotFrame()) {
    out << scan.index << ',' << io::fixed(scan.time, 6);
    for (double value : {pole.x, pole.y, pole.radius, pole.bottom, pole.top, pole.confidence})
      out << ',' << io::fixed(value, 6);
    out << ',' << pole.points;
    for (double value : {pole.covariance(0, 0), pole.covariance(0, 1), pole.covariance(1, 1)})
      out << ',' << io::significant(value, 9);
    out << '\n';
  }
}

/// The points of the scan in the frame of its poles: upright, turned as the sensor is.
io::Cloud pointsOf(const PoleScan& scan, const SensorOptions& sensor) {
  ObservationPoints source(sensor);
  const ObservationPoints::Loan loan(source);
  const PointsView points = source.read(*scan.scan);
  const auto& pose = scan.observation->sensorPose;
  const mrpt::poses::CPose3D upright(0, 0, 0, 0, pose.pitch(), pose.roll());
  io::Cloud cloud;
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto point = upright.composePoint({points.x[i], points.y[i], points.z[i]});
    cloud.x.push_back(static_cast<float>(point.x));
    cloud.y.push_back(static_cast<float>(point.y));
    cloud.z.push_back(static_cast<float>(point.z));
  }
  return cloud;
}

/// The scan from above with the poles that were found in it.
void drawFromAbove(const PoleScan& scan, const Settings& settings, const std::string& title,
                   const std::filesystem::path& png) {
  const io::Cloud cloud = pointsOf(scan, settings.sensor);
  report::ScanView view;
  view.title = title;
  view.points = cloud.view();
  view.poles = scan.observation->poles;
  view.ground = scan.report.ground != 0 ? scan.report.ground : -settings.sensor.height;
  report::drawScanPng(view, png);
}

/// The steps of the range-image method.
void drawRangeImage(const PoleScan& scan, const Settings& settings, const std::string& title,
                    const std::filesystem::path& png) {
  const io::Cloud cloud =
      ObservationPoleExtractor(settings.poleExtraction()).lidarPoints(*scan.scan);
  report::drawRangeImagePng({title, cloud.view(), settings.sensor, settings.extraction.rangeImage},
                            png);
}

void draw(const PoleScan& scan, const Settings& settings, const ExtractOptions& options) {
  const std::string number = std::to_string(scan.index);
  if (scan.stored)
    throw Error(options.input.string() + ": scan " + number + " holds poles, no points to draw");
  const std::string title = options.input.filename().string() + ", scan " + number;
  if (options.png) drawFromAbove(scan, settings, title, *options.png);
  if (options.rangeImage) drawRangeImage(scan, settings, title, *options.rangeImage);
}

void print(const ExtractSummary& summary, const ExtractOptions& options) {
  const auto& counts = summary.counts;
  const auto& sum = summary.extraction;
  std::cout << options.output.string() << ": " << counts.poles << " poles in " << counts.scans
            << " scans\n";
  if (counts.emptyScans > 0)
    std::cout << "scans without a valid point: " << counts.emptyScans << '\n';
  if (counts.storedScans > 0)
    std::cout << "scans that were poles already: " << counts.storedScans << '\n';
  if (counts.otherSensors > 0)
    std::cout << "scans of other sensors, not used: " << counts.otherSensors << '\n';
  if (counts.unknownMotions > 0)
    std::cout << "scans without odometry: " << counts.unknownMotions << '\n';
  std::cout << "points: " << sum.points << ", invalid " << sum.invalid << ", out of view "
            << sum.outOfView << ", out of range " << sum.outOfRange << '\n'
            << "candidates: " << sum.candidates;
  for (int i = 0; i < reasons; ++i)
    if (sum.refused[i] > 0)
      std::cout << ", " << name(static_cast<RejectionReason>(i)) << ' ' << sum.refused[i];
  std::cout << '\n';
  if (counts.truncated) std::cout << "the input ended too early; what could be read was used\n";
}

}  // namespace

void ExtractOptions::validate() const {
  if (output.extension() != ".rawlog")
    throw Error("--output " + output.string() + ": the name must end in .rawlog");
  std::error_code ignored;
  if (std::filesystem::equivalent(input, output, ignored))
    throw Error("--output " + output.string() + ": is the input; give another name");
}

ExtractSummary extractPoles(const ExtractOptions& options, const Settings& settings,
                            const ScanProgress& progress) {
  options.validate();
  if (options.rangeImage && settings.extraction.method != ExtractionMethod::rangeImage)
    throw Error(
        "--range-image draws [extraction] method = range_image, but the settings say "
        "scan_line; add --set extraction.method=range_image, or leave the picture out");
  const bool drawing = options.png || options.rangeImage;
  SequenceOptions sequence{settings.poleExtraction(), settings.motion, options.allowTruncated};
  // Applied by whoever reads the poles; here it would count twice.
  sequence.motion.covarianceFactor = 1;

  RawlogWriter rawlog(options.output.string());
  std::optional<io::AtomicFile> csv;
  if (options.csv) {
    csv.emplace(*options.csv);
    csv->stream() << "scan,timestamp,x,y,radius,bottom,top,confidence,points,cxx,cxy,cyy\n";
  }
  ExtractSummary summary;
  summary.counts = streamPoles(options.input.string(), sequence, [&](const PoleScan& scan) {
    const auto motion = scan.index == 0 ? standstill() : scan.motion;
    rawlog.write(makeActions(motion, scan.observation->timestamp), scan.observation);
    if (csv) writeRows(csv->stream(), scan);
    add(scan.report, summary.extraction);
    if (drawing && scan.index == options.pngScan) draw(scan, settings, options);
    if (progress) progress(scan.index + 1, scan.expected);
  });
  if (summary.counts.scans == summary.counts.emptyScans)
    throw Error(options.input.string() + ": no usable scan, " +
                std::to_string(summary.counts.emptyScans) + " scans in it, all without a point");
  if (drawing && summary.counts.scans <= options.pngScan)
    throw Error(options.input.string() + ": no scan " + std::to_string(options.pngScan) +
                " to draw; there are " + std::to_string(summary.counts.scans) +
                ", numbered from 0");
  rawlog.commit();
  if (csv) csv->commit();
  return summary;
}

namespace {

void runExtraction(const ExtractOptions& options, const Settings& settings, bool quiet) {
  const auto summary = extractPoles(options, settings, Progress("extract", 0, quiet).updates());
  if (!quiet) print(summary, options);
}

void runInspection(const InspectOptions& options, bool quiet) {
  const Inspection inspection = inspect(options, Progress("inspect", 0, quiet).updates());
  if (quiet) return;
  printInspection(std::cout, inspection);
  if (options.writeConfig)
    std::cout << "written           " << options.writeConfig->string() << '\n';
}

}  // namespace

int extractMain(int argc, const char* const* argv) {
  CommandLine line("pole-extract",
                   "Extracts the poles of every scan of a rawlog, or inspects its LiDAR.");
  ExtractOptions options;
  InspectOptions inspection;
  std::string config;
  std::vector<std::string> set;
  auto& cli = line.cli();
  addSetOption(cli, set);
  auto* inspected = cli.add_option("--inspect", inspection.input,
                                   "Rawlog of scans: estimate its LiDAR's beams and mounting, and "
                                   "from its poles and motion when the points were measured");
  cli.add_option("--write-config", inspection.writeConfig, "INI file to write for that LiDAR")
      ->needs(inspected);
  cli.add_option("--truth", inspection.truth, "TUM file of true poses for --inspect")
      ->needs(inspected);
  cli.add_option("--turn-s", inspection.turnSeconds, "Duration of a turn for --inspect, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->needs(inspected);
  auto* configured = cli.add_option("--config", config, "INI file, see config/");
  auto* input = cli.add_option("--input", options.input, "Rawlog of scans");
  auto* output = cli.add_option("--output", options.output, "Rawlog of poles to write");
  auto* csv = cli.add_option("--csv", options.csv, "Also write the poles to this table");
  auto* png = cli.add_option("--png", options.png, "Draw one scan from above with its poles");
  auto* rangeImage = cli.add_option(
      "--range-image", options.rangeImage,
      "Draw the steps of method = range_image: ranges, segments, refused ones, poles");
  cli.add_option("--png-scan", options.pngScan, "The scan to draw, from 0")
      ->type_name("K")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  for (auto* option : {configured, input, output, csv, png, rangeImage})
    inspected->excludes(option);
  cli.add_flag("--allow-truncated", options.allowTruncated,
               "Use the readable part of a rawlog that was cut short");
  cli.parse_complete_callback([&] {
    if (inspected->count() > 0) return;
    for (const auto* option : {configured, input, output})
      if (option->count() == 0) throw CLI::RequiredError(option->get_name());
  });
  return line.run(argc, argv, [&] {
    inspection.allowTruncated = options.allowTruncated;
    if (inspected->count() > 0)
      runInspection(inspection, line.quiet());
    else
      runExtraction(options, loadSettings(config, set), line.quiet());
  });
}

}  // namespace polemcl::apps
