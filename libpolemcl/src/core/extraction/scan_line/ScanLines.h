#pragma once
/// \file ScanLines.h
/// \brief What the scan-line method has for a range image: one row per real beam, its returns
/// sorted by azimuth.
///
/// Nothing is rounded to a pixel and no return is lost to another, so a scan turned about z, or
/// delivered in another order, gives the same rows. (Scan lines as units of pole detection:
/// Lehtomäki et al. 2010, "Detection of vertical pole-like objects in a road environment".)

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/extraction/scan_line/GroundGrid.h"
#include "core/sensor/SensorModel.h"

namespace polemcl {

/// \brief One return, lidar frame.
struct Return {
  float azimuth;        ///< atan2(y, x), rad
  float rho;            ///< horizontal range hypot(x, y), m
  float z;              ///< m
  std::uint32_t point;  ///< index in the cloud
};

class ScanLines {
 public:
  struct Counts {
    std::size_t used = 0;      ///< in rows
    std::size_t onGround = 0;  ///< less than the clearance above the ground, or below it
    std::size_t outOfView = 0;
  };

  explicit ScanLines(const SensorModel& sensor);

  /// \brief Sorts the points of one turn into rows. Keeps its buffers between calls.
  ///
  /// Most points of a street lie on the ground; poles stand on it, so they are left out first.
  /// Where many firings have two returns, the nearer ones stay: those behind would cut poles in
  /// two. \param ground Built from the same points; those it dropped are dropped here, too. \param
  /// clearance Points less than this above the ground are left out, m.
  const Counts& build(const PointsView& points, const GroundGrid& ground, float clearance);

  int rows() const { return m_rows; }
  /// \brief Returns of one row, azimuth ascending; equal azimuths by range, then height, then x, y.
  const Return* begin(int row) const { return m_returns.data() + m_begin[row]; }
  const Return* end(int row) const { return m_returns.data() + m_end[row]; }
  std::size_t size(int row) const { return m_end[row] - m_begin[row]; }
  /// \brief The one of `parts` equal parts of a turn, from -pi on, that an azimuth falls into.
  static int part(float azimuth, int parts) {
    const float perRadian = static_cast<float>(parts) / (2 * kPi);
    return std::clamp(static_cast<int>((azimuth + kPi) * perRadian), 0, parts - 1);
  }
  /// \brief Coordinates of a return in the cloud last built from, lidar frame, m.
  float x(const Return& r) const { return m_points.x[r.point]; }
  float y(const Return& r) const { return m_points.y[r.point]; }
  /// \brief Index within the row of the first return whose azimuth is not less than `azimuth`.
  std::size_t lowerBound(int row, float azimuth) const;
  static constexpr float kPi = 3.14159265358979f;
  /// Parts of a turn in the index of lowerBound().
  static constexpr int kParts = 256;

 private:
  void layOut();
  void sortStream(std::size_t first, std::size_t last);
  void sortMixed(Return* returns, std::size_t count);
  void joinHalves(int row);
  void index(int row);
  void keepNearer(int row);

  const SensorModel& m_sensor;
  int m_rows;
  float m_oneFiring;  ///< azimuths of one firing differ by less, rad
  Counts m_counts;
  std::size_t m_looked = 0, m_twins = 0;  ///< returns that index() saw, those beside another one
  PointsView m_points;
  std::vector<Return> m_returns, m_sorted;
  /// Streams of ReturnStreams: first and last place, and where the next return would be.
  std::vector<std::uint32_t> m_streamBegin, m_streamEnd, m_next;
  std::vector<std::uint32_t> m_begin, m_end;  ///< of each row, in m_returns
  std::vector<std::uint32_t> m_partEnd;
  std::vector<std::uint32_t> m_hint;      ///< row * kParts + part: at its first return or before
  float m_limit[GroundGrid::kCells + 1];  ///< per cell of the ground
};

}  // namespace polemcl
