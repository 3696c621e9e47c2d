#pragma once
/// \file LoopSearch.h
/// \brief Poles followed from scan to scan by the odometry, and places that were passed before:
/// each submap is searched on all poles seen earlier, by its drive or by others. Private to the
/// library.
///
/// The search is that of a robot without a start pose (GlobalLocalizer), among the poles where the
/// drive may be by its own uncertainty. A place counts only if it fits that uncertainty, clearly
/// beats all others that do, and if the submaps before or after find the same: streets that look
/// alike are left open. Poles of drives whose place is not known yet are searched as a whole.

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

/// \brief A place passed twice.
struct Loop {
  PoseTie tie;
  Pose2D place;                      ///< of the second scan, in the frame of the first
  std::vector<std::size_t> tracks;   ///< of the submap
  std::vector<std::size_t> earlier;  ///< tracks that it was searched among
};

/// \brief Scans some metres apart, whose places are known with their covariance.
struct Knots {
  std::vector<std::size_t> scans;
  std::vector<double> driven;  ///< m, at each
  Eigen::MatrixXd covariance;  ///< of all of them, as JointAdjustment::poseCovariance()
};

/// \param spacing m. \return The first scan of each drive, scans so far apart, and the last one.
Knots chooseKnots(const std::vector<DrivenScan>& scans, const std::vector<Pose2D>& poses,
                  double spacing);

/// \brief The loops that several submaps agree on, by frames, then in the order they were driven.
/// \param tracks Of the same poses. \param state With a pole for each track.
/// \param frames In which each scan's pose is; drives in different ones are not connected yet.
std::vector<Loop> findLoops(const std::vector<DrivenScan>& scans, const AdjustedState& state,
                            const PoleTracks& tracks, const Knots& knots,
                            const std::vector<std::size_t>& frames);

/// \brief Squared Mahalanobis distance of a tie from the poses, by the tie's covariance and `more`.
double misfit(const PoseTie& tie, const std::vector<Pose2D>& poses, const Eigen::Matrix3d& more);

}  // namespace polemcl
