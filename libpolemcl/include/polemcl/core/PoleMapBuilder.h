#pragma once
/// \file PoleMapBuilder.h
/// \brief Step C of the paper: detections at known poses -> poles, with counts.

#include <polemcl/core/Types.h>

#include <vector>

namespace polemcl {

/// \brief `[map]` in INI files.
struct PoleMapOptions {
  double sectionLength = 1.5;  ///< length of a section of the path, m (paper: 0.25 NCLT, 1.5 KITTI, MulRan)
  bool everyScan = false;      ///< true: all scans of a section count as one view each; false: its middle scan (paper)
  double mergeDistance = 0.5;  ///< detections of one pole lie within this of its mean, m
  int minCount = 3;            ///< keep poles seen in at least so many occupied sections
  int maxGap = 2;              ///< largest gap, in *occupied* sections, inside a continuous run
  double minConfidence = 0;    ///< detections below are not used
  void validate() const;       ///< \throws Error
};

/// \brief One scan's poles at a known pose.
struct MappingScan {
  Pose2D pose_map_robot;
  std::vector<PoleDetection> poles_robot;
};

struct PoleMapResult {
  std::vector<MapPole> poles;        ///< map frame, sorted by x then y
  std::size_t sections = 0;          ///< along the path
  std::size_t occupiedSections = 0;  ///< with at least one scan: only these count and break runs
  std::size_t detections = 0;        ///< used
  std::size_t clusters = 0;          ///< before counting
};

/// \brief Builds the map. \throws Error on options out of range. Empty input gives an empty map.
PoleMapResult buildPoleMap(const std::vector<MappingScan>& scans, const PoleMapOptions& options);

}  // namespace polemcl
