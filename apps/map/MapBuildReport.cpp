#include "map/MapBuildReport.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cli/Version.h"
#include "core/slam/DriveFixes.h"
#include "core/slam/PoleMotions.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double kManyTwins = 0.25;  ///< share of the poles
constexpr double kManyUntold = 0.1;  ///< share of the motions
constexpr double kLongUntold = 0.5;  ///< s: beyond, poles before and after need not find together

/// Motions of the odometry that the poles contradict; empty when there are none.
std::string odometryDoubt(const FilledMotions& filled) {
  if (filled.contradicted == 0) return {};
  return "the poles contradict " + std::to_string(filled.contradicted) + " of the " +
         std::to_string(filled.motions) + " motions of its odometry, the first at " +
         io::fixed(filled.firstContradicted, 3) +
         (filled.refuted ? " s: none of it is used, and the poles told the whole way; check frame "
                           "(x ahead, y to the left), metres, radians, and quaternions as x y z w"
                         : " s, and told the way there; check whether the odometry slips or starts "
                           "anew");
}

/// Motions that nothing tells; empty when these are few and short.
std::string coastingDoubt(const FilledMotions& filled) {
  const bool isMany =
      static_cast<double>(filled.coasted) > kManyUntold * static_cast<double>(filled.motions);
  if (!isMany && filled.longestCoast < kLongUntold) return {};
  return "neither odometry nor poles tell " + std::to_string(filled.coasted) + " of its " +
         std::to_string(filled.motions) + " motions, up to " + io::fixed(filled.longestCoast, 1) +
         " s on end, the first before " + io::fixed(filled.firstCoasted, 3) +
         " s: the path is a guess there, and the map may be torn; check whether its scans are all "
         "of one drive, in their order, and have the right times, or give odometry";
}

/// Positions from satellites of which many do not fit the path; empty otherwise.
std::string fixesDoubt(const FixFit& fit) {
  if (!fit.isDoubtful()) return {};
  return std::to_string(fit.given - fit.fitting) + " of " + std::to_string(fit.given) +
         " positions from satellites do not fit its path, they lie " + io::fixed(fit.distance, 2) +
         " m from it (median); the map may lie wrong on Earth by far more: a wrong clock shifts it "
         "by speed times time; check their clock (GPS time is 18 s ahead of UTC), the place of the "
         "antenna and sigma";
}

double scanSpacing(const MapBuildSummary& summary) {
  const std::size_t steps = summary.visited - std::min(summary.visited, summary.sessions.size());
  return steps > 0 ? summary.map.pathLength / static_cast<double>(steps) : 0;
}

const char* counted(PoleCounting counting) {
  switch (counting) {
    case PoleCounting::members:
      return " detections";
    case PoleCounting::confidences:
      return " sections of one run, weighed by confidence";
    case PoleCounting::run:
      return " sections of one run";
  }
  return "";
}

/// What a pole needs to be in the map.
std::string neededText(const MapBuildSummary& summary) {
  const double needed = summary.map.neededCount, least = summary.mapping.minCount;
  return io::significant(needed, 3) + counted(summary.mapping.counting) +
         " (min_count = " + io::significant(least, 4) +
         (needed < least ? ", less as scans are far apart)" : ")");
}

/// `f_map.NAME` of each session; of equal names the second is `f_map.NAME.2`.
void addShares(const MapBuildSummary& summary, std::map<std::string, std::string>& info) {
  for (const MapBuildSummary::Session& session : summary.sessions) {
    const std::string key = "f_map." + std::filesystem::path(session.name).stem().string();
    std::string unique = key;
    for (int n = 2; info.count(unique) > 0; ++n) unique = key + '.' + std::to_string(n);
    info[unique] = io::fixed(session.share, 6);
  }
}

/// A count in the info of a map; 0 where it has no such key.
double countIn(const std::map<std::string, std::string>& info, const std::string& key) {
  const auto fact = info.find(key);
  return fact == info.end() ? 0 : io::parseNumber(fact->second).value_or(0);
}

/// Positions from satellites of all drives; their distance is not summed up.
FixFit allFixes(const MappedDrives& mapped) {
  FixFit sum;
  for (const FixFit& fit : mapped.fixes) {
    sum.given += fit.given;
    sum.fitting += fit.fitting;
  }
  return sum;
}

/// Standard deviation of a place along an axis, m.
double sigmaOf(const PoseWithCovariance& pose) {
  return std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace() / 2);
}

