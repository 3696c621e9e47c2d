#include "extract/InspectApp.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

#include "config/Config.h"
#include "core/common/Angles.h"
#include "core/common/Binder.h"
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "io/data/Trajectory.h"
#include "io/file/Bytes.h"
#include "io/file/InstalledFiles.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double kUsualDistance = 0.08;  ///< m; see share/doc/motion.md
constexpr double kHalfSure = 2;          ///< standard errors by which a turn is worth a try

/// Models with a configuration of their own.
constexpr struct {
  const char *model, *file, *remark;
} kShipped[] = {{"hdl64e", "kitti.ini", " (ranges: of KITTI's own)"},
                {"hdl32e", "hdl32e.ini", ""},
                {"vlp16", "vlp16.ini", ""}};

std::string degrees(double radians, int digits = 2) {
  return io::fixed(radians / degree, digits);
}

void printBeams(std::ostream& out, const SensorIdentification& sensor) {
  const BeamTableEstimate& beams = sensor.beams;
  const auto all = beams.elevations();
  out << "beams             " << beams.beams() << '\n';
  for (const BeamBlock& block : beams.blocks) {
    if (beams.blocks.size() > 1)
      out << "  block of " << block.elevations.size() << " starting " << io::fixed(block.apex, 3)
          << " m above the origin of the clouds\n";
    for (std::size_t i = 0; i < block.elevations.size(); ++i)
      out << (i % 8 == 0 ? "    " : " ") << degrees(block.elevations[i])
          << (i % 8 == 7 || i + 1 == block.elevations.size() ? "\n" : "");
  }
  out << "field of view     " << degrees(all.front()) << " to " << degrees(all.back()) << " deg, "
      << io::fixed(100 * sensor.covered, 0) << " % of the turn\n"
      << "sharpness         " << io::fixed(100 * beams.sharpness, 1)
      << " % of the returns in the middle third of their beam's cell, median deviation "
      << degrees(beams.spread, 3) << " deg\n";
  if (beams.origin.slide != 0)
    out << "motion            corrected in these clouds: "
        << io::fixed(std::abs(beams.origin.slide), 2) << " m a turn\n";
}

/// What to do where scans are longer than a turn, as by the one in the middle.
void printSweep(std::ostream& out, std::vector<PointOrder> orders) {
  if (orders.empty()) return;
  const auto middle = orders.begin() + static_cast<std::ptrdiff_t>(orders.size() / 2);
  std::nth_element(orders.begin(), middle, orders.end(),
                   [](const PointOrder& a, const PointOrder& b) { return a.sweep < b.sweep; });
  if (middle->sweep <= kMoreThanATurn) return;
  out << "sweep             " << degrees(middle->sweep, 0)
      << " deg a scan, of which moving_cut = true uses 360. A turn takes "
      << io::fixed(2 * M_PI / middle->sweep, 3)
      << "\n                  of the time between scans: where that is 0.1 s, give --turn-s "
      << io::fixed(0.1 * 2 * M_PI / middle->sweep, 4) << " here\n";
}

void printMounting(std::ostream& out, const RawlogInspection& inspection) {
  const SensorIdentification& sensor = inspection.sensor;
  const SensorOptions& options = inspection.options;
  out << "firing steps      ";
  if (sensor.columns > 0)
    out << sensor.columns << " a turn\n";
  else
    out << "unknown: neighbours on a beam have no common step\n";
  printSweep(out, inspection.orders);
  out << "ranges            " << io::fixed(sensor.nearest, 1) << " to "
      << io::fixed(sensor.farthest, 1) << " m (1 % to 99 % of the returns)\n"
      << "optical centre    " << io::fixed(options.originX, 3) << ' '
      << io::fixed(options.originY, 3) << ' ' << io::fixed(options.originZ, 3)
      << " m from the origin of the clouds, robot's axes\n";
  if (sensor.ground)
    out << "height            " << io::fixed(options.height, 2) << " m above ground ("
        << io::fixed(100 * sensor.ground->share, 0) << " % of the surroundings lie in its plane)\n"
        << "tilt              roll " << degrees(sensor.ground->roll()) << " deg, pitch "
        << degrees(sensor.ground->pitch()) << " deg over that plane\n";
  else
    out << "height            unknown: no ground plane around the sensor; height_m is a default\n";
  if (sensor.onItsHead)
    out << "upside down       the ground lies above the origin: the z axis of these clouds points "
           "down.\n                  All of the above is for the clouds turned over; import them "
           "again with a\n                  --sensor-pose whose roll is 180 deg, else the "
           "configuration does not fit\n";
}

