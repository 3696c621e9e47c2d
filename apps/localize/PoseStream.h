#pragma once
/// \file PoseStream.h
/// \brief Poses as they are made, for other programs: one line of JSON a scan. Private to the
/// library.

#include <filesystem>
#include <fstream>
#include <iosfwd>

#include <polemcl/mrpt/filter/LocalizationPipeline.h>

namespace polemcl::apps {

/// \brief Writes and flushes a line for each scan. The keys, always all of them: `scan` (from 0),
/// `time` (s), `x_m`, `y_m`, `yaw_rad` (map frame) and `covariance` (xx, xy, xyaw, yy, yyaw,
/// yawyaw; m², m·rad, rad²), which are null while the pose is unknown; `state` and `reason` of the
/// health, `matched_share`, `spread_m`, `poles` (observed), `relocalized`, what is known of the
/// odometry, `odometry_scale` and `odometry_yaw_rad_m`, and `dropped`: scans of sensors that were
/// dropped so far.
class PoseStream {
 public:
  /// \param target A file, which is emptied first; "-": standard output.
  /// \throws Error when the file cannot be created.
  explicit PoseStream(const std::filesystem::path& target);
  /// \throws Error when it cannot be written.
  void add(std::size_t scan, const LocalizationUpdate& update, std::size_t dropped);

 private:
  std::filesystem::path m_target;
  std::ofstream m_file;
  std::ostream& m_out;
};

}  // namespace polemcl::apps
