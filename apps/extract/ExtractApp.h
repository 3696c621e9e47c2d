#pragma once
/// \file ExtractApp.h
/// \brief `pole-extract`: a rawlog of scans -> a rawlog of poles, so that scans are read once.

#include <filesystem>
#include <optional>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "cli/Settings.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief Files of `pole-extract`.
struct ExtractOptions {
  std::filesystem::path input;               ///< rawlog of scans
  std::filesystem::path output;              ///< rawlog of poles
  std::optional<std::filesystem::path> csv;  ///< poles as a table, when given
  bool allowTruncated = false;               ///< keep the readable part of a damaged rawlog
  std::optional<std::filesystem::path> png;  ///< picture of one scan with its poles, when given
  std::size_t pngScan = 0;                   ///< the scan drawn, 0-based
  std::optional<std::filesystem::path> rangeImage;  ///< picture of its range image, when given
  /// \throws Error when the output does not end in .rawlog.
  void validate() const;
};

/// \brief What an extraction did, summed over all scans.
struct ExtractSummary {
  SequenceCounts counts;
  /// Points, candidates and refusals; its `ground` is not used.
  ExtractionReport extraction;
};

/// \brief Extracts the poles of every scan.
///
/// The output holds pairs: an action with the motion since the scan before (empty when the input
/// has no odometry), and a frame with one CObservationPoles. Scans without a valid point stay in it
/// without poles, so that scan i is scan i of the input.
/// Every CObservationGPS of the input that has a time is copied, as a single one before the first
/// scan later than it.
/// The CSV has the columns `scan,timestamp,x,y,radius,bottom,top,confidence,points,cxx,cxy,cyy`:
/// 0-based index of the scan in the input, s, then per pole its centre in the robot frame and its
/// radius (m), lowest and highest return above local ground (m), confidence in [0, 1], returns that
/// support it, covariance of the centre in the robot frame (m²).
/// Both files appear once both are complete.
/// \param progress May be empty.
/// \throws Error as streamPoles(), when no scan has a valid point, and when the scan to be drawn is
///         not there, has no points or is one of poles.
ExtractSummary extractPoles(const ExtractOptions& options, const AllSettings& settings,
                            const ScanProgress& progress = {});

/// \brief The program. \return An ExitCode.
int extractMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