void printPresets(std::ostream& out, const RawlogInspection& inspection) {
  const SensorIdentification& sensor = inspection.sensor;
  out << "presets           ";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, sensor.presets.size()); ++i) {
    const PresetFit& fit = sensor.presets[i];
    out << (i > 0 ? "                  " : "") << fit.model
        << (fit.upsideDown ? " upside down" : "") << ": " << fit.matched << " of "
        << sensor.beams.beams() << " beams found beside one of its " << fit.rows;
    if (fit.matched > 0)
      out << ", " << degrees(fit.rms, 3) << " deg off (rms), " << io::fixed(100 * fit.rmsShare, 0)
          << " % of the angle between beams";
    out << '\n';
  }
  if (const PresetFit* fit = sensor.preset()) {
    out << "fits              model = " << fit->model
        << (fit->upsideDown ? ", upside_down = true" : "") << '\n';
    for (const auto& shipped : kShipped)
      if (fit->model == shipped.model)
        out << "                  config/" << shipped.file << shipped.remark
            << " has settings chosen for this LiDAR\n";
  } else
    out << "fits              no preset; model = table with the elevations above\n";
}

void printCut(std::ostream& out, const ScanTiming& timing, double arc) {
  out << name(timing.turn);
  if (!timing.known()) {
    out << ", as far as the poles show";
    return;
  }
  if (timing.movingCut)
    out << ", each scan cut at its first point (these lie " << degrees(arc, 0) << " deg apart)";
  else
    out << ", cut at " << degrees(timing.cut, 0) << " deg";
  if (timing.stamp == 0.5)
    out << ", stamped in the middle of the turn";
  else
    out << ", stamped at " << io::fixed(timing.stamp, 2) << " of the turn";
  if (!timing.movingCut && arc > kMovingBegin)
    out << "\n                  but the scans begin at points " << degrees(arc, 0)
        << " deg apart: no single cut fits them";
}

const char* judged(double distance) {
  return distance > kUsualDistance ? " (below 0.08 m is usual: poses, clock or timing are off)"
                                   : " (below 0.08 m is usual)";
}

/// `clock_offset_s` for the rawlog: what a stated timing says of the clock is added to it.
double clockOffset(const Inspection& inspection) {
  const TimingEstimate& found = *inspection.timing;
  return found.timing.clock - (found.isStated ? inspection.sensor.stated.clock : 0);
}

/// The turn that the order of the points tells, where nothing says that the scans are corrected for
/// motion. Where all begin alike, the poles know better, if they were asked.
std::optional<ScanTiming> turnOfOrder(const Inspection& inspection) {
  const RawlogInspection& scans = inspection.sensor;
  const auto isOther = [&](const PointOrder& one) { return one.turn != scans.orders[0].turn; };
  if (scans.orders.empty() || scans.isTimed || scans.sensor.beams.origin.slide != 0 ||
      std::any_of(scans.orders.begin(), scans.orders.end(), isOther))
    return std::nullopt;
  ScanTiming timing;
  timing.turn = scans.orders[0].turn;
  timing.cut = scans.orders[0].begin;
  timing.movingCut = beginArc(scans.orders) > kMovingBegin;
  const bool asked = inspection.timing && inspection.timing->pairs > 0;
  return timing.movingCut || !asked ? std::optional(timing) : std::nullopt;
}

