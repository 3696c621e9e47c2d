#include "core/slam/DriveFixes.h"

#include <algorithm>
#include <cmath>

#include "core/common/Statistics.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kLasting = 2;         ///< σ of the lasting error, in stated sigmas
constexpr double kLastingTime = 200;   ///< s, over which its correlation falls by e
constexpr double kNewError = 10;       ///< s, after which it is another unknown
constexpr double kAntennaSigma = 0.5;  ///< m, along each axis
constexpr std::size_t kFewest = 5;     ///< fixes that lay a drive on the plane
constexpr double kSpread = 10;         ///< m: least rms distance of these from their mean
constexpr double kFarOff = 2.5;        ///< distances from the motion, in median ones
constexpr int kFits = 10;
constexpr double kManyWrong = 0.3;  ///< share of fixes

Eigen::Matrix2Xd columns(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Matrix2Xd matrix(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  return matrix;
}

double spreadOf(const Eigen::Matrix2Xd& points) {
  return std::sqrt((points.colwise() - points.rowwise().mean()).colwise().squaredNorm().mean());
}

/// The rigid motion with the least squares (Umeyama 1991, in the plane).
Pose2D bestMotion(const std::vector<Eigen::Vector2d>& from,
                  const std::vector<Eigen::Vector2d>& to) {
  const Eigen::Matrix2Xd a = columns(from), b = columns(to);
  const Eigen::Vector2d meanA = a.rowwise().mean(), meanB = b.rowwise().mean();
  const Eigen::Matrix2d cross = (b.colwise() - meanB) * (a.colwise() - meanA).transpose();
  const double yaw = std::atan2(cross(1, 0) - cross(0, 1), cross.trace());
  const Eigen::Vector2d shift = meanB - rotationOf(yaw) * meanA;
  return {shift.x(), shift.y(), yaw};
}

/// Where the antenna is between a scan and the next one.
Eigen::Vector2d placeAt(std::size_t scan, double share, const Eigen::Vector2d& antenna_robot,
                        const std::vector<Pose2D>& poses) {
  const Pose2D &a = poses[scan], &b = poses[scan + 1];
  return centreOf(a) + share * (centreOf(b) - centreOf(a)) + rotationOf(a.yaw) * antenna_robot;
}

/// Indices of the distances that are not far above the median.
std::vector<std::size_t> fitting(const std::vector<double>& distances) {
  std::vector<double> sorted = distances;
  const double middle = elementOfRank(sorted, sorted.size() / 2);
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (distances[i] <= kFarOff * middle) near.push_back(i);
  return near;
}

}  // namespace

FixFactors fixFactors(const std::vector<DriveFix>& fixes, const std::vector<std::size_t>& drives) {
  FixFactors factors;
  if (fixes.empty()) return factors;
  factors.antennas.assign(drives.back() + 1, {Eigen::Vector2d::Zero(), kAntennaSigma});
  std::optional<std::size_t> drive;
  double since = 0;
  for (const DriveFix& fix : fixes) {
    const bool begins = drive != drives[fix.scan];
    drive = drives[fix.scan];
    if (begins || fix.time - since >= kNewError) {
      const double correlation = begins ? 0 : std::exp((since - fix.time) / kLastingTime);
      factors.errors.push_back({kLasting * fix.sigma, correlation});
      since = fix.time;
    }
    factors.antennas[*drive].stated = fix.antenna_robot;
    factors.fixes.push_back(
        {fix.scan, fix.share, fix.position, fix.sigma, factors.errors.size() - 1});
  }
  return factors;
}

std::vector<FixFit> fixFits(const FixFactors& gnss, const AdjustedState& state,
                            const std::vector<std::size_t>& drives) {
  std::vector<std::vector<double>> distances(drives.back() + 1);
  std::vector<FixFit> fits(distances.size());
  for (const PositionFix& fix : gnss.fixes) {
    const std::size_t drive = drives[fix.scan];
    const Eigen::Vector2d off =
        fix.position - placeAt(fix.scan, fix.share, state.antennas[drive], state.poses);
    const double squared = (off - state.fixErrors[fix.error]).squaredNorm();
    fits[drive].fitting += squared <= kQuarterWeight * fix.sigma * fix.sigma ? 1 : 0;
    distances[drive].push_back(off.norm());
  }
  for (std::size_t i = 0; i < fits.size(); ++i) {
    fits[i].given = distances[i].size();
    if (fits[i].given > 0) fits[i].distance = elementOfRank(distances[i], fits[i].given / 2);
  }
  return fits;
}

bool FixFit::isDoubtful() const {
  return static_cast<double>(given - fitting) > kManyWrong * static_cast<double>(given);
}

FixFactors widened(const FixFactors& gnss, const std::vector<FixFit>& fits,
                   const std::vector<std::size_t>& drives) {
  FixFactors wide = gnss;
  for (PositionFix& fix : wide.fixes) {
    const FixFit& fit = fits[drives[fix.scan]];
    if (!fit.isDoubtful() || fit.distance <= fix.sigma) continue;
    LastingError& lasting = wide.errors[fix.error];
    lasting.sigma = std::max(lasting.sigma, kLasting * fit.distance);
    fix.sigma = fit.distance;
  }
  return wide;
}

std::optional<Pose2D> motionOntoFixes(const std::vector<DriveFix>& fixes,
                                      const std::vector<Pose2D>& poses) {
  std::vector<Eigen::Vector2d> driven, told;
  for (const DriveFix& fix : fixes) {
    driven.push_back(placeAt(fix.scan, fix.share, fix.antenna_robot, poses));
    told.push_back(fix.position);
  }
  if (driven.size() < kFewest || spreadOf(columns(driven)) < kSpread) return std::nullopt;
  Pose2D motion = bestMotion(driven, told);
  for (int round = 0; round < kFits; ++round) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < driven.size(); ++i) {
      const Pose2D moved = compose(motion, {driven[i].x(), driven[i].y(), 0});
      distances.push_back((centreOf(moved) - told[i]).norm());
    }
    std::vector<Eigen::Vector2d> from, to;
    for (const std::size_t i : fitting(distances)) {
      from.push_back(driven[i]);
      to.push_back(told[i]);
    }
    motion = bestMotion(from, to);
  }
  return motion;
}

}  // namespace polemcl
