#include "core/slam/LoopSearch.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "core/global_localization/GlobalLocalizer.h"

namespace polemcl {
namespace {

constexpr double kReach = 60;             ///< m: the poles of a submap lie within it
constexpr double kRegionSigmas = 4;       ///< of the pose: how far poles are looked for
constexpr std::uint32_t kFewestHits = 3;  ///< of a track that is searched among
constexpr double kTrackSigma = 0.03;      ///< m, of its place among its neighbours
/// Greatest squared Mahalanobis distance of a place from the poses: 99.9 % of three dimensions,
/// with sigmas that are half of what they should be.
constexpr double kGate = 4 * 16.3;
constexpr double kNear = 5;     ///< m: greatest three sigmas for which few matches will do
constexpr int kFewMatched = 4;  ///< least number of them
/// What a tie may err by beyond its covariance: the poles before it are bent.
constexpr double kTieSigma = 0.05, kTieYawSigma = 0.003;
/// Two loops agree if their knots are this near, and their corrections.
constexpr double kNeighbours = 35, kSamePlace = 0.5, kSameYaw = 0.03;

Eigen::Matrix3d blockOf(const Knots& knots, std::size_t row, std::size_t column) {
  return knots.covariance.block<3, 3>(static_cast<Eigen::Index>(3 * row),
                                      static_cast<Eigen::Index>(3 * column));
}

/// Covariance of the way from one knot to another, frame of the first.
Eigen::Matrix3d wayCovariance(const Knots& knots, std::size_t a, std::size_t b, const Pose2D& from,
                              const Pose2D& to) {
  const Pose2D way = relative(from, to);
  Eigen::Matrix3d byA = Eigen::Matrix3d::Identity(), byB = byA;
  byA.topLeftCorner<2, 2>() = -rotationOf(-from.yaw);
  byA.col(2) << way.y, -way.x, -1;
  byB.topLeftCorner<2, 2>() = rotationOf(-from.yaw);
  const Eigen::Matrix3d cross = byA * blockOf(knots, a, b) * byB.transpose();
  return byA * blockOf(knots, a, a) * byA.transpose() +
         byB * blockOf(knots, b, b) * byB.transpose() + cross + cross.transpose();
}

class LoopSearch {
 public:
  LoopSearch(const std::vector<DrivenScan>& scans, const AdjustedState& state,
             const PoleTracks& tracks, const Knots& knots)
      : m_scans(scans), m_state(state), m_tracks(tracks), m_knots(knots), m_tree(state.poles) {}
  std::vector<Loop> run();

 private:
  void search(std::size_t knot, const LocalSubmap& submap, std::size_t before);
  std::optional<PoseTie> tieOf(std::size_t knot, const GlobalHypothesis& place,
                               double length) const;
  double positionSigma(std::size_t knot) const;
  bool agree(const Loop& a, const Loop& b) const;

