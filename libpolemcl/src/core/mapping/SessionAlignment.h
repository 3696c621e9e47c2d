#pragma once
/// \file SessionAlignment.h
/// \brief Corrects the poses of a session so that its poles stand where the map has them. Private
/// to the library.
///
/// The error of the poses is a Gauss-Markov process along the path: a zero mean, the standard
/// deviations MapUpdateOptions::sessionSigma and 0.4 degrees, correlated over 100 m. Each detection
/// of a map pole measures it. A Kalman filter with the smoother of Rauch, Tung and Striebel (1965)
/// estimates the errors of all scans; pairs are formed anew in each of several rounds, and are
/// weighted by Geman and McClure's function, so that poles which have moved do not move the
/// session. The map is the anchor: it does not change here.

#include <vector>

#include "core/mapping/MapUpdater.h"

namespace polemcl {

/// \brief The same scans with corrected poses. Detections, times and covariances stay.
/// \param map Poles on the map count; candidates do not.
/// \param summary If given: what was done.
/// \throws Error as updateMap() on scans.
std::vector<SessionScan> alignedSession(const std::vector<SessionScan>& scans,
                                        const LandmarkMap& map, const PoleMapOptions& mapping,
                                        const MapUpdateOptions& options,
                                        AlignmentSummary* summary = nullptr);

}  // namespace polemcl
