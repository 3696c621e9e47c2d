#include "localize/LocalizePlayer.h"

#include <cmath>
#include <filesystem>

#include "cli/Progress.h"
#include "cli/Projections.h"
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "core/global_localization/GlobalLocalizer.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "io/map/Datum.h"
#include "mrpt/rawlog/GnssFixes.h"

namespace polemcl::apps {

namespace {

constexpr double kSigmas = 5;
constexpr double kLasting = 10;   ///< m
constexpr double kFastest = 40;   ///< m/s
constexpr double kWithin = 5;     ///< s, of the first scan
constexpr double kNearest = 5e4;  ///< m, of the datum; what lies farther is no fix of this place

/// The fix of this place that is nearest in time to the first scan. Reads no farther than needed.
std::optional<GnssFix> nearestFix(const std::filesystem::path& rawlog, bool allowTruncated,
                                  double firstScan, const MapPlane& plane) {
  std::optional<GnssFix> nearest;
  findGnssFix(rawlog.string(), allowTruncated, [&](const GnssFix& fix) {
    if (plane.distanceTo({fix.longitude, fix.latitude}) > kNearest) return false;
    if (!nearest || std::abs(fix.time - firstScan) < std::abs(nearest->time - firstScan))
      nearest = fix;
    return fix.time > firstScan + kWithin;
  });
  return nearest;
}

/// Where the robot was at its first scan, by the usable fix within 50 km of the datum that is
/// nearest in time.
///
/// The radius is five standard deviations of the fix, 10 m for errors that last, the way of a fast
/// vehicle (40 m/s) between fix and scan, and the distance of the antenna from the robot's origin.
/// \param firstScan s. \param datum Of the map.
/// \throws Error when there is no such fix, or it is more than 5 s from the first scan.
SearchArea gnssStart(const std::filesystem::path& rawlog, bool allowTruncated, double firstScan,
                     const io::Datum& datum) {
  const MapPlane plane(datum);
  const auto fix = nearestFix(rawlog, allowTruncated, firstScan, plane);
  if (!fix)
    throw Error(rawlog.string() +
                ": holds no position from satellites (CObservationGPS with GGA) "
                "within 50 km of the map's datum " +
                io::datumText(datum) + ": start with --start or --global");
  const double apart = std::abs(fix->time - firstScan);
  if (apart > kWithin)
    throw Error(rawlog.string() + ": its nearest position from satellites is " +
                io::fixed(apart, 1) + " s from the first scan, at most " + io::fixed(kWithin, 0) +
                " s are allowed: start with --start or --global");
  SearchArea area;
  area.centre_map = plane.place({fix->longitude, fix->latitude});
  area.radius = kSigmas * fix->sigma + kLasting + kFastest * apart + fix->antenna_robot.norm();
  return area;
}

}  // namespace

LocalizePlayer::LocalizePlayer(LocalizeFacts& facts, const LocalizationMap& map,
                               const std::vector<StampedPose2D>* truth, const RunFolder& folder,
                               RunView& view, PoseStream* stream, RunBag* bag)
    : m_facts(facts),
      m_map(map),
      m_truth(truth),
      m_folder(folder),
      m_view(view),
      m_stream(stream),
      m_bag(bag) {}

void LocalizePlayer::take(const ReadScan& scan) {
  const std::string source = m_facts.job.source().string();
  if (scan.index > 0 && !scan.motion)
    throw Error(
        source + ": no odometry for scan " + std::to_string(scan.index) + ", at " +
        io::fixed(scan.time, 3) + " s: the filter needs it; " +
        (scan.index > 1 ? "leave out what comes before it begins or after it ends, or " : "") +
        "import with --odometry FILE, or from true poses with --odometry-noise; without either, "
        "pole-map build --trajectory FILE makes one of the poles");
  const PoleScan frame = frameOf(scan);
  if (!m_runs) begin(frame);
  const std::vector<FilterStep>& steps = *io::located(
      source + ": scan " + std::to_string(scan.index) + ": ", [&] { return &m_runs->step(frame); });
  const auto found = ScanClock::now();
  if (m_stream) m_stream->add(scan.index, steps[0].update, scan.dropped);
  m_timings.total.add(secondsSince(scan.arrival));

  if (m_truth) m_covered += poseAt(*m_truth, frame.time, longestTruthGap).has_value();
  for (std::size_t i = 0; i < steps.size(); ++i) m_files[i].add(steps[i].update);
  if (m_bag) m_bag->add(m_runs->localization(0), frame, steps[0].update);
  m_view.show(m_runs->localization(0), frame, steps[0].update, {scan.sources, scan.expected});
  m_timings.write.add(secondsSince(found));
  for (const FilterStep& step : steps) m_timings.step.add(step.seconds);
  m_timings.read.add(scan.readSeconds);
  if (!scan.stored) m_timings.extract.add(scan.extractSeconds);
}

void LocalizePlayer::begin(const PoleScan& first) {
  StartOptions& start = m_facts.settings.start;
  const LocalizeJob& job = m_facts.job;
  if (m_facts.datum)
    start.area = gnssStart(job.input, job.allowTruncated, first.time, *m_facts.datum);
  if (!start.anywhere && !start.pose) {
    start.pose = poseAt(*m_truth, first.time, longestTruthGap);
    if (!start.pose)
      throw Error(job.truth->string() + ": the truth does not reach the first scan, at " +
                  std::to_string(first.time) + " s: set position_m and yaw_deg in [start]");
  }
  m_runs = std::make_unique<FilterRuns>(m_map, m_facts.settings);
  m_files.reserve(m_runs->size());
  for (std::size_t i = 0; i < m_runs->size(); ++i) m_files.emplace_back(m_folder, i, m_truth);
}

std::string LocalizePlayer::whyUseless() const {
  const std::string input = m_facts.job.source().string();
  const SequenceCounts& counts = m_facts.counts;
  const std::string scans = std::to_string(counts.scans);
  if (counts.scans == 0 && m_facts.job.isLive())
    return input + (counts.unknownMotions > 0
                        ? ": none of " + std::to_string(counts.unknownMotions) +
                              " scans has odometry of its time: check the odometry and the clocks"
                        : ": no scan came: check the drivers, their ports and the network");
  if (counts.scans == 0)
    return input + ": holds no scan and no poles; import or extract them first";
  if (counts.emptyScans == counts.scans)
    return input + ": no usable scan: none of " + scans + " has a valid point";
  if (counts.poles == 0)
    return input + ": no pole in any of " + scans + " scans (" + std::to_string(counts.points) +
           " valid points, " + std::to_string(counts.emptyScans) +
           " empty scans): check [sensor] and [extraction]";
  if (m_truth && !isCovered())
    return m_facts.job.truth->string() + ": the truth covers " + std::to_string(m_covered) +
           " of " + scans + " scans, at least half are needed: does it belong to this rawlog?";
  return "";
}

bool LocalizePlayer::isCovered() const {
  return m_truth && 2 * m_covered >= m_facts.counts.scans;
}

LocalizeResult LocalizePlayer::finish() {
  LocalizeResult result;
  for (RunFiles& files : m_files) {
    const auto errors = files.finish(isCovered());
    if (m_truth) result.errors.push_back(errors);
    result.spreadCheck.ok += files.spreadCheck().ok;
    result.spreadCheck.beyond += files.spreadCheck().beyond;
  }
  m_view.finish();
  result.runs = m_runs->results();
  for (const FilterRun& run : result.runs) m_timings.filterSeconds.push_back(run.seconds);
  result.timings = m_timings;
  return result;
}

}  // namespace polemcl::apps
