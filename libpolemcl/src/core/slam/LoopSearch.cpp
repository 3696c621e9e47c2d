#include "core/slam/LoopSearch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "core/common/Covariance.h"
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
             const PoleTracks& tracks, const Knots& knots, const std::vector<std::size_t>& frames)
      : m_scans(scans),
        m_state(state),
        m_tracks(tracks),
        m_knots(knots),
        m_frames(frames),
        m_tree(state.poles) {}
  std::vector<Loop> run();

 private:
  /// A submap, and where it is searched.
  struct Query {
    std::size_t knot = 0;
    const LocalSubmap& submap;
    std::size_t before = 0;  ///< see SubmapVisitor
    std::size_t frame = 0;   ///< whose poles it is searched among
  };
  void search(const Query& query);
  std::vector<std::size_t> candidates(const Query& query, double sigma) const;
  std::vector<MapPole> polesOf(const std::vector<std::size_t>& tracks) const;
  const GlobalHypothesis* choose(const Query& query, const GlobalResult& found,
                                 const GlobalOptions& options, PoseTie& tie) const;
  std::optional<PoseTie> tieOf(const Query& query, const GlobalHypothesis& place) const;
  bool isConnected(const Query& query) const {
    return m_frames[m_knots.scans[query.knot]] == query.frame;
  }
  double positionSigma(std::size_t knot) const;
  bool agree(const Loop& a, const Loop& b) const;

  const std::vector<DrivenScan>& m_scans;
  const AdjustedState& m_state;
  const PoleTracks& m_tracks;
  const Knots& m_knots;
  const std::vector<std::size_t>& m_frames;
  KdTree2D m_tree;                                   ///< of the tracks
  std::map<std::size_t, std::vector<Loop>> m_loops;  ///< by the frame searched
};

double LoopSearch::positionSigma(std::size_t knot) const {
  return largestSigma(blockOf(m_knots, knot, knot).topLeftCorner<2, 2>());
}

