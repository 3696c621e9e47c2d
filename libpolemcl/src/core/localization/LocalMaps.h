#pragma once
/// \file LocalMaps.h
/// \brief One scan a section for the filter, as the authors' program localizes.

#include <cstdint>
#include <deque>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include "core/common/Binder.h"
#include "core/common/PathSections.h"

namespace polemcl {

/// \brief What LocalMaps gives out.
struct POLEMCL_EXPORT LocalMapOptions {
  double sectionLength = 1.5;  ///< of odometry, m (authors' program: 0.25 NCLT, else 1.5)
  int maps = 1;  ///< newest sections whose poles are compared (NCLT 6, MulRan 3, KITTI 1)
  /// Least number of these maps' poles whose boxes overlap with a pole's, in a connected component
  /// and with itself (NCLT and MulRan 2, KITTI 1).
  int minHits = 1;
};

POLEMCL_EXPORT void bind(Binder& binder, LocalMapOptions& options);  ///< `[tracking]`

/// \brief The poles of the middle scan of each section (SectionMarks), given out once, when the
/// section ends: carried on to then by odometry, and only those that the newest sections confirm.
class POLEMCL_EXPORT LocalMaps {
 public:
  /// \throws Error on options out of range.
  explicit LocalMaps(const LocalMapOptions& options);

  /// \brief One scan more.
  /// \param motion Since the scan before, in the robot frame before; not used of the first.
  /// \param poles_robot Its detections, robot frame.
  /// \return What the filter gets at this scan, robot frame; empty unless a section ends here.
  std::vector<PoleDetection> add(const Pose2D& motion,
                                 const std::vector<PoleDetection>& poles_robot);
  /// \brief Forgets everything: the next scan is a first one.
  void clear();

 private:
  struct Map {
    Pose2D pose_odometry_robot;
    std::vector<PoleDetection> poles_robot;
  };
  std::vector<PoleDetection> confirmed(std::size_t newest) const;

  LocalMapOptions m_options;
  SectionMarks m_marks;
  std::deque<Map> m_maps;   ///< of sections m_first and after
  std::size_t m_first = 0;  ///< section of the oldest map kept
  Pose2D m_pose;            ///< odometry frame: the robot's at the first scan
  double m_way = 0;         ///< m
  bool m_started = false;
};

}  // namespace polemcl