std::string settingsOf(const ScanTiming& timing) {
  return "turn = " + name(timing.turn) + ", " +
         (timing.movingCut ? "moving_cut = true" : "cut_deg = " + degrees(timing.cut, 0));
}

/// The turn that may be right though the poles do not show it clearly, or were not asked.
std::optional<ScanTiming> likelyTurn(const Inspection& inspection) {
  const std::optional<TimingEstimate>& found = inspection.timing;
  if (inspection.sensor.sensor.onItsHead)  // seen from there, it turns the other way
    return std::nullopt;
  if (found && found->candidate.known() && found->turnSignificance >= kHalfSure &&
      found->withCandidate <= kUsualDistance)
    return found->candidate;
  return turnOfOrder(inspection);
}

void printDoubt(std::ostream& out, const Inspection& inspection) {
  if (inspection.sensor.sensor.onItsHead) return;
  const std::optional<TimingEstimate>& found = inspection.timing;
  if (const auto order = turnOfOrder(inspection)) {
    out << "                  The points are in the order of measuring, " << name(order->turn)
        << ", and begin ";
    if (order->movingCut)
      out << "up to\n                  " << degrees(beginArc(inspection.sensor.orders), 0)
          << " deg apart, as those of raw scans"
          << (found ? "; poses found from raw scans hide it.\n" : ".\n");
    else
      out << "at\n                  " << degrees(order->cut, 0) << " deg.\n";
  }
  if (found && found->candidate.known()) {
    out << "                  Not sure: with " << settingsOf(found->candidate)
        << ", a pole moves by " << io::fixed(found->withCandidate, 4) << " m,\n                  "
        << io::fixed(found->turnSignificance, 1) << " standard errors better (4 are needed).\n";
  }
  if (const auto likely = likelyTurn(inspection))
    out << "                  Unless the scans were corrected for motion, set "
        << settingsOf(*likely) << '\n';
}

void printTiming(std::ostream& out, const Inspection& inspection) {
  const std::optional<TimingEstimate>& found = inspection.timing;
  out << "scan timing       ";
  if (!found) {
    out << (inspection.sensor.sensor.onItsHead
                ? "not looked for in clouds that are upside down\n"
                : "not looked for: this rawlog has no odometry between all scans; --truth S.tum\n"
                  "                  gives the motion: S.tum beside S.rawlog, where the dataset "
                  "has poses; or a path of\n"
                  "                  `pole-map build --trajectory`, which cannot show a timing "
                  "that it has swallowed\n");
    printDoubt(out, inspection);
    return;
  }
  if (found->pairs == 0) {
    out << "unknown: no pole was seen from two places\n";
    printDoubt(out, inspection);
    return;
  }
  const ScanTiming& timing = found->timing;
  if (found->isStated) out << "as the rawlog states it: ";
  printCut(out, timing, found->isStated ? 0 : beginArc(inspection.sensor.orders));
  out << '\n';
  if (!timing.known()) printDoubt(out, inspection);
  out << "clock             "
      << (clockOffset(inspection) != 0 ? "clock_offset_s = " + io::fixed(clockOffset(inspection), 2)
                                       : "no offset seen")
      << "\nsignificance      " << found->pairs << " pairs of sightings, a pole moves by "
      << io::fixed(found->before, 4) << " m between two scans as they are, by "
      << io::fixed(found->after, 4) << " m\n                  with this timing"
      << judged(found->after) << ";\n                  ";
  if (found->isStated && found->turnSignificance <= 0)
    out << "no other turn is better";
  else
    out << (found->isStated ? "the best other turn is " : "turn ")
        << io::fixed(found->turnSignificance, 1) << " standard errors better"
        << (found->isStated ? "" : " than none");
  out << ", the best clock " << io::fixed(found->clockSignificance, 1) << " (4 are needed)\n";
}

