#include "core/mapping/DriveAdjustment.h"

#include <algorithm>
#include <cmath>

#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// m: greatest distance of a detection from its pole, round by round.
constexpr double kPairGates[] = {0.8, 0.5, 0.5, 0.4};
constexpr int kSolverSteps = 4;      ///< of the least squares, in each round
constexpr double kAnchorSigmas = 3;  ///< greatest distance from a pole of the map
constexpr double kNearAnchor = 0.5;  ///< m: but this at least, for the poses err as well
constexpr std::size_t kFewestAnchors = 3;
constexpr std::size_t kSampledPoses = 20;  ///< whose standard deviations are looked at

class DriveAdjustment {
 public:
  DriveAdjustment(const std::vector<DrivenScan>& scans, const std::vector<MapPole>& map,
                  const DriveAdjustmentOptions& options)
      : m_scans(scans), m_map(map), m_options(options), m_drives(drivesOf(scans)) {
    for (const DrivenScan& scan : scans) m_state.poses.push_back(scan.pose_map_robot);
    if (!scans.empty()) m_state.odometry.assign(m_drives.back() + 1, Eigen::Vector2d::Zero());
    m_options.trust.poleSigma = options.mapping.poseSigma;
  }
  AdjustedDrives run();

 private:
  void findPoles();
  void pairUp(double gate);
  void findAnchors();
  double sampledSigma(const JointAdjustment& adjustment) const;

  const std::vector<DrivenScan>& m_scans;
  const std::vector<MapPole>& m_map;
  DriveAdjustmentOptions m_options;
  std::vector<std::size_t> m_drives;  ///< of each scan
  AdjustedState m_state;
  AdjustmentFactors m_factors;
  std::vector<AssignedPair> m_anchors;  ///< poles seen, and poles of the map
};

void DriveAdjustment::findPoles() {
  std::vector<MappingScan> scans;
  for (std::size_t i = 0; i < m_scans.size(); ++i)
    scans.push_back(
        {m_state.poses[i], m_scans[i].poles_robot, static_cast<std::uint32_t>(m_drives[i])});
  m_state.poles = centresOf(buildPoleMap(scans, m_options.mapping).poles);
}

void DriveAdjustment::pairUp(double gate) {
  const KdTree2D tree(m_state.poles);
  m_factors.sightings.clear();
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    std::vector<AssignedPair> candidates;
    for (std::size_t k = 0; k < m_scans[i].poles_robot.size(); ++k) {
      const PoleDetection& seen = m_scans[i].poles_robot[k];
      const Pose2D place = compose(m_state.poses[i], {seen.x, seen.y, 0});
      tree.within(place.x, place.y, gate, hits);
      for (const PointHit& hit : hits) candidates.push_back({k, hit.index, hit.squaredDistance});
    }
    for (const AssignedPair& pair : chooseClosest(std::move(candidates)))
      m_factors.sightings.push_back({i, pair.first, pair.second});
  }
}

void DriveAdjustment::findAnchors() {
  double variance = 0;
  for (const MapPole& pole : m_map) variance = std::max(variance, pole.covariance.trace() / 2);
  m_anchors = greedyAssignment(m_state.poles, centresOf(m_map),
                               std::max(kNearAnchor, kAnchorSigmas * std::sqrt(variance)));
  if (m_anchors.size() < kFewestAnchors)
    throw Error("only " + std::to_string(m_anchors.size()) + " of " +
                std::to_string(m_state.poles.size()) + " poles seen stand near one of the map; " +
                std::to_string(kFewestAnchors) + " are needed: are the poses in its frame?");
  m_factors.anchors.clear();
  for (const AssignedPair& anchor : m_anchors)
    m_factors.anchors.push_back({anchor.first, m_map[anchor.second]});
}

double DriveAdjustment::sampledSigma(const JointAdjustment& adjustment) const {
  const std::size_t every = std::max<std::size_t>(1, m_scans.size() / kSampledPoses);
  std::vector<std::size_t> sampled;
  for (std::size_t i = 0; i < m_scans.size(); i += every) sampled.push_back(i);
  const Eigen::VectorXd variances = adjustment.poseCovariance(sampled).diagonal();
  double sum = 0;
  for (Eigen::Index i = 0; i < variances.size(); i += 3) sum += variances[i] + variances[i + 1];
  return std::sqrt(sum / (2 * static_cast<double>(sampled.size())));
}

AdjustedDrives DriveAdjustment::run() {
  AdjustedDrives result;
  for (const double& gate : kPairGates) {
    findPoles();
    findAnchors();
    pairUp(gate);
    JointAdjustment adjustment(m_scans, m_options.trust, m_factors, m_state);
    adjustment.solve(kSolverSteps);
    if (&gate == std::end(kPairGates) - 1) result.sigma = sampledSigma(adjustment);
  }
  result.poses_map_robot = m_state.poses;
  result.poles = m_state.poles.size();
  double sum = 0;
  for (const AssignedPair& anchor : m_anchors) {
    result.anchors.push_back(anchor.second);
    sum += (m_state.poles[anchor.first] - centreOf(m_map[anchor.second])).squaredNorm();
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
