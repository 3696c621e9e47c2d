#pragma once
/// \file PoleTracks.h
/// \brief Poles followed from scan to scan by the odometry. Private to the library.

#include <functional>
#include <vector>

#include "core/localization/LocalSubmap.h"
#include "core/mapping/JointAdjustment.h"

namespace polemcl {

/// \brief A pole as long as a drive keeps it in its submap. A pole that is passed again after that
/// has two tracks.
struct PoleTrack {
  std::size_t first = 0, last = 0;  ///< scans that saw it
  std::uint32_t hits = 0;           ///< scans that saw it, in all
  double radius = 0;                ///< mean of the detections, m
};

struct PoleTracks {
  std::vector<PoleTrack> tracks;
  std::vector<PoleSighting> sightings;  ///< their `pole` is a track
};

/// \brief Called after each scan. The track of a pole of the submap is its `number` + `before`.
using SubmapVisitor =
    std::function<void(std::size_t scan, const LocalSubmap& submap, std::size_t before)>;

/// \param poses Give the motions between scans; the covariances are those of the odometry.
/// \param visit May be empty.
PoleTracks trackPoles(const std::vector<DrivenScan>& scans, const std::vector<Pose2D>& poses,
                      const SubmapVisitor& visit = {});

}  // namespace polemcl
