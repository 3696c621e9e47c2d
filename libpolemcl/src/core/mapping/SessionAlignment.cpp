#include "core/mapping/SessionAlignment.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "core/mapping/LandmarkFusion.h"
#include "core/mapping/MapSession.h"

namespace polemcl {
namespace {

/// m: greatest distance of a pair, round by round. Errors of decimetres must fit into the first.
constexpr double kGates[] = {1.5, 1.0, 0.75, 0.5, 0.5, 0.5};
constexpr int kRoundsWide = 3;           ///< rounds in which the gate widens the covariances
constexpr double kHeadingSigma = 0.007;  ///< of the errors of a session's headings, rad
/// Distance over which the errors of a session are correlated: their correlation falls by e, m.
constexpr double kAlikeLength = 100;
constexpr double kPiece = 50;  ///< m of path
/// Least number of map poles seen within a piece. Pieces with fewer follow the pieces beside them.
constexpr std::size_t kMinPoles = 5;
/// Squared Mahalanobis distance at which a pair has a quarter of its weight.
constexpr double kHalfway = 9;

/// A detection and the map pole that it may be.
struct Pair {
  std::uint32_t landmark = 0;
  Eigen::Vector2d arm;          ///< from the robot to the detection, map axes, m
  Eigen::Vector2d error;        ///< from the detection at the given pose to the map pole, m
  Eigen::Matrix2d information;  ///< of the error, robust weight included
};

/// Error of the pose of one scan: x, y, yaw; as the filter and the smoother know it.
struct Estimate {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

class Alignment {
 public:
  Alignment(const std::vector<SessionScan>& scans, const LandmarkMap& map,
            const PoleMapOptions& mapping, const MapUpdateOptions& options)
      : m_scans(scans),
        m_mapping(mapping),
        m_landmarks(presentPoles(map)),
        m_tree(centresOf(m_landmarks)),
        m_corrections(scans.size(), Eigen::Vector3d::Zero()) {
    m_prior = Eigen::Vector3d(std::pow(options.alignSigma, 2), std::pow(options.alignSigma, 2),
                              std::pow(kHeadingSigma, 2))
                  .asDiagonal();
    observe();
  }

  std::vector<SessionScan> run(AlignmentSummary* summary);

 private:
  void observe();
  Pose2D corrected(std::size_t scan) const;
  void pairUp(double gate, double widening);
  Pair makePair(std::size_t scan, std::uint32_t detection, std::uint32_t landmark,
                double widening) const;
  void dropSparse();
  void smooth();
  Estimate measured(const Estimate& predicted, std::size_t scan) const;
  /// Correlation of the errors of a scan and of the one before.
  double correlation(std::size_t scan) const {
    return std::exp((m_along[scan - 1] - m_along[scan]) / kAlikeLength);
  }

