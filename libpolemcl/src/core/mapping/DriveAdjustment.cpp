#include "core/mapping/DriveAdjustment.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// m: greatest distance of a detection from its pole, round by round.
constexpr double s_pairGates[] = {0.8, 0.5, 0.5, 0.4};
constexpr int s_steps = 4;               ///< of Gauss and Newton, in each round
constexpr double s_anchorSigmas = 3;     ///< greatest distance from a pole of the map
constexpr double s_nearAnchor = 0.5;     ///< m: but this at least, for the poses err as well
constexpr double s_exactAnchor = 1e-3;   ///< m: added to what the map says of its poles
constexpr double s_halfWeight = 9;       ///< as in SessionAlignment
constexpr double s_motionSigma = 0.003;  ///< m: of each motion, beyond what it states
constexpr double s_turnSigma = 3e-4;     ///< rad: the same
constexpr std::size_t s_fewestAnchors = 3;
constexpr std::size_t s_sampledPoses = 20;  ///< whose standard deviations are looked at

/// A detection of a scan that is a pole.
struct PoleSighting {
  std::size_t scan = 0, detection = 0, pole = 0;
};

double robustWeight(double squared) {
  const double weight = s_halfWeight / (s_halfWeight + squared);
  return weight * weight;
}

/// Normal equations, made of factors over some of the blocks of unknowns.
class NormalEquations {
 public:
  explicit NormalEquations(std::size_t size)
      : m_gradient(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size))) {}

  template <int rows>
  struct Part {
    std::size_t first;  ///< unknown
    Eigen::Matrix<double, rows, Eigen::Dynamic, 0, rows, 3> jacobian;
  };
  template <int rows>
  void add(const std::vector<Part<rows>>& parts, const Eigen::Matrix<double, rows, 1>& residual,
           const Eigen::Matrix<double, rows, rows>& information) {
    for (const Part<rows>& a : parts) {
      m_gradient.segment(static_cast<Eigen::Index>(a.first), a.jacobian.cols()) +=
          a.jacobian.transpose() * information * residual;
      for (const Part<rows>& b : parts) {
        const Eigen::MatrixXd block = a.jacobian.transpose() * information * b.jacobian;
        for (Eigen::Index i = 0; i < block.rows(); ++i)
          for (Eigen::Index k = 0; k < block.cols(); ++k)
            m_entries.emplace_back(static_cast<int>(a.first) + static_cast<int>(i),
                                   static_cast<int>(b.first) + static_cast<int>(k), block(i, k));
      }
    }
  }
  void addPrior(std::size_t unknown, double residual, double sigma) {
    const auto i = static_cast<Eigen::Index>(unknown);
    m_gradient[i] += residual / (sigma * sigma);
    m_entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1 / (sigma * sigma));
  }
  /// The matrix factored; the step is that of Gauss and Newton.
  Eigen::VectorXd solve(Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& factored) const {
    Eigen::SparseMatrix<double> matrix(m_gradient.size(), m_gradient.size());
    matrix.setFromTriplets(m_entries.begin(), m_entries.end());
    factored.compute(matrix);
    Eigen::VectorXd step = factored.solve(-m_gradient);
    if (factored.info() != Eigen::Success || !step.allFinite())
      throw Error("the drives cannot be adjusted to the map: odometry and poles leave them open");
    return step;
  }

 private:
  std::vector<Eigen::Triplet<double>> m_entries;
  Eigen::VectorXd m_gradient;
};

class DriveAdjustment {
 public:
  DriveAdjustment(const std::vector<DrivenScan>& scans, const std::vector<MapPole>& map,
                  const DriveAdjustmentOptions& options)
      : m_scans(scans), m_map(map), m_options(options) {
    for (const DrivenScan& scan : scans) {
      m_poses.push_back(scan.pose_map_robot);
      if (!scan.motion || m_drive.empty()) m_calibrations.push_back(Eigen::Vector2d::Zero());
      m_drive.push_back(m_calibrations.size() - 1);
    }
  }
  AdjustedDrives run();

 private:
  void findPoles();
  void pairUp(double gate);
  void findAnchors();
  void step();
  NormalEquations equations() const;
  void addMotion(std::size_t scan, NormalEquations& equations) const;
  void addSighting(const PoleSighting& sighting, NormalEquations& equations) const;
  void addAnchor(const AssignedPair& anchor, NormalEquations& equations) const;
  double newShare(std::size_t scan) const;
  double sampledSigma() const;
  std::size_t calibrationAt(std::size_t drive) const { return 3 * m_poses.size() + 2 * drive; }
  std::size_t poleAt(std::size_t pole) const {
    return calibrationAt(m_calibrations.size()) + 2 * pole;
  }

