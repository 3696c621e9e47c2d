#include <algorithm>
#include <cmath>
#include <tuple>

#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/common/Binder.h"
#include "core/common/PathSections.h"
#include "core/mapping/LandmarkFusion.h"
#include "core/mapping/ObservationClustering.h"

namespace polemcl {
namespace {

/// A scan that is used, and the occupied section it counts for.
struct Keyframe {
  std::size_t scan;
  std::uint32_t section;  ///< number among the occupied ones
};

/// Scans of a place that are used at most, and how far it reaches, m. A vehicle that stands has
/// many scans, which say the same.
constexpr std::size_t kMostAtAPlace = 50;
constexpr double kPlace = 0.05;

std::vector<Keyframe> chooseKeyframes(const PathSections& sections,
                                      const std::vector<MappingScan>& scans, bool everyScan) {
  std::vector<Keyframe> keyframes;
  Pose2D place;
  std::size_t here = 0;  // scans used at the place
  for (std::uint32_t number = 0; number < sections.occupied.size(); ++number) {
    const PathSection& section = sections.occupied[number];
    if (!everyScan) keyframes.push_back({section.middle, number});
    for (const std::size_t scan : section.scans) {
      if (!everyScan) break;
      const Pose2D& pose = scans[scan].pose_map_robot;
      if (here == 0 || std::hypot(pose.x - place.x, pose.y - place.y) > kPlace) {
        place = pose;
        here = 0;
      }
      if (++here <= kMostAtAPlace) keyframes.push_back({scan, number});
    }
  }
  return keyframes;
}

std::vector<LandmarkObservation> observationsOf(const std::vector<MappingScan>& scans,
                                                const std::vector<Keyframe>& keyframes,
                                                const PoleMapOptions& options) {
  std::vector<LandmarkObservation> observations;
  const PoseTrust trust{options.poseSigma, options.headingSigma};
  for (std::uint32_t number = 0; number < keyframes.size(); ++number) {
    const MappingScan& scan = scans[keyframes[number].scan];
    for (const PoleDetection& pole : scan.poles_robot) {
      if (pole.confidence <= 0 || pole.confidence < options.minConfidence) continue;
      observations.push_back(landmarkObservation(pole, scan.pose_map_robot, number, trust));
    }
  }
  return observations;
}

/// A section that saw a pole.
struct Sighting {
  std::uint32_t section;  ///< number among the occupied ones
  double confidence;      ///< greatest of the pole's detections there
};

/// The sections that saw the pole, in their order.
std::vector<Sighting> sightingsOf(const std::vector<std::uint32_t>& group,
                                  const std::vector<LandmarkObservation>& observations,
                                  const std::vector<Keyframe>& keyframes) {
  std::vector<Sighting> all;
  all.reserve(group.size());
  for (const std::uint32_t member : group)
    all.push_back(
        {keyframes[observations[member].scan].section, observations[member].pole.confidence});
  std::sort(all.begin(), all.end(), [](const Sighting& a, const Sighting& b) {
    return std::tie(a.section, b.confidence) < std::tie(b.section, a.confidence);
  });
  all.erase(
      std::unique(all.begin(), all.end(),
                  [](const Sighting& a, const Sighting& b) { return a.section == b.section; }),
      all.end());
  return all;
}

/// The counting model: greatest sum of one run of sections that saw the pole, in which at most
/// `maxGap` occupied ones in a row missed it.
double bestRun(const std::vector<Sighting>& sightings, const std::vector<PathSection>& occupied,
               const PoleMapOptions& options) {
  double best = 0, run = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const std::uint32_t here = sightings[i].section;
    const bool continues =
        i > 0 && occupied[here].path == occupied[sightings[i - 1].section].path &&
        here - sightings[i - 1].section - 1 <= static_cast<std::uint32_t>(options.maxGap);
    const double value =
        options.counting == PoleCounting::confidences ? sightings[i].confidence : 1.0;
    run = continues ? run + value : value;
    best = std::max(best, run);
  }
  return best;
}

/// Whether enough of the sections that pass a place nearby saw what stands there. Within half of
/// that distance, a section nearer than all that saw it does not count: the top may be above its
/// beams.
bool seenFromEnough(const MapPole& pole, const std::vector<Sighting>& sightings,
                    const std::vector<PathSection>& occupied, const std::vector<MappingScan>& scans,
                    const PoleMapOptions& options) {
  if (options.minShare == 0) return true;
  const auto distance = [&](std::uint32_t section) {
    const Pose2D& pose = scans[occupied[section].middle].pose_map_robot;
    return std::hypot(pose.x - pole.x, pose.y - pole.y);
  };
  const bool confidences = options.counting == PoleCounting::confidences;
  double nearest = confidences ? options.nearRange / 2 : 0, hits = 0, chances = 0;
  for (const Sighting& sighting : sightings) {
    const double range = distance(sighting.section);
    nearest = std::min(nearest, range);
    if (range <= options.nearRange) hits += confidences ? sighting.confidence : 1.0;
  }
  for (std::uint32_t i = 0; i < occupied.size(); ++i)
    chances += distance(i) >= nearest && distance(i) <= options.nearRange;
  return hits >= options.minShare * chances;
}

/// The least count. Scans farther apart than sections see a pole from fewer places: a sum of
/// confidences must then be reached in proportion, but never in one scan.
double neededCount(const PathSections& sections, const PoleMapOptions& options) {
  constexpr double overOne = 1.5;
  if (options.counting != PoleCounting::confidences || sections.count == 0) return options.minCount;
  const double occupied =
      static_cast<double>(sections.occupied.size()) / static_cast<double>(sections.count);
  return std::min(options.minCount, std::max(overOne, occupied * options.minCount));
}

}  // namespace

