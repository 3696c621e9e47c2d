#pragma once
/// \file PoleMapBuilder.h
/// \brief Step C of the paper: detections at known poses -> poles, with counts.
///
/// The path is split into sections of equal length (PathSections); detections of different scans
/// are merged by gated distance (ObservationClustering) and averaged by their certainty
/// (LandmarkFusion); a pole stays if enough sections in a continuous run saw it, each counted by
/// its confidence. The options have the paper's and the authors' program's way of each step as
/// well.

#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

class Binder;

/// \brief Which scan is the keyframe of a section.
enum class SectionMiddle {
  nearest,  ///< the one nearest to the middle of the section
  passed    ///< the first at or past the middle (authors' program, see SectionMarks)
};

/// \brief Which detections are one pole, and what becomes of them.
enum class MapMerging {
  /// By distance to the pole's centre, one a keyframe; mean by certainty, without outliers.
  gated,
  boxes  ///< all whose boxes overlap, chains too; plain mean (authors' program)
};

/// \brief What is counted against PoleMapOptions::minCount.
enum class PoleCounting {
  run,          ///< sections of one continuous run that saw the pole (paper)
  confidences,  ///< the sum of their greatest confidences: how many of them were right
  members       ///< detections of the pole, wherever they were made (authors' program)
};

/// \brief `[map]` in INI files.
struct POLEMCL_EXPORT PoleMapOptions {
  /// Length of a section of the path, m (paper: 0.25 NCLT, 1.5 KITTI and MulRan).
  double sectionLength = 1.5;
  /// true: every scan is a keyframe, of a vehicle that stands (5 cm) the first 50; false: the scan
  /// nearest to the middle of a section is its one keyframe (paper).
  bool everyScan = true;
  SectionMiddle middle = SectionMiddle::nearest;
  MapMerging merging = MapMerging::gated;
  PoleCounting counting = PoleCounting::confidences;
  double mergeDistance =
      0.5;  ///< detections of one pole lie within this of its mean, m; no setting
  /// Poles nearer to each other than mergeDistance stay apart when at least this share of the
  /// keyframes of the one seen more often shows both; otherwise they are one.
  static constexpr double apartShare = 0.25;
  /// Least `counting` of a pole. With `confidences` it is multiplied by the share of sections that
  /// have a scan, but not to below 1.5.
  double minCount = 3;
  int maxGap = 2;  ///< most *occupied* sections in a row that may miss it inside a run; no setting
  double minConfidence = 0;  ///< detections below are not used, in [0, 1]; those of 0 never are
  /// Least share of the occupied sections with middles within `nearRange` that saw the pole, in
  /// [0, 1]; each counts by its confidence if `counting` says so. Clutter looks like a pole from
  /// few places, a pole from nearly all. A pole without such sections needs `minCount` alone.
  double minShare = 0.15;
  double nearRange = 15;  ///< m; no setting
  /// Standard deviation of the scans' positions, m: added to each detection, so that the nearest
  /// one does not count alone.
  double poseSigma = 0.02;
  /// Standard deviation of the scans' headings, rad (`heading_sigma_deg`): far detections count
  /// less across the line of sight.
  double headingSigma = 0.002;
  /// Later sessions use only scans at least this far from every place that earlier sessions
  /// visited, m (`unvisited_m`, paper: 10); 0: all scans. See MapAccumulator.
  double unvisited = 0;
};

POLEMCL_EXPORT void bind(Binder& binder, PoleMapOptions& options);  ///< `[map]`

/// \brief One scan's poles at a known pose.
struct MappingScan {
  Pose2D pose_map_robot;
  std::vector<PoleDetection> poles_robot;
  /// Where it differs from the scan before, another drive begins: the way between the two is no
  /// part of the path, and no run continues across.
  std::uint32_t drive = 0;
  /// false: the way leads here, but nothing is taken from this scan. Its detections are ignored.
  bool used = true;
};

struct PoleMapResult {
  std::vector<MapPole> poles;        ///< map frame, sorted by x then y
  double pathLength = 0;             ///< over all drives, scans not used included, m
  std::size_t sections = 0;          ///< along the path, without those of unused scans only
  std::size_t occupiedSections = 0;  ///< with at least one scan: only these count and break runs
  std::size_t keyframes = 0;         ///< one scan of each occupied section, or all
  std::size_t detections = 0;        ///< used
  std::size_t clusters = 0;          ///< before counting
  double neededCount = 0;            ///< minCount, or less where scans are far apart
  double bestCount = 0;              ///< greatest `counting` of a pole
};

/// \brief Builds the map from scans in the order they were driven. The result does not depend on
/// the order of the detections in a scan. Empty input gives an empty map.
/// \throws Error on options out of range, and on a pose or detection that is not finite, or whose
///         covariance is not symmetric positive semidefinite, naming scan and detection.
POLEMCL_EXPORT PoleMapResult buildPoleMap(const std::vector<MappingScan>& scans,
                                          const PoleMapOptions& options);

}  // namespace polemcl
