#include "extract/ExtractApp.h"

#include <iostream>

#include "cli/CommandLine.h"
#include "cli/Messages.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "cli/SensorCounts.h"
#include "extract/InspectApp.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "mrpt/observation/ObservationPoints.h"
#include "mrpt/rawlog/GnssFixes.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "report/picture/Pictures.h"

namespace polemcl::apps {
namespace {

constexpr int kReasons = static_cast<int>(RejectionReason::count_);

void writeRows(std::ostream& out, const ReadScan& scan) {
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

/// The settings of the LiDAR that made a scan.
LidarOptions lidarOf(const mrpt::obs::CObservation& scan, const AllSettings& settings) {
  const auto named = settings.vehicle.indexOf(scan.sensorLabel);
  return named ? settings.vehicle.lidars[*named]
               : LidarOptions{"", settings.sensor, settings.extraction};
}

/// Appends the points of one LiDAR, turned upright, in the frame of the poles.
/// \param T_poles_lidar Planar pose of the LiDAR in that frame.
void addPoints(const mrpt::obs::CObservation& scan, const LidarOptions& lidar,
               const Pose2D& T_poles_lidar, double above, io::Cloud& cloud) {
  ObservationPoints source(lidar.sensor);
  const ObservationPoints::Loan loan(source);
  const PointsView points = source.read(scan);
  const auto pose = lidar.extractor().poseOf(scan);
  const mrpt::poses::CPose3D upright(T_poles_lidar.x, T_poles_lidar.y, above, T_poles_lidar.yaw,
                                     pose.pitch(), pose.roll());
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto point = upright.composePoint({points.x[i], points.y[i], points.z[i]});
    cloud.x.push_back(static_cast<float>(point.x));
    cloud.y.push_back(static_cast<float>(point.y));
    cloud.z.push_back(static_cast<float>(point.z));
  }
}

/// The points of the scan in the frame of its poles; z is 0 at the height of the first LiDAR.
io::Cloud pointsOf(const ReadScan& scan, const AllSettings& settings) {
  io::Cloud cloud;
  const double height = lidarOf(*scan.sources.front(), settings).sensor.height;
  for (const auto& source : scan.sources) {
    const LidarOptions lidar = lidarOf(*source, settings);
    const auto pose = lidar.extractor().poseOf(*source);
    const Pose2D T_poles_lidar =
        relative(scan.observation->planarSensorPose(), {pose.x(), pose.y(), pose.yaw()});
    addPoints(*source, lidar, T_poles_lidar, lidar.sensor.height - height, cloud);
  }
  return cloud;
}

/// The scan from above with the poles that were found in it.
void drawFromAbove(const ReadScan& scan, const AllSettings& settings, const std::string& title,
                   const std::filesystem::path& png) {
  const io::Cloud cloud = pointsOf(scan, settings);
  report::ScanView view;
  view.title = title;
  view.points = cloud.view();
  view.poles = scan.observation->poles;
  view.ground = scan.report.ground != 0 ? scan.report.ground
                                        : -lidarOf(*scan.sources.front(), settings).sensor.height;
  report::drawScanPng(view, png);
}

/// The steps of the range-image method; of the first LiDAR if there are several.
void drawRangeImage(const ReadScan& scan, const AllSettings& settings, const std::string& title,
                    const std::filesystem::path& png) {
  const mrpt::obs::CObservation& source = *scan.sources.front();
  const LidarOptions lidar = lidarOf(source, settings);
  const io::Cloud cloud = ObservationPoleExtractor(lidar.extractor()).lidarPoints(source);
  report::drawRangeImagePng({title, cloud.view(), lidar.sensor, lidar.extraction.rangeImage}, png);
}

/// A scan that can be drawn.
const ReadScan& withPoints(const ReadScan& scan, const ExtractOptions& options) {
  if (scan.stored)
    throw Error(options.input.string() + ": scan " + std::to_string(scan.index) +
                " holds poles, no points to draw");
  return scan;
}

void draw(const ReadScan& scan, const AllSettings& settings, const ExtractOptions& options) {
  const std::string title =
      options.input.filename().string() + ", scan " + std::to_string(scan.index);
  if (options.png) drawFromAbove(scan, settings, title, *options.png);
  if (options.rangeImage) drawRangeImage(scan, settings, title, *options.rangeImage);
}

/// What went wrong; empty: nothing. It is no reason to lose the poles.
std::string tryToDraw(const std::optional<ReadScan>& scan, const ExtractSummary& summary,
                      const AllSettings& settings, const ExtractOptions& options) {
  if (!scan)
    return options.input.string() + ": no scan " + std::to_string(options.pngScan) +
           " to draw; there are " + std::to_string(summary.counts.scans) + ", numbered from 0";
  try {
    draw(*scan, settings, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
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
  printSensors(std::cout, counts);
  if (counts.unknownMotions > 0)
    std::cout << "scans without odometry: " << counts.unknownMotions << '\n';
  std::cout << "points: " << sum.points << ", invalid " << sum.invalid << ", out of view "
            << sum.outOfView << ", out of range " << sum.outOfRange << '\n'
            << "candidates: " << sum.candidates;
  for (int i = 0; i < kReasons; ++i)
    if (sum.refused[i] > 0)
      std::cout << ", " << name(static_cast<RejectionReason>(i)) << ' ' << sum.refused[i];
  std::cout << '\n';
  if (counts.truncated) std::cout << "the input ended too early; what could be read was used\n";
}

}  // namespace

void ExtractOptions::validate() const {
  if (output.extension() != ".rawlog")
    throw Error("--output " + output.string() + ": the name must end in .rawlog");
}

ExtractSummary extractPoles(const ExtractOptions& options, const AllSettings& settings,
                            const ScanProgress& progress) {
  options.validate();
  SequenceOptions sequence = settings.reading();
  sequence.allowTruncated = options.allowTruncated;
  if (options.rangeImage && settings.extraction.method != ExtractionMethod::rangeImage)
    throw Error(
        "--range-image draws [extraction] method = range_image, but the settings say "
        "scan_line; add --set extraction.method=range_image, or leave the picture out");
  const bool drawing = options.png || options.rangeImage;
  // Applied by whoever reads the poles; here it would count twice.
  sequence.motion.covarianceFactor = 1;

  RawlogWriter rawlog(options.output.string());
  GnssWriter gnss(rawlog, readGnssObservations(options.input.string(), options.allowTruncated));
  std::optional<io::AtomicFile> csv;
  if (options.csv) {
    csv.emplace(*options.csv);
    csv->stream() << "scan,timestamp,x,y,radius,bottom,top,confidence,points,cxx,cxy,cyy\n";
  }
  ExtractSummary summary;
  std::optional<ReadScan> drawn;
  summary.counts = streamPoles(options.input.string(), sequence, [&](const ReadScan& scan) {
    const auto motion = scan.index == 0 ? standstill() : scan.motion;
    gnss.writeBefore(scan.observation->timestamp);
    rawlog.write(makeActions(motion, scan.observation->timestamp), scan.observation);
    if (csv) writeRows(csv->stream(), scan);
    summary.extraction += scan.report;
    if (drawing && scan.index == options.pngScan) drawn = withPoints(scan, options);
    if (progress) progress(scan.index + 1, scan.expected);
  });
  if (summary.counts.scans == summary.counts.emptyScans)
    throw Error(options.input.string() + ": no usable scan, " +
                std::to_string(summary.counts.emptyScans) + " scans in it, all without a point");
  gnss.writeRest();
  io::AtomicFiles together;
  const std::string undrawn = drawing ? tryToDraw(drawn, summary, settings, options) : "";
  if (!undrawn.empty() && std::filesystem::is_regular_file(*options.png))
    std::filesystem::remove(*options.png);  // of other poles
  if (csv) csv->commit();
  rawlog.commit();
  together.commit();
  if (!undrawn.empty()) throw Error(undrawn + "; the poles are written");
  return summary;
}

namespace {

void runExtraction(const ExtractOptions& options, const AllSettings& settings, bool quiet) {
  const auto summary = extractPoles(options, settings, Progress("extract", 0, quiet).updates());
  if (!quiet) print(summary, options);
  for (const std::string& doubt : turnDoubts(summary.counts, settings.sensor.timing))
    std::cerr << warningLine("pole-extract", options.input.string() + ": " + doubt) << '\n';
  if (summary.counts.poles == 0)
    std::cerr << warningLine("pole-extract", options.input.string() + ": no pole in any of " +
                                                 std::to_string(summary.counts.scans) +
                                                 " scans: check [sensor] and [extraction]\n");
}

void runInspection(const InspectOptions& options, bool quiet) {
  const Inspection inspection = inspect(options, Progress("inspect", 0, quiet).updates());
  if (quiet) return;
  printInspection(std::cout, inspection);
  if (options.writeConfig)
    std::cout << "written           " << options.writeConfig->string() << '\n';
}

const Guides kExtractGuides{
    {"",
     {{"pole-extract --config demo.ini --input scans.rawlog --output poles.rawlog --csv "
       "poles.csv --png scan.png",
       "pole-extract --inspect scans.rawlog --write-config my.ini"},
      "Rawlogs of poles take the place of rawlogs of scans: pole-map build --config demo.ini "
      "--input poles.rawlog --truth scans.tum --output scans.polemap."}},
};

}  // namespace

int extractMain(int argc, const char* const* argv) {
  CommandLine line("pole-extract",
                   "Extracts the poles of every scan of a rawlog, or inspects its LiDAR.",
                   kExtractGuides);
  ExtractOptions options;
  InspectOptions inspection;
  std::string config;
  std::vector<std::string> set;
  auto& cli = line.cli();
  addSetOption(cli, set);
  auto* inspected = addFile(cli, "--inspect", inspection.input,
                            "Rawlog of scans: estimate its LiDAR's beams and mounting, and "
                            "from its poles and motion when the points were measured");
  addOutput(cli, "--write-config", inspection.writeConfig, "INI file to write for that LiDAR")
      ->needs(inspected);
  addFile(cli, "--truth", inspection.truth, "TUM file of true poses for --inspect")
      ->needs(inspected);
  cli.add_option("--turn-s", inspection.turnSeconds, "Duration of a turn for --inspect, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->needs(inspected);
  auto* configured = addConfigOption(cli, config, ", needed without --inspect");
  auto* input = addFile(cli, "--input", options.input, "Rawlog of scans, needed without --inspect");
  auto* output = addOutput(cli, "--output", options.output,
                           "Rawlog of poles to write, needed without --inspect");
  auto* csv = addOutput(cli, "--csv", options.csv, "Also write the poles to this table");
  auto* png = addOutput(cli, "--png", options.png, "Draw one scan from above with its poles");
  auto* rangeImage =
      addOutput(cli, "--range-image", options.rangeImage,
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