  const std::vector<SessionScan>& m_scans;
  const PoleMapOptions& m_mapping;
  std::vector<MapPole> m_landmarks;
  KdTree2D m_tree;
  Eigen::Matrix3d m_prior;
  std::vector<double> m_along;                                 ///< distance travelled, m
  std::vector<std::vector<LandmarkObservation>> m_detections;  ///< map frame, at the given poses
  std::vector<std::vector<Pair>> m_pairs;                      ///< of each scan
  std::vector<Eigen::Vector3d> m_corrections;                  ///< of each scan, added to its pose
};

void Alignment::observe() {
  m_detections.resize(m_scans.size());
  double along = 0;
  for (std::uint32_t i = 0; i < m_scans.size(); ++i) {
    const SessionScan& scan = m_scans[i];
    if (i > 0) {
      const Pose2D &a = m_scans[i - 1].pose_map_robot, &b = scan.pose_map_robot;
      along += std::hypot(b.x - a.x, b.y - a.y);
    }
    m_along.push_back(along);
    const PoseTrust trust{m_mapping.poseSigma, m_mapping.headingSigma, scan.poseCovariance};
    for (const PoleDetection& pole : scan.poles_robot) {
      if (pole.confidence <= 0 || pole.confidence < m_mapping.minConfidence) continue;
      m_detections[i].push_back(landmarkObservation(pole, scan.pose_map_robot, i, trust));
    }
  }
}

Pose2D Alignment::corrected(std::size_t scan) const {
  const Pose2D& pose = m_scans[scan].pose_map_robot;
  const Eigen::Vector3d& by = m_corrections[scan];
  return {pose.x + by.x(), pose.y + by.y(), wrapAngle(pose.yaw + by.z())};
}

/// A pair with its weight: small if the pair does not fit the corrections so far.
Pair Alignment::makePair(std::size_t scan, std::uint32_t detection, std::uint32_t landmark,
                         double widening) const {
  const PoleDetection& seen = m_detections[scan][detection].pole;
  const MapPole& pole = m_landmarks[landmark];
  const Pose2D& pose = m_scans[scan].pose_map_robot;
  Pair pair;
  pair.landmark = landmark;
  pair.arm = centreOf(seen) - Eigen::Vector2d(pose.x, pose.y);
  pair.error = centreOf(pole) - centreOf(seen);
  const Eigen::Matrix2d covariance =
      seen.covariance + pole.covariance + widening * widening * Eigen::Matrix2d::Identity();
  pair.information = covariance.inverse();
  const Eigen::Vector3d& by = m_corrections[scan];
  const Eigen::Vector2d left =
      pair.error - by.head<2>() - by.z() * Eigen::Vector2d(-pair.arm.y(), pair.arm.x());
  const double robust = kHalfway / (kHalfway + left.dot(pair.information * left));
  // Scans near each other show a pole from the same side, with the same error.
  const double step = scan > 0 ? m_along[scan] - m_along[scan - 1] : kDecorrelation;
  const double newShare = std::min(1.0, step / kDecorrelation);
  pair.information *= robust * robust * newShare * seen.confidence;
  return pair;
}

/// Pairs the detections of each scan, at its corrected pose, with map poles, nearest pair first.
void Alignment::pairUp(double gate, double widening) {
  m_pairs.assign(m_scans.size(), {});
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    const Pose2D &given = m_scans[i].pose_map_robot, pose = corrected(i);
    std::vector<AssignedPair> candidates;
    for (std::size_t k = 0; k < m_detections[i].size(); ++k) {
      const PoleDetection& seen = m_detections[i][k].pole;
      const Pose2D place = compose(pose, relative(given, {seen.x, seen.y, 0}));
      m_tree.within(place.x, place.y, gate, hits);
      for (const PointHit& hit : hits) candidates.push_back({k, hit.index, hit.squaredDistance});
    }
    for (const AssignedPair& pair : chooseClosest(std::move(candidates)))
      m_pairs[i].push_back(makePair(i, static_cast<std::uint32_t>(pair.first),
                                    static_cast<std::uint32_t>(pair.second), widening));
  }
}

/// Drops the pairs of scans in whose piece of the path too few poles of the map were seen.
void Alignment::dropSparse() {
  std::vector<bool> sparse(m_scans.size());
  std::map<std::uint32_t, int> inPiece;  // how many scans of the piece show each landmark
  std::size_t begin = 0, end = 0;
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    for (; end < m_scans.size() && m_along[end] <= m_along[i] + kPiece / 2; ++end)
      for (const Pair& pair : m_pairs[end]) ++inPiece[pair.landmark];
    for (; m_along[begin] < m_along[i] - kPiece / 2; ++begin)
      for (const Pair& pair : m_pairs[begin])
        if (--inPiece[pair.landmark] == 0) inPiece.erase(pair.landmark);
    sparse[i] = inPiece.size() < kMinPoles;
  }
  for (std::size_t i = 0; i < m_scans.size(); ++i)
    if (sparse[i]) m_pairs[i].clear();
}

/// Update of the Kalman filter, in information form, by all pairs of a scan.
Estimate Alignment::measured(const Estimate& predicted, std::size_t scan) const {
  Eigen::Matrix3d information = predicted.covariance.inverse();
  Eigen::Vector3d vector = information * predicted.mean;
  for (const Pair& pair : m_pairs[scan]) {
    Eigen::Matrix<double, 2, 3> jacobian;
    jacobian << 1, 0, -pair.arm.y(), 0, 1, pair.arm.x();
    information += jacobian.transpose() * pair.information * jacobian;
    vector += jacobian.transpose() * pair.information * pair.error;
  }
  Estimate estimate;
  estimate.covariance = symmetrized<3>(information.inverse());
  estimate.mean = estimate.covariance * vector;
  return estimate;
}

/// Estimates all corrections from the pairs: filter forward, smoother back.
void Alignment::smooth() {
  std::vector<Estimate> predicted(m_scans.size()), filtered(m_scans.size());
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    const double kept = i > 0 ? correlation(i) : 0;
    if (i > 0) predicted[i].mean = kept * filtered[i - 1].mean;
    predicted[i].covariance = (1 - kept * kept) * m_prior;
    if (i > 0) predicted[i].covariance += kept * kept * filtered[i - 1].covariance;
    filtered[i] = measured(predicted[i], i);
  }
  m_corrections.back() = filtered.back().mean;
  for (std::size_t i = m_scans.size() - 1; i-- > 0;) {
    const Eigen::Matrix3d gain =
        correlation(i + 1) * filtered[i].covariance * predicted[i + 1].covariance.inverse();
    m_corrections[i] = filtered[i].mean + gain * (m_corrections[i + 1] - predicted[i + 1].mean);
  }
}

std::vector<SessionScan> Alignment::run(AlignmentSummary* summary) {
  std::vector<SessionScan> scans = m_scans;
  if (scans.empty()) return scans;
  int round = 0;
  for (const double gate : kGates) {
    pairUp(gate, round++ < kRoundsWide ? gate / 3 : 0);
    dropSparse();
    smooth();
  }
  AlignmentSummary done;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i].pose_map_robot = corrected(i);
    if (m_pairs[i].empty()) continue;
    const double shift = m_corrections[i].head<2>().norm();
    ++done.scans;
    done.meanShift += shift;
    done.largestShift = std::max(done.largestShift, shift);
    done.largestTurn = std::max(done.largestTurn, std::abs(m_corrections[i].z()));
  }
  if (done.scans > 0) done.meanShift /= static_cast<double>(done.scans);
  if (summary) *summary = done;
  return scans;
}

}  // namespace

std::vector<SessionScan> alignedSession(const std::vector<SessionScan>& scans,
                                        const LandmarkMap& map, const PoleMapOptions& mapping,
                                        const MapUpdateOptions& options,
                                        AlignmentSummary* summary) {
  for (const SessionScan& scan : scans)
    checkScan(scan.pose_map_robot, scan.poles_robot, nameOf(scan));
  return Alignment(scans, map, mapping, options).run(summary);
}

}  // namespace polemcl