/// What a map has of the drives it was made from.
std::map<std::string, std::string> driveFacts(const MapBuildSummary& summary) {
  std::string names;
  for (const MapBuildSummary::Session& session : summary.sessions)
    names += (names.empty() ? "" : " ") + session.name;
  std::map<std::string, std::string> info{
      {"inputs", names},
      {"scans", std::to_string(summary.scans)},
      {"path_length_m", io::fixed(summary.map.pathLength, 3)},
      {"sections", std::to_string(summary.map.sections)},
      {"occupied_sections", std::to_string(summary.map.occupiedSections)},
      {"detections", std::to_string(summary.map.detections)}};
  addShares(summary, info);
  if (summary.mapped) {
    info["poses"] = "odometry";
    info["loops"] = std::to_string(summary.mapped->newLoops());
    if (const std::size_t used = allFixes(*summary.mapped).fitting; used > 0)
      info["fixes"] = std::to_string(used);
  }
  if (summary.inventory) info["pose_sigma_m"] = io::fixed(summary.inventory->drives.sigma, 4);
  return info;
}

/// Joins what the map that is added to says: its poses, and its loops and fixes in the sums.
void addFacts(const std::map<std::string, std::string>& before,
              std::map<std::string, std::string>& info) {
  for (const char* key : {"warnings", "poses"})
    if (const auto earlier = before.find(key); earlier != before.end()) info[key] = earlier->second;
  for (const char* key : {"loops", "fixes"}) {
    const double sum = countIn(info, key) + countIn(before, key);
    if (sum > 0) info[key] = io::fixed(sum, 0);
  }
}

/// What odometry and positions from satellites were like on one drive.
void tellDrive(std::ostream& out, const MapBuildSummary& summary, std::size_t i,
               const std::string& drive) {
  const FixFit& fixes = summary.mapped->fixes[i];
  if (fixes.given > 0)
    out << drive << ": its " << fixes.given << " positions from satellites lie "
        << io::fixed(fixes.distance, 2) << " m from its path (median), "
        << fixes.given - fixes.fitting << " of them do not fit\n";
  if (i < summary.fixesApart.size() && summary.fixesApart[i] > 0)
    out << drive << ": left out " << summary.fixesApart[i]
        << " positions from satellites between scans more than 2 s and 10 m apart\n";
  const FilledMotions& filled = summary.filled[i];
  if (const std::size_t missing = filled.byPoles + filled.coasted; missing > 0)
    out << drive << ": no odometry leads to " << missing << " scans; the poles told the way to "
        << filled.byPoles
        << (filled.coasted > 0 ? ", " + std::to_string(filled.coasted) +
                                     " go on as before: look there, the first at " +
                                     io::fixed(filled.firstCoasted, 3) + " s\n"
                               : "\n");
  if (filled.all) return;
  const auto& odometry = summary.mapped->odometry[i];
  out << drive << ": its odometry is " << io::fixed(-100 * odometry.x(), 2) << " % long, and turns "
      << io::fixed(-odometry.y() * 180 / M_PI, 4) << " deg/m\n";
}

/// How the poses were found without truth.
void tellPoses(std::ostream& out, const MapBuildSummary& summary, const MapBuildJob& job) {
  const MappedDrives& mapped = *summary.mapped;
  const FixFit fixes = allFixes(mapped);
  const bool alone = std::all_of(summary.filled.begin(), summary.filled.end(),
                                 [](const FilledMotions& filled) { return filled.all; });
  const bool isDoubted = !warningsOf(summary, job).empty();
  std::size_t guesses = 0;
  for (const FilledMotions& filled : summary.filled) guesses += filled.coasted;
  out << (alone ? "poses by " : "poses by odometry and ") << mapped.tracks
      << " poles followed over " << io::fixed(mapped.driven, 1) << " m; " << mapped.newLoops()
      << " places passed again; the last pose is certain to "
      << io::fixed(sigmaOf(mapped.poses.back()), 2)
      << (fixes.given + mapped.known > 0 ? " m" : " m against the first")
      << (guesses == 1  ? ", if one guessed motion is right"
          : guesses > 0 ? ", if " + std::to_string(guesses) + " guessed motions are right"
          : isDoubted   ? ", apart from what the warnings tell"
                        : "")
      << '\n';
  if (fixes.given > 0)
    out << "placed by " << fixes.fitting
        << " positions from satellites; the first pose is certain to "
        << io::fixed(sigmaOf(mapped.poses.at(mapped.known)), 2) << " m\n";
  for (std::size_t i = 0; i < mapped.odometry.size(); ++i)
    tellDrive(out, summary, i, job.inputs[i].filename().string());
}

}  // namespace

