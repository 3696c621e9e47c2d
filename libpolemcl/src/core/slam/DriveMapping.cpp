#include "core/slam/DriveMapping.h"

#include <algorithm>
#include <cmath>

#include "core/common/DisjointSets.h"
#include "core/common/GreedyAssignment.h"
#include "core/common/Transform.h"
#include "core/slam/LoopSearch.h"

namespace polemcl {
namespace {

constexpr double kKnotSpacing = 10;  ///< m
constexpr int kIterations = 30;      ///< of the least squares, at most
constexpr int kRounds = 2;           ///< of looking for loops
constexpr double kTieGate = 16.3;    ///< squared Mahalanobis distance: 99.9 %
/// m: greatest distance between the tracks of one pole, round by round.
constexpr double kMergeGates[] = {0.8, 0.5}, kLastGate = 0.4;
constexpr std::uint32_t kFollowed = 3;  ///< scans that see a pole at least
constexpr std::ptrdiff_t kFewestTracks = 2;

class DriveMapping {
 public:
  DriveMapping(std::vector<DrivenScan> scans, const AdjustmentTrust& trust)
      : m_scans(std::move(scans)), m_trust(trust) {}
  MappedDrives run();

 private:
  void chain();
  void track();
  void requirePoles() const;
  enum class Covariance { open, known };
  void adjust(const std::vector<PoseTie>& ties, Covariance covariance);
  std::vector<PoseTie> ties() const;
  void closeLoops();
  void merge(double gate, Covariance covariance);
  Eigen::Matrix3d covarianceOf(std::size_t scan) const;
  MappedDrives result() const;