  const std::vector<DrivenScan>& m_scans;
  const std::vector<MapPole>& m_map;
  const DriveAdjustmentOptions& m_options;
  std::vector<Pose2D> m_poses;
  std::vector<std::size_t> m_drive;             ///< of each scan
  std::vector<Eigen::Vector2d> m_calibrations;  ///< scale error and yaw bias of each drive
  std::vector<Eigen::Vector2d> m_poles;
  std::vector<PoleSighting> m_sightings;
  std::vector<AssignedPair> m_anchors;  ///< poles seen, and poles of the map
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> m_factored;
};

void DriveAdjustment::findPoles() {
  std::vector<MappingScan> scans;
  for (std::size_t i = 0; i < m_scans.size(); ++i)
    scans.push_back({m_poses[i], m_scans[i].poles_robot, static_cast<std::uint32_t>(m_drive[i])});
  m_poles = centresOf(buildPoleMap(scans, m_options.mapping).poles);
}

void DriveAdjustment::pairUp(double gate) {
  const KdTree2D tree(m_poles);
  m_sightings.clear();
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    std::vector<AssignedPair> candidates;
    for (std::size_t k = 0; k < m_scans[i].poles_robot.size(); ++k) {
      const PoleDetection& seen = m_scans[i].poles_robot[k];
      const Pose2D place = compose(m_poses[i], {seen.x, seen.y, 0});
      tree.within(place.x, place.y, gate, hits);
      for (const PointHit& hit : hits) candidates.push_back({k, hit.index, hit.squaredDistance});
    }
    for (const AssignedPair& pair : chooseClosest(std::move(candidates)))
      m_sightings.push_back({i, pair.first, pair.second});
  }
}

void DriveAdjustment::findAnchors() {
  double variance = 0;
  for (const MapPole& pole : m_map) variance = std::max(variance, pole.covariance.trace() / 2);
  m_anchors = greedyAssignment(m_poles, centresOf(m_map),
                               std::max(s_nearAnchor, s_anchorSigmas * std::sqrt(variance)));
  if (m_anchors.size() < s_fewestAnchors)
    throw Error("only " + std::to_string(m_anchors.size()) + " of " +
                std::to_string(m_poles.size()) + " poles seen stand near one of the map; " +
                std::to_string(s_fewestAnchors) + " are needed: are the poses in its frame?");
}

/// Scans near each other show a pole from the same side, with the same error.
double DriveAdjustment::newShare(std::size_t scan) const {
  if (!m_scans[scan].motion || scan == 0) return 1;
  const Pose2D& motion = m_scans[scan].motion->mean;
  return std::clamp(std::hypot(motion.x, motion.y) / m_options.decorrelation, 1e-3, 1.0);
}

void DriveAdjustment::addMotion(std::size_t scan, NormalEquations& equations) const {
  const PoseWithCovariance& motion = *m_scans[scan].motion;
  const Pose2D &a = m_poses[scan - 1], &b = m_poses[scan], moved = relative(a, b);
  const Eigen::Vector2d& errors = m_calibrations[m_drive[scan]];
  const Pose2D& read = motion.mean;
  const Eigen::Vector3d residual(moved.x - (1 + errors[0]) * read.x,
                                 moved.y - (1 + errors[0]) * read.y,
                                 wrapAngle(moved.yaw - read.yaw - errors[1] * read.x));
  Eigen::Matrix3d byA = Eigen::Matrix3d::Identity(), byB = byA;
  const Eigen::Matrix2d turn = rotationOf(-a.yaw);
  byA.topLeftCorner<2, 2>() = -turn;
  byA.col(2) << moved.y, -moved.x, -1;
  byB.topLeftCorner<2, 2>() = turn;
  Eigen::Matrix<double, 3, 2> byErrors = Eigen::Matrix<double, 3, 2>::Zero();
  byErrors(0, 0) = -read.x;
  byErrors(1, 0) = -read.y;
  byErrors(2, 1) = -read.x;
  Eigen::Matrix3d covariance = motion.covariance;
  covariance.diagonal() += Eigen::Vector3d(s_motionSigma, s_motionSigma, s_turnSigma).cwiseAbs2();
  equations.add<3>({{3 * scan - 3, byA}, {3 * scan, byB}, {calibrationAt(m_drive[scan]), byErrors}},
                   residual, covariance.inverse());
}