PoleMapResult buildPoleMap(const std::vector<MappingScan>& scans, const PoleMapOptions& options) {
  checkOptions(options);
  std::vector<Pose2D> poses;
  std::vector<std::uint32_t> drives;
  std::vector<bool> used;
  for (const MappingScan& scan : scans) {
    checkScan(scan.pose_map_robot, scan.poles_robot, "scan " + std::to_string(poses.size()));
    poses.push_back(scan.pose_map_robot);
    drives.push_back(scan.drive);
    used.push_back(scan.used);
  }
  const auto split = options.middle == SectionMiddle::passed ? passSections : splitPath;
  const PathSections sections = split(poses, drives, options.sectionLength, used);
  const std::vector<Keyframe> keyframes = chooseKeyframes(sections, scans, options.everyScan);
  const std::vector<LandmarkObservation> observations = observationsOf(scans, keyframes, options);
  const bool boxes = options.merging == MapMerging::boxes;
  const auto groups =
      boxes ? joinOverlappingBoxes(observations)
            : clusterObservations(observations, {options.mergeDistance, options.apartShare});

  PoleMapResult result;
  result.neededCount = neededCount(sections, options);
  for (const std::vector<std::uint32_t>& group : groups) {
    const std::vector<Sighting> sightings = sightingsOf(group, observations, keyframes);
    const double count = options.counting == PoleCounting::members
                             ? static_cast<double>(group.size())
                             : bestRun(sightings, sections.occupied, options);
    result.bestCount = std::max(result.bestCount, count);
    if (count < result.neededCount) continue;
    const MapPole pole = boxes ? plainMean(observations, group) : fuse(observations, group);
    if (seenFromEnough(pole, sightings, sections.occupied, scans, options))
      result.poles.push_back(pole);
  }
  std::stable_sort(
      result.poles.begin(), result.poles.end(),
      [](const MapPole& a, const MapPole& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
  result.pathLength = sections.length;
  result.sections = sections.count;
  result.occupiedSections = sections.occupied.size();
  result.keyframes = keyframes.size();
  result.detections = observations.size();
  result.clusters = groups.size();
  return result;
}

}  // namespace polemcl
