#include "map/SessionPoses.h"

#include <cmath>

#include "cli/RunRecords.h"
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double kSameTime = 1e-3;  ///< s: rawlogs and tables round times

/// `run_NN_cov.csv` of `run_NN.tum`.
std::filesystem::path besides(const std::filesystem::path& run, const std::string& ending) {
  return run.parent_path() / (run.stem().string() + ending);
}

}  // namespace

SessionPoses::SessionPoses(PoseKind kind, const std::filesystem::path& file)
    : m_kind(kind), m_file(file) {
  if (kind == PoseKind::truth) {
    m_trajectory = io::readPlanarTum(file);
    return;
  }
  const HealthRecords health(besides(file, "_health.csv"));
  const std::filesystem::path covariances = besides(file, "_cov.csv");
  for (const EstimateRecord& row : readEstimates(covariances)) {
    const bool ok = health.isOk(row.scan);
    if (!m_trajectory.empty() && !(row.time > m_trajectory.back().time))
      throw Error(covariances.string() + ": the times do not increase");
    m_trajectory.push_back({row.time, row.estimate.mean});
    m_estimates[static_cast<std::size_t>(row.scan)] = {
        row.time, {row.estimate.mean, row.estimate.covariance, ok}};
  }
}

SessionPoses::SessionPoses(std::vector<StampedPose2D> odometry)
    : m_kind(PoseKind::odometry), m_trajectory(std::move(odometry)) {}

std::optional<ScanPose> SessionPoses::at(std::size_t scan, double time) const {
  if (m_kind == PoseKind::estimate) return estimateOf(scan, time);
  const auto pose = poseAt(m_trajectory, time, longestTruthGap);
  return pose ? std::optional(ScanPose{*pose}) : std::nullopt;
}

std::optional<ScanPose> SessionPoses::estimateOf(std::size_t scan, double time) const {
  const auto found = m_estimates.find(scan);
  if (found == m_estimates.end()) return std::nullopt;
  const auto& [ownTime, pose] = found->second;
  if (std::abs(ownTime - time) <= kSameTime) return pose;
  throw Error(m_file.string() + ": scan " + std::to_string(scan) + " is of " +
              io::fixed(ownTime, 6) + " s, but that of the rawlog of " + io::fixed(time, 6) +
              " s; is it a run over this rawlog?");
}

Velocity SessionPoses::velocityAt(double time) const {
  // Half a turn of most LiDARs. Estimates vary from scan to scan: over a longer time, that matters
  // less.
  const double half = m_kind == PoseKind::estimate ? 0.25 : 0.05;
  return polemcl::velocityAt(m_trajectory, time, half, longestTruthGap);
}

}  // namespace polemcl::apps