void DriveAdjustment::addSighting(const PoleSighting& sighting, NormalEquations& equations) const {
  const PoleDetection& seen = m_scans[sighting.scan].poles_robot[sighting.detection];
  const MovedCentre centre = movedCentre(m_poses[sighting.scan], seen);
  const Eigen::Vector2d residual = centre.centre - m_poles[sighting.pole];
  const double extra = m_options.mapping.poseSigma;
  Eigen::Matrix2d information =
      (centre.covariance + extra * extra * Eigen::Matrix2d::Identity()).inverse();
  information *= robustWeight(residual.dot(information * residual)) * newShare(sighting.scan) *
                 seen.confidence;
  Eigen::Matrix<double, 2, 3> byPose = Eigen::Matrix<double, 2, 3>::Identity();
  byPose.col(2) << -centre.arm.y(), centre.arm.x();
  equations.add<2>(
      {{3 * sighting.scan, byPose}, {poleAt(sighting.pole), -Eigen::Matrix2d::Identity()}},
      residual, information);
}

void DriveAdjustment::addAnchor(const AssignedPair& anchor, NormalEquations& equations) const {
  const MapPole& known = m_map[anchor.second];
  const Eigen::Vector2d residual = m_poles[anchor.first] - centreOf(known);
  Eigen::Matrix2d information =
      (known.covariance + s_exactAnchor * s_exactAnchor * Eigen::Matrix2d::Identity()).inverse();
  information *= robustWeight(residual.dot(information * residual)) * known.confidence;
  equations.add<2>({{poleAt(anchor.first), Eigen::Matrix2d::Identity()}}, residual, information);
}

NormalEquations DriveAdjustment::equations() const {
  constexpr double anywhere = 1e3;  // m, rad: keeps what nothing holds from falling out
  NormalEquations equations(poleAt(m_poles.size()));
  for (std::size_t i = 0; i < poleAt(m_poles.size()); ++i) equations.addPrior(i, 0, anywhere);
  for (std::size_t d = 0; d < m_calibrations.size(); ++d) {
    equations.addPrior(calibrationAt(d), m_calibrations[d][0], m_options.scaleSigma);
    equations.addPrior(calibrationAt(d) + 1, m_calibrations[d][1], m_options.yawSigma);
  }
  for (std::size_t i = 1; i < m_scans.size(); ++i)
    if (m_scans[i].motion) addMotion(i, equations);
  for (const PoleSighting& sighting : m_sightings) addSighting(sighting, equations);
  for (const AssignedPair& anchor : m_anchors) addAnchor(anchor, equations);
  return equations;
}

void DriveAdjustment::step() {
  const Eigen::VectorXd step = equations().solve(m_factored);
  const auto at = [&](std::size_t i) { return step[static_cast<Eigen::Index>(i)]; };
  for (std::size_t i = 0; i < m_poses.size(); ++i) {
    Pose2D& pose = m_poses[i];
    pose = {pose.x + at(3 * i), pose.y + at(3 * i + 1), wrapAngle(pose.yaw + at(3 * i + 2))};
  }
  for (std::size_t d = 0; d < m_calibrations.size(); ++d)
    m_calibrations[d] += Eigen::Vector2d(at(calibrationAt(d)), at(calibrationAt(d) + 1));
  for (std::size_t p = 0; p < m_poles.size(); ++p)
    m_poles[p] += Eigen::Vector2d(at(poleAt(p)), at(poleAt(p) + 1));
}

double DriveAdjustment::sampledSigma() const {
  const std::size_t every = std::max<std::size_t>(1, m_poses.size() / s_sampledPoses);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < m_poses.size(); i += every)
    for (const std::size_t axis : {0u, 1u}) {
      const auto unknown = static_cast<Eigen::Index>(3 * i + axis);
      const Eigen::VectorXd unit =
          Eigen::VectorXd::Unit(static_cast<Eigen::Index>(poleAt(m_poles.size())), unknown);
      sum += m_factored.solve(unit).eval()[unknown];
      ++count;
    }
  return std::sqrt(sum / count);
}

AdjustedDrives DriveAdjustment::run() {
  for (const double gate : s_pairGates) {
    findPoles();
    findAnchors();
    pairUp(gate);
    for (int i = 0; i < s_steps; ++i) step();
  }
  AdjustedDrives result{m_poses, m_poles.size(), {}, 0, sampledSigma()};
  double sum = 0;
  for (const AssignedPair& anchor : m_anchors) {
    result.anchors.push_back(anchor.second);
    sum += (m_poles[anchor.first] - centreOf(m_map[anchor.second])).squaredNorm();
  }
  result.anchorDistance = std::sqrt(sum / static_cast<double>(m_anchors.size()));
  return result;
}

}  // namespace

AdjustedDrives adjustDrives(const std::vector<DrivenScan>& scans, const std::vector<MapPole>& map,
                            const DriveAdjustmentOptions& options) {
  return DriveAdjustment(scans, map, options).run();
}

}  // namespace polemcl
