#pragma once
/// \file MappingSession.h
/// \brief One rawlog at true poses, ready for mapping. Private to the library.

#include <filesystem>
#include <functional>
#include <vector>

#include "cli/Settings.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "core/mapping/MapUpdater.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief The scans of one drive that have a true pose and a point.
struct MappingSession {
  std::vector<SessionScan> scans;
  std::vector<StampedPose2D> path;  ///< of the scans
  std::size_t unmatched = 0;        ///< scans at whose time the truth says nothing
  std::size_t emptyScans = 0;       ///< without a valid point
  std::size_t invalidPoints = 0;    ///< dropped
  bool truncated = false;           ///< the rawlog ended too early, and that was allowed
};

/// \brief Reads a rawlog of scans or poles; doubtful detections down to `[map] min_confidence`.
/// \param progress May be empty.
/// \throws Error as readPoleSequence() and readTum(); when the truth covers less than half of the
///         scans.
MappingSession loadMappingSession(const std::filesystem::path& input,
                                  const std::filesystem::path& truth, const Settings& settings,
                                  bool allowTruncated, const ScanProgress& progress);

/// \brief The scans on another day: their times count from the first one.
/// \param date YYYY-MM-DD. \throws Error when it is none.
void setDate(std::vector<SessionScan>& scans, const std::string& date);

}  // namespace polemcl::apps
