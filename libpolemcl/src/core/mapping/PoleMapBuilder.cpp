#include <algorithm>
#include <cmath>

#include <polemcl/core/common/PathSections.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/mapping/BoxMerging.h"
#include "core/mapping/DetectionToMap.h"
#include "core/mapping/LandmarkFusion.h"
#include "core/mapping/ObservationClustering.h"

namespace polemcl {
namespace {

/// A scan that is used, and the occupied section it counts for.
struct Keyframe {
  std::size_t scan;
  std::uint32_t section;  ///< number among the occupied ones
};

std::vector<Keyframe> chooseKeyframes(const PathSections& sections, bool everyScan) {
  std::vector<Keyframe> keyframes;
  for (std::uint32_t number = 0; number < sections.occupied.size(); ++number) {
    const PathSection& section = sections.occupied[number];
    if (!everyScan) keyframes.push_back({section.middle, number});
    for (const std::size_t scan : section.scans) {
      if (everyScan) keyframes.push_back({scan, number});
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

/// The counting model: most sections that saw the pole in one run of sections, in which at most
/// `maxGap` occupied ones in a row missed it.
std::size_t longestRun(std::vector<std::uint32_t> seen, const std::vector<PathSection>& occupied,
                       int maxGap) {
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  std::size_t longest = 0, run = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool continues = i > 0 && occupied[seen[i]].path == occupied[seen[i - 1]].path &&
                           seen[i] - seen[i - 1] - 1 <= static_cast<std::uint32_t>(maxGap);
    run = continues ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

/// Whether enough of the sections that pass a place nearby saw what stands there.
bool seenFromEnough(const MapPole& pole, const std::vector<std::uint32_t>& seen,
                    const std::vector<PathSection>& occupied, const std::vector<MappingScan>& scans,
                    const PoleMapOptions& options) {
  if (options.minShare == 0) return true;
  std::size_t chances = 0, hits = 0;
  for (std::uint32_t i = 0; i < occupied.size(); ++i) {
    const Pose2D& pose = scans[occupied[i].middle].pose_map_robot;
    if (std::hypot(pose.x - pole.x, pose.y - pole.y) > options.nearRange) continue;
    ++chances;
    hits += std::find(seen.begin(), seen.end(), i) != seen.end();
  }
  return static_cast<double>(hits) >= options.minShare * static_cast<double>(chances);
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
  const std::vector<Keyframe> keyframes = chooseKeyframes(sections, options.everyScan);
  const std::vector<LandmarkObservation> observations = observationsOf(scans, keyframes, options);
  const bool boxes = options.merging == MapMerging::boxes;
  const auto groups =
      boxes ? joinOverlappingBoxes(observations)
            : clusterObservations(observations, {options.mergeDistance, options.apartShare});

  PoleMapResult result;
  for (const std::vector<std::uint32_t>& group : groups) {
    std::vector<std::uint32_t> seen;
    seen.reserve(group.size());
    for (const std::uint32_t member : group)
      seen.push_back(keyframes[observations[member].scan].section);
    const std::size_t count = options.counting == PoleCounting::members
                                  ? group.size()
                                  : longestRun(seen, sections.occupied, options.maxGap);
    result.bestCount = std::max(result.bestCount, count);
    if (count < static_cast<std::size_t>(options.minCount)) continue;
    const MapPole pole = boxes ? plainMean(observations, group) : fuse(observations, group);
    if (seenFromEnough(pole, seen, sections.occupied, scans, options)) result.poles.push_back(pole);
  }
  std::stable_sort(
      result.poles.begin(), result.poles.end(),
      [](const MapPole& a, const MapPole& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
  result.pathLength = sections.length;
  result.sections = sections.count;
  result.occupiedSections = sections.occupied.size();
  result.views = keyframes.size();
  result.detections = observations.size();
  result.clusters = groups.size();
  return result;
}

}  // namespace polemcl