  std::vector<DrivenScan> m_scans;
  AdjustmentTrust m_trust;
  AdjustedState m_state;
  PoleTracks m_tracks;
  AdjustmentFactors m_factors;
  std::vector<Loop> m_loops;
  Knots m_knots;
};

/// Poses by the odometry alone.
void DriveMapping::chain() {
  for (const DrivenScan& scan : m_scans)
    m_state.poses.push_back(scan.motion && !m_state.poses.empty()
                                ? compose(m_state.poses.back(), scan.motion->mean)
                                : Pose2D());
  m_state.odometry.assign(drivesOf(m_scans).back() + 1, Eigen::Vector2d::Zero());
}

/// Follows the poles anew, and places each where its sightings have it on average.
void DriveMapping::track() {
  m_tracks = trackPoles(m_scans, m_state.poses);
  std::vector<double> counts(m_tracks.tracks.size());
  m_state.poles.assign(m_tracks.tracks.size(), Eigen::Vector2d::Zero());
  for (const PoleSighting& sighting : m_tracks.sightings) {
    const PoleDetection& seen = m_scans[sighting.scan].poles_robot[sighting.detection];
    m_state.poles[sighting.pole] +=
        centreOf(compose(m_state.poses[sighting.scan], {seen.x, seen.y, 0}));
    ++counts[sighting.pole];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) m_state.poles[i] /= counts[i];
  m_factors.sightings = m_tracks.sightings;
}

std::vector<PoseTie> DriveMapping::ties() const {
  std::vector<PoseTie> ties;
  for (const Loop& loop : m_loops) ties.push_back(loop.tie);
  return ties;
}

void DriveMapping::requirePoles() const {
  const auto followed = std::count_if(m_tracks.tracks.begin(), m_tracks.tracks.end(),
                                      [](const PoleTrack& pole) { return pole.hits >= kFollowed; });
  if (followed < kFewestTracks)
    throw Error("only " + std::to_string(followed) + " poles were seen in " +
                std::to_string(kFollowed) + " scans or more; " + std::to_string(kFewestTracks) +
                " are needed: without poles nothing corrects the odometry");
}

void DriveMapping::adjust(const std::vector<PoseTie>& ties, Covariance covariance) {
  m_factors.fixedStart = true;
  m_factors.ties = ties;
  JointAdjustment adjustment(m_scans, m_trust, m_factors, m_state);
  adjustment.solve(kIterations);
  if (covariance == Covariance::open) return;
  m_knots = chooseKnots(m_scans, m_state.poses, kKnotSpacing);
  m_knots.covariance = adjustment.poseCovariance(m_knots.scans);
}

/// Looks for loops by what is known now, and lets go of those that do not fit when all are adjusted
/// together.
void DriveMapping::closeLoops() {
  track();
  adjust(ties(), Covariance::known);
  m_loops = findLoops(m_scans, m_state, m_tracks, m_knots);
  for (bool changed = !m_loops.empty(); changed;) {
    adjust(ties(), Covariance::open);
    const auto wrong = std::remove_if(m_loops.begin(), m_loops.end(), [&](const Loop& loop) {
      return misfit(loop.tie, m_state.poses, Eigen::Matrix3d::Zero()) > kTieGate;
    });
    changed = wrong != m_loops.end();
    m_loops.erase(wrong, m_loops.end());
  }
}

/// The tracks of a submap become one with those seen earlier, where a loop was closed.
void DriveMapping::merge(double gate, Covariance covariance) {
  DisjointSets sets(m_tracks.tracks.size());  // tracks that are one pole
  std::vector<Eigen::Vector2d> places = m_state.poles;
  for (const Loop& loop : m_loops) {
    std::vector<Eigen::Vector2d> own, earlier;
    for (const std::size_t track : loop.tracks) own.push_back(places[track]);
    for (const std::size_t track : loop.earlier) earlier.push_back(places[track]);
    for (const AssignedPair& pair : greedyAssignment(own, earlier, gate))
      sets.join(loop.tracks[pair.first], loop.earlier[pair.second]);
  }
  m_factors.sightings = m_tracks.sightings;
  for (PoleSighting& sighting : m_factors.sightings) sighting.pole = sets.root(sighting.pole);
  adjust({}, covariance);
  for (std::size_t i = 0; i < m_tracks.tracks.size(); ++i)
    m_state.poles[i] = m_state.poles[sets.root(i)];
}

MappedDrives DriveMapping::run() {
  chain();
  track();
  requirePoles();
  adjust({}, Covariance::open);
  for (int i = 0; i < kRounds; ++i) closeLoops();
  for (const double gate : kMergeGates) merge(gate, Covariance::open);
  merge(kLastGate, Covariance::known);
  return result();
}

/// Linear between the knots before and after.
Eigen::Matrix3d DriveMapping::covarianceOf(std::size_t scan) const {
  const auto& knots = m_knots.scans;
  const auto block = [&](std::size_t knot) -> Eigen::Matrix3d {
    const auto at = static_cast<Eigen::Index>(3 * knot);
    return m_knots.covariance.block<3, 3>(at, at);
  };
  const auto after =
      static_cast<std::size_t>(std::lower_bound(knots.begin(), knots.end(), scan) - knots.begin());
  if (knots[after] == scan) return block(after);
  const std::size_t before = after - 1;
  const double share =
      static_cast<double>(scan - knots[before]) / static_cast<double>(knots[after] - knots[before]);
  return (1 - share) * block(before) + share * block(after);
}

MappedDrives DriveMapping::result() const {
  MappedDrives result;
  result.odometry = m_state.odometry;
  for (std::size_t i = 0; i < m_scans.size(); ++i)
    result.poses.push_back({m_state.poses[i], covarianceOf(i)});
  for (const Loop& loop : m_loops) result.loops.push_back({loop.tie.first, loop.tie.second});
  for (const PoleTrack& track : m_tracks.tracks) result.tracks += track.hits >= kFollowed ? 1 : 0;
  result.driven = m_knots.driven.back();
  return result;
}

}  // namespace

MappedDrives mapDrives(std::vector<DrivenScan> scans, const AdjustmentTrust& trust) {
  return DriveMapping(std::move(scans), trust).run();
}

}  // namespace polemcl