void printRanges(std::ostream& out, const Inspection& inspection) {
  const std::optional<RangeCorrection>& found = inspection.ranges;
  out << "ranges of poles   ";
  if (!found) {
    out << "unknown: needs --truth S.tum, and poles that were seen from two places 100 times\n";
    return;
  }
  if (found->isClear())
    out << "range_offset_m = " << io::fixed(found->offset, 3)
        << ", range_scale = " << io::fixed(found->scale, 4) << '\n';
  else
    out << "no error seen\n";
  out << "                  a pole moves by " << io::fixed(found->before, 4)
      << " m between two scans, with offset and scale by " << io::fixed(found->after, 4)
      << " m;\n                  " << io::fixed(found->significance, 1)
      << " standard errors better than none (4 are needed)\n";
}

/// A turn of one second from azimuth 0, or from the first point: the time offset of a detection
/// tells its azimuth. Of scans of more than a turn, the one in the middle is used.
ScanTiming azimuthAsTime(bool movingCut) {
  return {Turn::counterclockwise, 1, 0, movingCut ? 0.5 : 0, 0, movingCut};
}

/// The places of the poles of a drive, with azimuths in the place of time offsets. None if a scan
/// has no motion.
std::optional<std::vector<TimedScan>> readDrive(const InspectOptions& options, AllSettings settings,
                                                bool movingCut, const ScanProgress& progress) {
  settings.sensor.timing = azimuthAsTime(movingCut);
  const PoleSequence drive = readPoleSequence(
      options.input.string(), {settings.poleExtraction(), settings.motion, options.allowTruncated},
      progress);
  std::vector<StampedPose2D> truth;
  if (options.truth) truth = io::readPlanarTum(*options.truth);
  std::vector<TimedScan> scans;
  Pose2D dead;  // reckoning
  for (const PoleScan& frame : drive.frames) {
    if (!options.truth && !frame.motion) return std::nullopt;
    if (!options.truth) dead = compose(dead, frame.motion->mean);
    const auto pose = options.truth ? poseAt(truth, frame.time, longestTruthGap) : dead;
    if (!pose) continue;
    TimedScan scan{frame.time, *pose, {}};
    for (const PoleDetection& pole : frame.poles_robot)
      scan.poles_robot.push_back(
          {pole.x, pole.y, 2 * M_PI * (pole.timeOffset + settings.sensor.timing.stamp)});
    scans.push_back(std::move(scan));
  }
  return scans;
}

/// Looks for timing and ranges. \return Whether the drive can tell.
bool searchDrive(const InspectOptions& options, bool movingCut, Inspection& found,
                 const ScanProgress& progress) {
  const auto scans = readDrive(options, settingsFor(found), movingCut, progress);
  if (!scans) return false;
  found.timing = searchTiming(*scans, options.turnSeconds, found.sensor.stated);
  if (!options.truth) return true;
  const mrpt::poses::CPose3D& mount = found.sensor.sensorPose;
  const SensorOptions& sensor = found.sensor.options;
  found.ranges = searchRangeCorrection(*scans, found.timing->timing,
                                       {mount.x() + sensor.originX, mount.y() + sensor.originY});
  return true;
}

/// Takes the first point of each scan as its cut if that is what was found from the azimuths after
/// it. \return Whether it is.
bool cutAtFirstPoint(ScanTiming& timing, Turn turn) {
  constexpr double kNearBegin = M_PI / 6;  // cuts are searched in steps of half of it
  if (timing.turn != turn || std::abs(std::remainder(timing.cut, 2 * M_PI)) > kNearBegin)
    return false;
  timing.cut = ScanTiming().cut;  // not used
  timing.movingCut = true;
  return true;
}

