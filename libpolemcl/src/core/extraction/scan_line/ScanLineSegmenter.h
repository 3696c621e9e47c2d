#pragma once
/// \file ScanLineSegmenter.h
/// \brief Step B1, scan-line method: narrow things that stand before what lies behind
/// them, on one scan line.

#include <cstdint>
#include <vector>

#include <polemcl/core/extraction/ExtractionOptions.h>
#include "core/extraction/scan_line/ScanLines.h"

namespace polemcl {

/// \brief What lies next to an end of a run of returns, on the same beam.
enum class Side : std::uint8_t {
  free,      ///< nothing, or something farther: the thing ends here
  attached,  ///< something about as far: the thing may go on
  occluded   ///< something nearer: the thing may go on behind it
};

/// \brief A run of neighbouring returns on one beam. Indices are within the row and may wrap:
/// the run is first, first + 1, … (modulo the size of the row), `count` returns.
struct ScanLineSegment {
  std::int32_t row = 0;
  std::uint32_t first = 0, count = 0;
  float azimuthBegin = 0,
        azimuthEnd = 0;     ///< of its end returns, rad; End may exceed pi where it wraps
  float rho = 0;            ///< nearest horizontal range, m
  float z = 0;              ///< mean height, lidar frame, m
  float x = 0, y = 0;       ///< middle of its front: mid azimuth at `rho`, m
  Side left = Side::free;   ///< at azimuthEnd (left as seen from the sensor)
  Side right = Side::free;  ///< at azimuthBegin
  float width() const { return rho * (azimuthEnd - azimuthBegin); }  ///< between its end returns, m
  bool whole() const { return left == Side::free && right == Side::free; }
};

/// \brief What bounds a segment.
struct SegmentLimits {
  float gap;       ///< rad: neighbours farther apart have missing returns between them
  float step;      ///< m: greatest step in range inside a run
  float edge;      ///< m: least step to what lies behind
  float maxWidth;  ///< m
  float maxRange;  ///< m
};

/// \brief Neighbouring returns of a row, as in ScanLineSegment; `last` is the size of the row or
/// more where they wrap.
struct SegmentRun {
  std::uint32_t first, last;
  Side left, right;
};

/// \brief Finds segments; keeps its buffer between scans.
class ScanLineSegmenter {
 public:
  ScanLineSegmenter(const SensorModel& sensor, const ScanLineOptions& options);
  /// \brief All segments no wider than maxWidth with at least one free side and none attached, rows
  /// ascending, in a row by azimuth of their beginning.
  void find(const ScanLines& lines, std::vector<ScanLineSegment>& segments);

 private:
  void findRuns(const ScanLines& lines, int row);

  SegmentLimits m_limits;
  std::uint32_t m_free = 0;  ///< bit left + 4 * right: one of these sides is free, none attached
  std::vector<float> m_azimuth, m_rho;
  std::vector<std::int32_t> m_sides;
  std::vector<std::uint32_t> m_breaks;
  std::vector<SegmentRun> m_runs;  ///< of one row: those that may be segments
};

}  // namespace polemcl