  const std::vector<DrivenScan>& m_scans;
  const AdjustedState& m_state;
  const PoleTracks& m_tracks;
  const Knots& m_knots;
  KdTree2D m_tree;  ///< of the tracks
  std::vector<Loop> m_loops;
};

double LoopSearch::positionSigma(std::size_t knot) const {
  const Eigen::Matrix2d covariance = blockOf(m_knots, knot, knot).topLeftCorner<2, 2>();
  return std::sqrt(covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
}

/// The way to the knot from the nearest one that was passed long before, if the place fits it.
std::optional<PoseTie> LoopSearch::tieOf(std::size_t knot, const GlobalHypothesis& place,
                                         double length) const {
  std::optional<std::size_t> nearest;
  double least = kReach;
  for (std::size_t i = 0; i < knot; ++i) {
    if (m_knots.driven[i] > m_knots.driven[knot] - length) break;
    const Pose2D& pose = m_state.poses[m_knots.scans[i]];
    const double distance =
        std::hypot(pose.x - place.pose_map_robot.x, pose.y - place.pose_map_robot.y);
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  if (!nearest) return std::nullopt;
  const std::size_t first = m_knots.scans[*nearest], second = m_knots.scans[knot];
  const Pose2D &from = m_state.poses[first], &to = m_state.poses[second];
  PoseTie tie{first, second, {relative(from, place.pose_map_robot), place.covariance}};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotationOf(-from.yaw);
  tie.motion.covariance = turn * place.covariance * turn.transpose();
  tie.motion.covariance.diagonal() +=
      Eigen::Vector3d(kTieSigma, kTieSigma, kTieYawSigma).cwiseAbs2();
  const bool fits =
      misfit(tie, m_state.poses, wayCovariance(m_knots, *nearest, knot, from, to)) <= kGate;
  return fits ? std::optional(tie) : std::nullopt;
}

void LoopSearch::search(std::size_t knot, const LocalSubmap& submap, std::size_t before) {
  const std::size_t scan = m_knots.scans[knot];
  const Pose2D& pose = m_state.poses[scan];
  std::vector<bool> own(m_tracks.tracks.size());
  Loop loop;
  for (const SubmapPole& pole : submap.poles()) {
    own[before + pole.number] = true;
    if (pole.hits > 1) loop.tracks.push_back(before + pole.number);
  }
  const double sigma = positionSigma(knot);
  std::vector<PointHit> hits;
  m_tree.within(pose.x, pose.y, kReach + kRegionSigmas * sigma, hits);
  std::vector<MapPole> map;
  for (const PointHit& hit : hits) {
    const PoleTrack& track = m_tracks.tracks[hit.index];
    if (own[hit.index] || track.last >= scan || track.hits < kFewestHits) continue;
    MapPole pole;
    pole.x = m_state.poles[hit.index].x();
    pole.y = m_state.poles[hit.index].y();
    pole.radius = track.radius;
    pole.covariance = kTrackSigma * kTrackSigma * Eigen::Matrix2d::Identity();
    map.push_back(pole);
    loop.earlier.push_back(hit.index);
  }
  GlobalOptions options;
  if (3 * sigma < kNear) options.minMatched = kFewMatched;
  if (map.size() < static_cast<std::size_t>(options.minMatched)) return;
  const GlobalResult found = GlobalLocalizer(map, options).localize(submap);
  double second = 0;  // against no place at all it must lead as well
  const GlobalHypothesis* best = nullptr;
  for (const GlobalHypothesis& place : found.hypotheses) {
    const auto tie = tieOf(knot, place, submap.options().length);
    if (!tie) continue;
    if (best) {
      second = std::max(second, place.logRatio);
      break;
    }
    best = &place;
    loop.tie = *tie;
  }
  if (!best || best->matched < static_cast<std::uint32_t>(options.minMatched) ||
      best->matchedShare < options.minShare || best->logRatio - second < options.margin)
    return;
  loop.place = best->pose_map_robot;
  m_loops.push_back(std::move(loop));
}

/// Whether the correction that one loop asks for is that of the other.
bool LoopSearch::agree(const Loop& a, const Loop& b) const {
  const Pose2D &poseA = m_state.poses[a.tie.second], &poseB = m_state.poses[b.tie.second];
  const Pose2D way = relative(poseA, poseB), asked = relative(a.place, b.place);
  return std::hypot(way.x, way.y) < kNeighbours &&
         std::hypot(way.x - asked.x, way.y - asked.y) < kSamePlace &&
         std::abs(wrapAngle(way.yaw - asked.yaw)) < kSameYaw;
}

std::vector<Loop> LoopSearch::run() {
  std::size_t next = 0;
  trackPoles(m_scans, m_state.poses,
             [&](std::size_t scan, const LocalSubmap& submap, std::size_t before) {
               if (next < m_knots.scans.size() && m_knots.scans[next] == scan)
                 search(next++, submap, before);
             });
  std::vector<Loop> supported;
  for (std::size_t i = 0; i < m_loops.size(); ++i)
    if ((i > 0 && agree(m_loops[i - 1], m_loops[i])) ||
        (i + 1 < m_loops.size() && agree(m_loops[i], m_loops[i + 1])))
      supported.push_back(m_loops[i]);
  return supported;
}

}  // namespace

Knots chooseKnots(const std::vector<DrivenScan>& scans, const std::vector<Pose2D>& poses,
                  double spacing) {
  Knots knots;
  double driven = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const bool begins = i == 0 || !scans[i].motion;
    if (begins && i > 0) driven += 1e6;  // another drive: nothing is near by the way driven
    if (!begins) driven += std::hypot(poses[i].x - poses[i - 1].x, poses[i].y - poses[i - 1].y);
    const bool last = i + 1 == scans.size() || !scans[i + 1].motion;
    if (!begins && !last && driven < knots.driven.back() + spacing) continue;
    knots.scans.push_back(i);
    knots.driven.push_back(driven);
  }
  return knots;
}

double misfit(const PoseTie& tie, const std::vector<Pose2D>& poses, const Eigen::Matrix3d& more) {
  const Pose2D way = relative(poses[tie.first], poses[tie.second]), &asked = tie.motion.mean;
  const Eigen::Vector3d error(way.x - asked.x, way.y - asked.y, wrapAngle(way.yaw - asked.yaw));
  return error.dot((tie.motion.covariance + more).inverse() * error);
}

std::vector<Loop> findLoops(const std::vector<DrivenScan>& scans, const AdjustedState& state,
                            const PoleTracks& tracks, const Knots& knots) {
  return LoopSearch(scans, state, tracks, knots).run();
}

}  // namespace polemcl
