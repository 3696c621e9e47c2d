#pragma once
/// \file PackedCloud.h
/// \brief Clouds as ROS packs them, unpacked without ROS.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/export.h>
#include <polemcl/io/data/Cloud.h>

namespace polemcl::io {

/// \brief A value of each point, as sensor_msgs/msg/PointField states it.
struct PackedField {
  std::string name;
  std::size_t offset = 0;  ///< in its point, bytes
  std::uint8_t type = 7;   ///< 1 to 8, as PointField numbers its types; 7: float32
};

/// \brief The content of a sensor_msgs/msg/PointCloud2; its bytes are borrowed.
struct PackedCloud {
  double stamp = 0;                          ///< time of the header, s
  std::size_t rows = 0, columns = 0;         ///< height and width
  std::size_t pointBytes = 0, rowBytes = 0;  ///< from one point, one row to the next
  bool bigEndian = false;
  std::vector<PackedField> fields;
  std::string_view data;
};

/// \brief A cloud with the times of its points.
struct TimedCloud {
  Cloud cloud;
  /// Time from the stamp to each point of `cloud`, s; empty if not all points have one.
  std::vector<double> offsets;
};

/// \brief Unpacks a cloud.
///
/// Points need the fields x, y and z (float32 or float64); `intensity` may be of any type, and is 0
/// where it is missing. Times are in the first of the fields `t`, `time`, `timestamp`, `time_stamp`
/// and `offset_time` that has one of these types: uint32 in ns, float32 or float64 in s. They count
/// from the stamp. A float64 above 1e8, or above 1 and less than 1 s from the stamp, is a time of
/// the clock of the stamp; above 1e11 it is in ms, us or ns. Other fields are not read. Invalid
/// points are dropped and counted as in readKittiBin().
/// \param withTimes Whether to read the times. \param where Prefix of error messages.
/// \throws Error when the sizes contradict each other, or a coordinate has another type or lies
///         outside its point.
POLEMCL_EXPORT TimedCloud unpack(const PackedCloud& packed, const std::string& where,
                                 bool withTimes);

/// \brief Learns how a LiDAR turns, from the times that the points of its scans have. It takes the
/// first scans of a drive until it is complete, then some of the rest, which tell whether the
/// azimuth moves at which scans begin.
///
/// Keeps a few numbers of the first scans and no points. What was moved from can only be destroyed
/// or assigned to.
class POLEMCL_EXPORT TimingEstimate {
 public:
  TimingEstimate();
  TimingEstimate(TimingEstimate&&) noexcept;
  TimingEstimate& operator=(TimingEstimate&&) noexcept;
  ~TimingEstimate();

  /// \brief Takes a scan into account if it is a full turn: points in three quarters of all
  /// directions.
  void add(const TimedCloud& scan);
  /// \brief Whether the timing needs no more scans: after five full turns with times, at the latest
  /// after 20 scans.
  bool complete() const;
  /// \brief The timing; medians over the first scans. `automatic` when the points do not tell, or
  /// scans begin at different azimuths and their points are not in the order of measuring. Once
  /// complete, a timing that is not known stays so.
  ScanTiming timing() const;
  /// \brief Note for the user: what was found, or why nothing was.
  std::string note() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl::io
