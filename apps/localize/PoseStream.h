#pragma once
/// \file PoseStream.h
/// \brief Poses as they are made, for other programs: one line of JSON a scan. Private to the
/// library.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl::apps {

/// \brief Writes and flushes a line for each scan, from any thread. The keys, always all of them:
/// `scan` (from 0), `time` (s), `x_m`, `y_m`, `yaw_rad` (map frame) and `covariance` (xx, xy, xyaw,
/// yy, yyaw, yawyaw; m², m·rad, rad²), which are null while the pose is unknown; `state` and
/// `reason` of the health, `matched_share`, `spread_m`, `poles` (observed), `relocalized`, what is
/// known of the odometry, `odometry_scale` and `odometry_yaw_rad_m`, and `dropped`: scans of
/// sensors that were dropped so far.
///
/// A line that cannot be written is the last one: the results do not depend on who reads the poses.
/// Where nobody reads, the next line waits, and with it the work. Once a stream exists, the program
/// ignores SIGPIPE, also when it ends and the C library flushes.
class PoseStream {
 public:
  /// \param target A file, which is emptied first, a FIFO, whose reader is waited for, or "-":
  /// standard output.
  /// \param goesOn Asked while nobody reads; false ends the wait, and no more lines are written.
  /// \throws Error when the file cannot be created, or nobody reads the FIFO.
  explicit PoseStream(const std::filesystem::path& target, std::function<bool()> goesOn = {});
  ~PoseStream();
  void add(std::size_t scan, const LocalizationUpdate& update, std::size_t dropped);
  /// \brief A line for a time without scans. What only a scan can tell is null in it, also `scan`
  /// and `time`. The pose stays lost if it was; otherwise it is degraded, by `time_gap`.
  void addGap();
  /// \brief Why lines are not written any more; or empty.
  std::string failure() const;

 private:
  void write(const nlohmann::ordered_json& line);
  int opened() const;
  bool waitForReader() const;

  const std::filesystem::path m_target;
  const std::function<bool()> m_goesOn;
  mutable std::mutex m_mutex;              ///< of all below
  int m_descriptor = 1;                    ///< of the target
  std::unique_ptr<std::streambuf> m_file;  ///< of the descriptor; none of standard output
  std::ostream m_out;
  nlohmann::ordered_json m_last;  ///< line of the last scan; before it, of a pose that is not known
  std::string m_failure;
};

}  // namespace polemcl::apps