/// The timing, with the first point of each scan as its cut where these lie far apart and the poles
/// agree; and the ranges.
void searchDrive(const InspectOptions& options, Inspection& result, const ScanProgress& progress) {
  const std::vector<PointOrder>& orders = result.sensor.orders;
  if (beginArc(orders) <= kMovingBegin) {
    searchDrive(options, false, result, progress);
    return;
  }
  Inspection moving{result.sensor, {}, {}};
  moving.sensor.stated = {};  // it names a single cut
  try {
    if (!searchDrive(options, true, moving, progress)) return;
  } catch (const Error&) {  // a scan whose points are in another order has no begin
    searchDrive(options, false, result, progress);
    return;
  }
  if (cutAtFirstPoint(moving.timing->timing, orders.front().turn)) {
    result = moving;
    return;
  }
  searchDrive(options, false, result, progress);
  if (result.timing->timing.known()) return;
  if (cutAtFirstPoint(moving.timing->candidate, orders.front().turn))
    result.timing = moving.timing;
  else
    result.timing->candidate = {};  // a single cut, which does not fit them
}

/// What the configuration that ships for this model sets beside [sensor], as text of an INI file.
/// Empty if none ships, or where it is not installed.
std::string chosenFor(const std::string& model) {
  for (const auto& shipped : kShipped) {
    if (model != shipped.model) continue;
    const std::filesystem::path file = io::fileOfDataFolder(shipped.file, "config");
    const std::string text = file.empty() ? "" : io::readBytes(file);
    const std::size_t others = text.find("\n[", text.find("[sensor]"));
    if (others != std::string::npos)
      return std::string("\n# As config/") + shipped.file + text.substr(others);
  }
  return {};
}

/// What was looked for, and what was chosen for this LiDAR: all other keys keep their defaults. A
/// timing that was not found but may be right is a comment.
void saveSensor(const Inspection& inspection, const std::filesystem::path& file) {
  AllSettings settings = settingsFor(inspection);
  ConfigWriter writer(Tier::tuning);
  bind(writer, settings.sensor);
  const PresetFit* preset = inspection.sensor.sensor.preset();
  const auto likely = settings.sensor.timing.known() ? std::nullopt : likelyTurn(inspection);
  io::writeFile(
      file.string(),
      (likely ? "# Unless the scans were corrected for motion: " + settingsOf(*likely) + "\n\n"
              : "") +
          writer.text() + (preset ? chosenFor(preset->model) : ""));
}

}  // namespace

AllSettings settingsFor(const Inspection& inspection) {
  AllSettings settings;
  settings.sensor = inspection.sensor.options;
  if (inspection.timing &&
      (inspection.timing->timing.known() || inspection.timing->timing.clock != 0)) {
    settings.sensor.timing = inspection.timing->timing;
    if (inspection.timing->isStated) {  // `auto` takes what the rawlog states
      settings.sensor.timing = ScanTiming();
      settings.sensor.timing.clock = clockOffset(inspection);
    }
  }
  if (inspection.ranges && inspection.ranges->isClear()) {
    settings.sensor.rangeOffset = std::round(1e3 * inspection.ranges->offset) / 1e3;
    settings.sensor.rangeScale = std::round(1e4 * inspection.ranges->scale) / 1e4;
  }
  return settings;
}

Inspection inspect(const InspectOptions& options, const ScanProgress& progress) {
  Inspection result{inspectRawlog(options.input.string(), options.allowTruncated), {}, {}};
  if (!result.sensor.sensor.onItsHead)  // else poles are not found
    searchDrive(options, result, progress);
  if (options.writeConfig) saveSensor(result, *options.writeConfig);
  return result;
}

void printInspection(std::ostream& out, const Inspection& inspection) {
  const RawlogInspection& scans = inspection.sensor;
  out << "scans             " << scans.used.size() << " of " << scans.scans << " (" << scans.label
      << "), " << scans.sensor.points << " points, " << scans.sensor.invalid << " invalid\n";
  printBeams(out, scans.sensor);
  printMounting(out, scans);
  printPresets(out, scans);
  printTiming(out, inspection);
  printRanges(out, inspection);
}

}  // namespace polemcl::apps
