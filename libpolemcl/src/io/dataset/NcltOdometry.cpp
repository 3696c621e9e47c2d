#include "io/dataset/NcltOdometry.h"

#include <cmath>
#include <optional>
#include <utility>

#include "core/common/PoseInterpolation.h"
#include "io/data/Trajectory.h"
#include "io/dataset/ScanPoses.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

constexpr double kRelativeNoise = 0.05;  ///< where the file states none, see assumedCovariance()

/// Covariance of x, y and heading, from the 21 numbers of an upper triangle at `values`.
Eigen::Matrix3d planarCovariance(const double* values) {
  const double xx = values[0], xy = values[1], xh = values[5], yy = values[6], yh = values[10],
               hh = values[20];
  Eigen::Matrix3d covariance;
  covariance << xx, xy, xh, xy, yy, yh, xh, yh, hh;
  return covariance;
}

/// Transforms small motions from the plane of the body to the plane of the robot.
Eigen::Matrix3d planeChange(const Eigen::Isometry3d& T_robot_body) {
  Eigen::Matrix3d change = Eigen::Matrix3d::Zero();
  change.topLeftCorner<2, 2>() = T_robot_body.linear().topLeftCorner<2, 2>();
  change(2, 2) = T_robot_body.linear()(2, 2);
  return change;
}

/// The covariances of the steps, searched by time.
class CovarianceRows {
 public:
  explicit CovarianceRows(const fs::path& file)
      : m_rows(file, 22, kNcltCovarianceLayout, Separator::commas) {
    advance();
  }

  /// The covariance of the row nearest to `time`; nullopt if it is more than `reach` s away. Calls
  /// must have increasing times.
  std::optional<Eigen::Matrix3d> at(double time, double reach) {
    while (m_next && m_next->time <= time) advance();
    const Row* nearest = m_before ? &*m_before : nullptr;
    if (m_next && (!nearest || m_next->time - time < time - nearest->time)) nearest = &*m_next;
    if (!nearest || std::abs(nearest->time - time) > reach) {
      ++m_missing;
      return std::nullopt;
    }
    if (std::abs(nearest->time - time) > sampleTolerance) ++m_shifted;
    return nearest->covariance;
  }

  void noteMismatch(std::size_t steps, std::vector<std::string>& notes) const {
    if (m_missing + m_shifted == 0) return;
    notes.push_back("the rows of odometry_cov.csv and odometry_mu.csv do not match: of " +
                    std::to_string(steps) + " motions " + std::to_string(m_shifted) +
                    " take the covariance of the nearest time, " + std::to_string(m_missing) +
                    " have none (there it is that of the motions beside them, or of 5 % of each "
                    "motion)");
  }

 private:
  struct Row {
    double time = 0;  ///< s
    Eigen::Matrix3d covariance;
  };

  /// Moves to the next row that is finite and later.
  void advance() {
    m_before = m_next;
    m_next.reset();
    std::vector<double> row;
    while (!m_next && m_rows.next(row)) {
      const double time = row[0] * 1e-6;
      if (allFinite(row) && (!m_before || time > m_before->time))
        m_next = Row{time, planarCovariance(row.data() + 1)};
    }
  }

  NumberRowReader m_rows;
  std::optional<Row> m_before, m_next;
  std::size_t m_shifted = 0, m_missing = 0;  ///< steps with another time's covariance; with none
};

}  // namespace

Eigen::Isometry3d ncltPose(const double* values) {
  return poseFromAngles({values[0], values[1], values[2]}, values[3], values[4], values[5]);
}

NcltOdometry::NcltOdometry(const NcltOdometryFiles& files, std::vector<double> times,
                           std::vector<std::string>& notes, const ReadProgress& progress)
    : m_track(std::move(times), kTrackGap) {
  if (!files.track.empty()) readTrack(files.track, notes, progress);
  if (!files.steps.empty()) readSteps(files, notes, progress);
  if (files.steps.empty() || files.covariances.empty())
    notes.push_back(
        "no odometry_mu.csv with odometry_cov.csv: standard deviations of the odometry are assumed "
        "to be 5 % of each motion");
}

void NcltOdometry::readTrack(const fs::path& file, std::vector<std::string>& notes,
                             const ReadProgress& progress) {
  NumberRowReader rows(file, 7, kNcltPoseLayout, Separator::commas, progress);
  std::vector<double> row;
  std::size_t unused = 0;
  while (rows.next(row)) {
    if (!allFinite(row) || !m_track.add(row[0] * 1e-6, ncltPose(row.data() + 1))) ++unused;
  }
  noteUnusedRows(unused, file, notes);
}

void NcltOdometry::readSteps(const NcltOdometryFiles& files, std::vector<std::string>& notes,
                             const ReadProgress& progress) {
  NumberRowReader rows(files.steps, 7, kNcltPoseLayout, Separator::commas, progress);
  std::optional<CovarianceRows> covariances;
  if (!files.covariances.empty()) covariances.emplace(files.covariances);
  std::vector<double> row;
  std::size_t unused = 0, steps = 0;
  std::optional<double> last;
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  while (rows.next(row)) {
    const double time = row[0] * 1e-6;
    if (!allFinite(row) || (last && time <= *last)) {
      ++unused;
      continue;
    }
    const Eigen::Isometry3d step = ncltPose(row.data() + 1);
    // The motion of the first row began before the session.
    if (last) {
      ++steps;
      T_odom_body = T_odom_body * step;
      const auto covariance =
          covariances ? covariances->at(time, (time - *last) / 2) : std::nullopt;
      if (covariance) m_steps.add(*last, time, {planar(step), *covariance});
    }
    if (files.track.empty()) m_track.add(time, T_odom_body);
    last = time;
  }
  noteUnusedRows(unused, files.steps, notes);
  if (covariances) covariances->noteMismatch(steps, notes);
}

PoseWithCovariance NcltOdometry::motion(const Eigen::Isometry3d& T_begin_end, double begin,
                                        double end, const Eigen::Isometry3d& T_robot_body) const {
  PoseWithCovariance motion;
  motion.mean = planar(T_robot_body * T_begin_end * T_robot_body.inverse());
  if (const auto covariance = m_steps.covarianceBetween(begin, end)) {
    const Eigen::Matrix3d change = planeChange(T_robot_body);
    motion.covariance = change * *covariance * change.transpose();
  } else {
    motion.covariance = assumedCovariance(motion.mean, kRelativeNoise);
  }
  motion.covariance += floorCovariance();
  return motion;
}

}  // namespace polemcl::io
