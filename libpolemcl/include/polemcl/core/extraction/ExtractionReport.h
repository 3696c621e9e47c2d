#pragma once
/// \file ExtractionReport.h
/// \brief What became of the points and the candidates of one scan.

#include <cstddef>

#include <polemcl/export.h>

namespace polemcl {

/// \brief Why a candidate is no pole. Counted per scan, so that a setting can be judged.
enum class RejectionReason {
  tooFewPoints,
  tooWide,        ///< wider than tall, or wider than any pole
  notForeground,  ///< something nearer stands beside it
  tooLow,         ///< its top is below `min_top_m`
  startsTooHigh,  ///< its bottom is above `max_bottom_m`
  tooShort,       ///< its visible height is below `min_height_m`
  badFit,         ///< no circle, or a radius out of range
  notFree,        ///< its surroundings are not free
  tilted,         ///< its axis leans too much
  notStraight,    ///< its segments do not stand above one another
  lowConfidence,
  duplicate,  ///< beside a more confident one
  count_      ///< number of reasons
};
POLEMCL_EXPORT const char* name(RejectionReason reason);

/// \brief Counters of one extraction.
struct ExtractionReport {
  std::size_t points = 0;      ///< in the cloud
  std::size_t invalid = 0;     ///< NaN, infinite, or at the sensor: dropped
  std::size_t outOfView = 0;   ///< match no beam: dropped
  std::size_t outOfRange = 0;  ///< dropped
  std::size_t candidates = 0;
  std::size_t refused[static_cast<int>(RejectionReason::count_)] = {};
  double ground = 0;  ///< median height of the ground below the sensor origin, m (negative)

  /// \brief Adds the counters of another scan; the height of the ground is that of the first.
  POLEMCL_EXPORT ExtractionReport& operator+=(const ExtractionReport& other);
};

}  // namespace polemcl