/// The way to the knot from the nearest one that was passed long before, if the place fits it.
std::optional<PoseTie> LoopSearch::tieOf(const Query& query, const GlobalHypothesis& place) const {
  std::optional<std::size_t> nearest;
  double least = kReach;
  for (std::size_t i = 0; i < query.knot; ++i) {
    if (m_knots.driven[i] > m_knots.driven[query.knot] - query.submap.options().length) break;
    if (m_frames[m_knots.scans[i]] != query.frame) continue;
    const Pose2D& pose = m_state.poses[m_knots.scans[i]];
    const double distance =
        std::hypot(pose.x - place.pose_map_robot.x, pose.y - place.pose_map_robot.y);
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  if (!nearest) return std::nullopt;
  const std::size_t first = m_knots.scans[*nearest], second = m_knots.scans[query.knot];
  const Pose2D &from = m_state.poses[first], &to = m_state.poses[second];
  PoseTie tie{first, second, {relative(from, place.pose_map_robot), place.covariance}};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotationOf(-from.yaw);
  tie.motion.covariance = turn * place.covariance * turn.transpose();
  tie.motion.covariance.diagonal() +=
      Eigen::Vector3d(kTieSigma, kTieSigma, kTieYawSigma).cwiseAbs2();
  const bool fits =
      !isConnected(query) ||
      misfit(tie, m_state.poses, wayCovariance(m_knots, *nearest, query.knot, from, to)) <= kGate;
  return fits ? std::optional(tie) : std::nullopt;
}

/// Tracks seen before, where the drive may be.
std::vector<std::size_t> LoopSearch::candidates(const Query& query, double sigma) const {
  const std::size_t scan = m_knots.scans[query.knot];
  std::vector<bool> own(m_tracks.tracks.size());
  for (const SubmapPole& pole : query.submap.poles()) own[query.before + pole.number] = true;
  std::vector<std::size_t> near;
  if (isConnected(query)) {
    std::vector<PointHit> hits;
    m_tree.within(m_state.poses[scan].x, m_state.poses[scan].y, kReach + kRegionSigmas * sigma,
                  hits);
    for (const PointHit& hit : hits) near.push_back(hit.index);
  } else {
    near.resize(m_tracks.tracks.size());
    std::iota(near.begin(), near.end(), std::size_t{0});
  }
  std::vector<std::size_t> chosen;
  for (const std::size_t index : near) {
    const PoleTrack& track = m_tracks.tracks[index];
    if (!own[index] && track.last < scan && track.hits >= kFewestHits &&
        m_frames[track.last] == query.frame)
      chosen.push_back(index);
  }
  return chosen;
}

std::vector<MapPole> LoopSearch::polesOf(const std::vector<std::size_t>& tracks) const {
  std::vector<MapPole> map;
  for (const std::size_t track : tracks) {
    MapPole pole;
    pole.x = m_state.poles[track].x();
    pole.y = m_state.poles[track].y();
    pole.radius = m_tracks.tracks[track].radius;
    pole.covariance = kTrackSigma * kTrackSigma * Eigen::Matrix2d::Identity();
    map.push_back(pole);
  }
  return map;
}

/// The best place that fits, if it clearly beats all others that do; with the tie to it.
const GlobalHypothesis* LoopSearch::choose(const Query& query, const GlobalResult& found,
                                           const GlobalOptions& options, PoseTie& tie) const {
  double second = 0;  // against no place at all it must lead as well
  const GlobalHypothesis* best = nullptr;
  for (const GlobalHypothesis& place : found.hypotheses) {
    const auto fitting = tieOf(query, place);
    if (!fitting) continue;
    if (best) {
      second = std::max(second, place.logRatio);
      break;
    }
    best = &place;
    tie = *fitting;
  }
  const bool clear = best && best->matched >= static_cast<std::uint32_t>(options.minMatched) &&
                     best->matchedShare >= options.minShare &&
                     best->logRatio - second >= options.margin;
  return clear ? best : nullptr;
}

void LoopSearch::search(const Query& query) {
  Loop loop;
  for (const SubmapPole& pole : query.submap.poles())
    if (pole.hits > 1) loop.tracks.push_back(query.before + pole.number);
  const double sigma = positionSigma(query.knot);
  loop.earlier = candidates(query, sigma);
  GlobalOptions options;
  if (isConnected(query) && 3 * sigma < kNear) options.minMatched = kFewMatched;
  if (loop.earlier.size() < static_cast<std::size_t>(options.minMatched)) return;
  const GlobalResult found = GlobalLocalizer(polesOf(loop.earlier), options).localize(query.submap);
  const GlobalHypothesis* best = choose(query, found, options, loop.tie);
  if (!best) return;
  loop.place = best->pose_map_robot;
  m_loops[query.frame].push_back(std::move(loop));
}

/// Whether the correction that one loop asks for is that of the other.
bool LoopSearch::agree(const Loop& a, const Loop& b) const {
  const Pose2D &poseA = m_state.poses[a.tie.second], &poseB = m_state.poses[b.tie.second];
  const Pose2D way = relative(poseA, poseB), asked = relative(a.place, b.place);
  return m_frames[a.tie.second] == m_frames[b.tie.second] &&
         std::hypot(way.x, way.y) < kNeighbours &&
         std::hypot(way.x - asked.x, way.y - asked.y) < kSamePlace &&
         std::abs(wrapAngle(way.yaw - asked.yaw)) < kSameYaw;
}

std::vector<Loop> LoopSearch::run() {
  std::size_t next = 0;
  trackPoles(m_scans, m_state.poses,
             [&](std::size_t scan, const LocalSubmap& submap, std::size_t before) {
               if (next == m_knots.scans.size() || m_knots.scans[next] != scan) return;
               const std::set<std::size_t> frames(
                   m_frames.begin(), m_frames.begin() + static_cast<std::ptrdiff_t>(scan) + 1);
               for (const std::size_t frame : frames) search({next, submap, before, frame});
               ++next;
             });
  std::vector<Loop> supported;
  for (const auto& [frame, loops] : m_loops)
    for (std::size_t i = 0; i < loops.size(); ++i)
      if ((i > 0 && agree(loops[i - 1], loops[i])) ||
          (i + 1 < loops.size() && agree(loops[i], loops[i + 1])))
        supported.push_back(loops[i]);
  return supported;
}

/// Adds the poles that the latest scan saw.
void addSeen(const LocalSubmap& submap, std::size_t scan, std::size_t before, PoleTracks& found) {
  for (const SubmapPole& pole : submap.poles()) {
    if (pole.seenFrame != submap.frames()) continue;
    const std::size_t number = before + pole.number;
    if (number >= found.tracks.size()) found.tracks.resize(number + 1, {scan, scan, 0, 0});
    PoleTrack& track = found.tracks[number];
    track.last = scan;
    track.hits = pole.hits;
    track.radius = pole.radius;
    found.sightings.push_back({scan, pole.detection, number});
  }
}

}  // namespace

PoleTracks trackPoles(const std::vector<DrivenScan>& scans, const std::vector<Pose2D>& poses,
                      const SubmapVisitor& visit) {
  PoleTracks found;
  LocalSubmap submap;
  std::size_t before = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i == 0 || !scans[i].motion) {
      submap.clear();
      before = found.tracks.size();
      submap.add(Pose2D(), scans[i].poles_robot);
    } else {
      submap.add(relative(poses[i - 1], poses[i]), scans[i].motion->covariance,
                 scans[i].poles_robot);
    }
    addSeen(submap, i, before, found);
    if (visit) visit(i, submap, before);
  }
  return found;
}

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
                            const PoleTracks& tracks, const Knots& knots,
                            const std::vector<std::size_t>& frames) {
  return LoopSearch(scans, state, tracks, knots, frames).run();
}

}  // namespace polemcl