std::string noPolesText(const MapBuildSummary& summary) {
  const auto& map = summary.map;
  return "no pole found: " + std::to_string(summary.scans) + " scans " +
         io::fixed(scanSpacing(summary), 2) +
         " m apart on average; sections of section_length_m = " +
         io::significant(summary.mapping.sectionLength, 6) + ", " +
         std::to_string(map.occupiedSections) + " of " + std::to_string(map.sections) +
         " with a scan; " + std::to_string(map.detections) + " detections in " +
         std::to_string(map.clusters) + " places, the best with " +
         io::significant(map.bestCount, 4) + ", a pole needs " + neededText(summary) +
         (map.detections == 0 ? "; see [sensor] and [extraction]" : "; see [map]") +
         // Poles that are found again and again fall into few places.
         (map.detections > 0 && 2 * map.clusters > map.detections
              ? std::string("; most places hold one detection: ") +
                    (summary.mapped
                         ? "the motions are wrong; write odometry to the rawlog "
                           "(pole-import --odometry), or take scans closer together"
                         : "check that the true poses fit the scans (frame, z up, times)")
              : "");
}

std::map<std::string, std::string> mapFacts(const AllSettings& settings,
                                            const MapBuildSummary& summary, const MapBuildJob& job,
                                            const std::optional<io::Datum>& datum,
                                            const std::map<std::string, std::string>& before) {
  std::map<std::string, std::string> info = driveFacts(summary);
  info["program"] = std::string("pole-map ") + version();
  info["build"] = buildIdentity();
  info["config"] = settingsText(settings);
  if (datum) info[io::kDatumKey] = io::datumText(*datum);
  if (job.add) addFacts(before, info);
  keepWarnings(warningsOf(summary, job), info);
  return info;
}

std::vector<std::string> warningsOf(const MapBuildSummary& summary, const MapBuildJob& job) {
  std::vector<std::string> warnings = summary.doubts;
  const auto doubt = [&](std::size_t drive, const std::string& text) {
    if (!text.empty()) warnings.push_back(job.inputs[drive].filename().string() + ": " + text);
  };
  for (std::size_t i = 0; i < summary.filled.size(); ++i) {
    doubt(i, odometryDoubt(summary.filled[i]));
    doubt(i, coastingDoubt(summary.filled[i]));
  }
  for (std::size_t i = 0; summary.mapped && i < summary.mapped->fixes.size(); ++i)
    doubt(i, fixesDoubt(summary.mapped->fixes[i]));
  for (std::size_t i = 0; i < summary.motions.size(); ++i)
    if (summary.motions[i].contradicts())
      doubt(i, summary.motions[i].verdict() + "; check " + job.poses[i].filename().string() +
                   ", and [sensor] turn by pole-extract --inspect; else build without --truth");
  const std::size_t poles = summary.map.poles.size();
  if (static_cast<double>(summary.twins) > kManyTwins * static_cast<double>(poles))
    warnings.push_back(
        std::to_string(summary.twins) + " of " + std::to_string(poles) +
        " poles have a twin nearer than 1 m (the scans are " + io::fixed(scanSpacing(summary), 2) +
        " m apart); mostly the poses of some scans are wrong" +
        (job.kind == PoseKind::truth
             ? ", check them with pole-eval motion"
             : ", that of the LiDAR on the vehicle (--sensor-pose of pole-import), or the timing "
               "of the scans ([sensor] turn)"));
  return warnings;
}

std::string summaryText(const MapBuildSummary& summary, const MapBuildJob& job) {
  std::ostringstream out;
  out << job.output.string() << ": " << summary.map.poles.size() << " poles from " << summary.scans
      << " scans over " << io::fixed(summary.map.pathLength, 1) << " m\n"
      << "sections: " << summary.map.occupiedSections << " of " << summary.map.sections
      << " with a scan; detections " << summary.map.detections << " in " << summary.map.clusters
      << " places\n"
      << "a pole needs " << neededText(summary) << '\n';
  if (summary.sessions.size() > 1)
    for (const MapBuildSummary::Session& session : summary.sessions)
      out << session.name << ": " << session.used << " of " << session.scans
          << " scans used, f_map " << io::fixed(session.share, 4) << '\n';
  for (std::size_t i = 0; i < summary.motions.size(); ++i)
    if (!summary.motions[i].contradicts())  // else it is a warning
      out << job.inputs[i].filename().string() << ": " << summary.motions[i].verdict() << '\n';
  if (summary.inventory) {
    const AdjustedDrives& drives = summary.inventory->drives;
    out << "inventory: " << drives.anchors.size() << " of its poles are among the " << drives.poles
        << " poles seen, " << io::fixed(drives.anchorDistance, 2)
        << " m from them (rms); the poses "
        << "are certain to " << io::fixed(drives.sigma, 3)
        << " m; poles of it out of sight, kept: " << summary.inventory->kept << '\n';
  }
  if (summary.mapped) tellPoses(out, summary, job);
  out << summary.skipped;
  return out.str();
}

}  // namespace polemcl::apps
