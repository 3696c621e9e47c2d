#pragma once
/// \file ScanLines.h
/// \brief What the scan-line method has for a range image: one row per real beam, its returns
/// sorted by azimuth.
///
/// Nothing is rounded to a pixel and no return is lost to another, so a scan turned about z, or
/// delivered in another order, gives the same rows. (Scan lines as units of pole detection:
/// Lehtomäki et al. 2010, "Detection of vertical pole-like objects in a road environment".)

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
  /// \param ground Built from the same points; those it dropped are dropped here, too.
  /// \param clearance Points less than this above the ground are left out, m.
  const Counts& build(const PointsView& points, const GroundGrid& ground, float clearance);

  int rows() const { return m_rows; }
  /// \brief Returns of one row, azimuth ascending; equal azimuths by range, then height, then x, y.
  const Return* begin(int row) const { return m_returns.data() + m_bucketStart[bucket(row, 0)]; }
  const Return* end(int row) const { return begin(row + 1); }
  /// \brief First return of part number `part` of a row split into `parts` equal parts, from -pi
  /// on; `part` may be `parts`: the end of the last. \param parts A power of two, at most kBuckets.
  const Return* begin(int row, int part, int parts) const {
    return m_returns.data() + m_bucketStart[bucket(row, part * (m_buckets / parts))];
  }
  std::size_t size(int row) const { return static_cast<std::size_t>(end(row) - begin(row)); }
  /// Buckets of azimuth in a row, for clouds of usual size; large clouds get more.
  static constexpr int kBuckets = 512;
  /// \brief Coordinates of a return in the cloud last built from, lidar frame, m.
  float x(const Return& r) const { return m_points.x[r.point]; }
  float y(const Return& r) const { return m_points.y[r.point]; }
  /// \brief Index within the row of the first return whose azimuth is not less than `azimuth`.
  std::size_t lowerBound(int row, float azimuth) const;

 private:
  std::size_t bucket(int row, int column) const {
    return static_cast<std::size_t>(row) * m_buckets + column;
  }
  int bucketColumn(float azimuth) const;
  void chooseBuckets(std::size_t points);
  std::uint32_t sortIntoBuckets(std::size_t count);
  void sortRow(int row);
  void sortBuckets(int row);

  const SensorModel& m_sensor;
  int m_rows;
  int m_buckets = kBuckets;  ///< per row
  Counts m_counts;
  PointsView m_points;
  std::vector<Return> m_unsorted, m_returns;
  std::vector<std::int32_t> m_key;           ///< bucket of each unsorted return
  std::vector<std::uint32_t> m_bucketStart;  ///< of every bucket, and the end of the last
  float m_limit[GroundGrid::kCells + 1];     ///< per cell of the ground
};

}  // namespace polemcl
