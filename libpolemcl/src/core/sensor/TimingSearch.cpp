#include "core/sensor/TimingSearch.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/common/Deskew.h"
#include "core/common/KdTree2D.h"
#include "core/common/Statistics.h"

namespace polemcl {
namespace {

constexpr double kAway[] = {1, 2, 4, 8};   // m between the two scans of a pair
constexpr double kLongestPause = 1;        // s between successive scans, else no velocity
constexpr double kWidest = 1, kFar = 0.3;  // m: gate of a pair, and greatest distance that counts
constexpr std::size_t kMostPairs = 30000;
constexpr double kGreatest = 15;                      // clock offsets, in steps
constexpr double kStep = kGreatestClock / kGreatest;  // 0.01 s
constexpr std::size_t kFewestPairs = 100;             // for a correction of the ranges

/// Sightings of one pole in two scans.
struct Resighting {
  std::size_t scanA, poleA, scanB, poleB;
};

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// For each pair of sightings the vector from the first place to the second, m, and how it changes
/// with the offset (m) and the scale of the ranges.
struct RangeFit {
  explicit RangeFit(std::size_t pairs)
      : apart(static_cast<Eigen::Index>(pairs), 2), byOffset(apart), byScale(apart) {}
  Eigen::VectorXd distances(const Eigen::Vector2d& fit) const {
    return (apart + fit[0] * byOffset + fit[1] * byScale).rowwise().norm();
  }
  std::vector<double> clippedDistances(const Eigen::Vector2d& fit) const {
    const Eigen::VectorXd clipped = distances(fit).cwiseMin(kFar);
    return {clipped.begin(), clipped.end()};
  }
  /// Offset, and scale - 1, by least squares with Cauchy weights.
  Eigen::Vector2d solve() const;

  Eigen::MatrixX2d apart, byOffset, byScale;
};

Eigen::Vector2d RangeFit::solve() const {
  Eigen::Vector2d fit(0, 0);
  for (int round = 0; round < 20; ++round) {
    const Eigen::VectorXd error = distances(fit);
    const double usual = 2 * nearestRank({error.begin(), error.end()}, 0.5) + 1e-6;
    const Eigen::VectorXd weight = (1 + (error / usual).array().square()).inverse();
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right(0, 0);
    for (Eigen::Index k = 0; k < apart.rows(); ++k) {
      Eigen::Matrix2d design;
      design << byOffset.row(k).transpose(), byScale.row(k).transpose();
      normal += weight[k] * design.transpose() * design;
      right -= weight[k] * design.transpose() * apart.row(k).transpose();
    }
    fit = normal.ldlt().solve(right);
  }
  return fit;
}

class Search {
 public:
  Search(const std::vector<TimedScan>& scans, double turnSeconds);
  void associate(const ScanTiming& timing);
  const std::vector<Resighting>& pairs() const { return m_pairs; }
  /// Distances of the pairs, m.
  std::vector<double> distances(const ScanTiming& timing) const;
  double mean(const ScanTiming& timing) const;
  /// Standard errors by which `better` is better; the pairs of a scan count as one sample.
  double significance(const ScanTiming& better, const ScanTiming& worse) const;
  /// The same for distances of all pairs.
  double significance(const std::vector<double>& good, const std::vector<double>& bad) const;
  RangeCorrection bestRanges(const ScanTiming& timing, const Eigen::Vector2d& lidar_robot) const;
  ScanTiming bestTurn(double clock) const;
  double bestClock(ScanTiming timing) const;
  ScanTiming bestOfAll() const;

 private:
  Eigen::Vector2d place(std::size_t scan, const TimedPole& pole, const ScanTiming& timing) const;
  /// From the LiDAR to the pole when it was measured, map frame, m.
  Eigen::Vector2d ray(std::size_t scan, const TimedPole& pole, const ScanTiming& timing,
                      const Eigen::Vector2d& lidar_robot) const;
  RangeFit rangeFit(const ScanTiming& timing, const Eigen::Vector2d& lidar_robot) const;
  std::vector<std::size_t> partners(std::size_t scan) const;

  const std::vector<TimedScan>& m_scans;
  double m_seconds;
  std::vector<Velocity> m_velocity;
  std::vector<double> m_way;  ///< driven up to each scan, m
  std::vector<Resighting> m_pairs;
};

Search::Search(const std::vector<TimedScan>& scans, double turnSeconds)
    : m_scans(scans), m_seconds(turnSeconds), m_velocity(scans.size()), m_way(scans.size()) {
  std::vector<int> parts(scans.size());
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const Pose2D motion = relative(scans[i - 1].pose_map_robot, scans[i].pose_map_robot);
    m_way[i] = m_way[i - 1] + std::hypot(motion.x, motion.y);
    const double pause = scans[i].time - scans[i - 1].time;
    if (!(pause > 0 && pause <= kLongestPause)) continue;
    const Velocity velocity = velocityOf(motion, pause);
    for (const std::size_t k : {i - 1, i}) {
      m_velocity[k].x += velocity.x;
      m_velocity[k].y += velocity.y;
      m_velocity[k].yaw += velocity.yaw;
      ++parts[k];
    }
  }
  for (std::size_t k = 0; k < scans.size(); ++k)
    if (parts[k] == 2)
      m_velocity[k] = {m_velocity[k].x / 2, m_velocity[k].y / 2, m_velocity[k].yaw / 2};
}

Eigen::Vector2d Search::place(std::size_t scan, const TimedPole& pole,
                              const ScanTiming& timing) const {
  const Pose2D moved = motionAfter(m_velocity[scan], timing.offset(pole.azimuth));
  const Pose2D at = compose(m_scans[scan].pose_map_robot, compose(moved, {pole.x, pole.y, 0}));
  return {at.x, at.y};
}

Eigen::Vector2d Search::ray(std::size_t scan, const TimedPole& pole, const ScanTiming& timing,
                            const Eigen::Vector2d& lidar_robot) const {
  const double turned = timing.offset(pole.azimuth) * m_velocity[scan].yaw;
  return Eigen::Rotation2Dd(m_scans[scan].pose_map_robot.yaw + turned) *
         (Eigen::Vector2d(pole.x, pole.y) - lidar_robot);
}

std::vector<std::size_t> Search::partners(std::size_t scan) const {
  std::vector<std::size_t> result;
  for (const double away : kAway) {
    const auto found = std::lower_bound(m_way.begin() + static_cast<std::ptrdiff_t>(scan),
                                        m_way.end(), m_way[scan] + away);
    if (found == m_way.end()) break;
    const auto partner = static_cast<std::size_t>(found - m_way.begin());
    if (result.empty() || partner > result.back()) result.push_back(partner);
  }
  return result;
}

void Search::associate(const ScanTiming& timing) {
  std::vector<KdTree2D> trees;
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    std::vector<Eigen::Vector2d> places;
    for (const TimedPole& pole : m_scans[i].poles_robot) places.push_back(place(i, pole, timing));
    trees.emplace_back(std::move(places));
  }
  m_pairs.clear();
  for (std::size_t i = 0; i < m_scans.size(); ++i)
    for (const std::size_t j : partners(i))
      for (std::size_t a = 0; a < trees[i].size(); ++a) {
        const Eigen::Vector2d& here = trees[i].point(a);
        const PointHit hit = trees[j].nearest(here.x(), here.y(), kWidest);
        if (!hit) continue;
        const Eigen::Vector2d& there = trees[j].point(hit.index);
        if (trees[i].nearest(there.x(), there.y(), kWidest).index == a)
          m_pairs.push_back({i, a, j, hit.index});
      }
  if (m_pairs.size() <= kMostPairs) return;
  std::vector<Resighting> spread;
  spread.reserve(kMostPairs);
  for (std::size_t k = 0; k < kMostPairs; ++k)
    spread.push_back(m_pairs[k * m_pairs.size() / kMostPairs]);
  m_pairs.swap(spread);
}

std::vector<double> Search::distances(const ScanTiming& timing) const {
  std::vector<double> result;
  result.reserve(m_pairs.size());
  for (const Resighting& pair : m_pairs) {
    const auto a = place(pair.scanA, m_scans[pair.scanA].poles_robot[pair.poleA], timing);
    const auto b = place(pair.scanB, m_scans[pair.scanB].poles_robot[pair.poleB], timing);
    result.push_back(std::min((a - b).norm(), kFar));
  }
  return result;
}

double Search::mean(const ScanTiming& timing) const {
  return meanOf(distances(timing));
}

double Search::significance(const ScanTiming& better, const ScanTiming& worse) const {
  return significance(distances(better), distances(worse));
}

double Search::significance(const std::vector<double>& good, const std::vector<double>& bad) const {
  double sum = 0, squares = 0, here = 0;
  for (std::size_t k = 0; k < m_pairs.size(); ++k) {
    here += bad[k] - good[k];
    if (k + 1 < m_pairs.size() && m_pairs[k + 1].scanA == m_pairs[k].scanA) continue;
    sum += here;
    squares += here * here;
    here = 0;
  }
  return squares > 0 ? sum / std::sqrt(squares) : 0;
}

RangeFit Search::rangeFit(const ScanTiming& timing, const Eigen::Vector2d& lidar_robot) const {
  RangeFit fit(m_pairs.size());
  for (std::size_t k = 0; k < m_pairs.size(); ++k) {
    const Resighting& pair = m_pairs[k];
    const TimedPole& a = m_scans[pair.scanA].poles_robot[pair.poleA];
    const TimedPole& b = m_scans[pair.scanB].poles_robot[pair.poleB];
    const Eigen::Vector2d rayA = ray(pair.scanA, a, timing, lidar_robot),
                          rayB = ray(pair.scanB, b, timing, lidar_robot);
    const auto row = static_cast<Eigen::Index>(k);
    fit.apart.row(row) = place(pair.scanB, b, timing) - place(pair.scanA, a, timing);
    fit.byOffset.row(row) = rayB.normalized() - rayA.normalized();
    fit.byScale.row(row) = rayB - rayA;
  }
  return fit;
}

RangeCorrection Search::bestRanges(const ScanTiming& timing,
                                   const Eigen::Vector2d& lidar_robot) const {
  const RangeFit fit = rangeFit(timing, lidar_robot);
  const Eigen::Vector2d found = fit.solve();
  const auto good = fit.clippedDistances(found);
  const auto bad = fit.clippedDistances(Eigen::Vector2d::Zero());
  return {found[0], 1 + found[1], meanOf(bad), meanOf(good), significance(good, bad)};
}

/// The best of not turning, and of turning with cuts in steps of 15°.
ScanTiming Search::bestTurn(double clock) const {
  ScanTiming best{Turn::compensated, m_seconds, M_PI, 0.5, clock};
  double least = mean(best);
  const auto attempt = [&](Turn turn, double cut) {
    const ScanTiming timing{turn, m_seconds, std::remainder(cut, 2 * M_PI), 0.5, clock};
    if (const double distance = mean(timing); distance < least) {
      least = distance;
      best = timing;
    }
  };
  for (const Turn turn : {Turn::clockwise, Turn::counterclockwise})
    for (int k = 0; k < 8; ++k) attempt(turn, M_PI + k * M_PI / 4);
  if (!best.known()) return best;
  const ScanTiming rough = best;
  for (const int k : {-2, -1, 1, 2}) attempt(rough.turn, rough.cut + k * M_PI / 12);
  return best;
}

double Search::bestClock(ScanTiming timing) const {
  double least = std::numeric_limits<double>::infinity(), best = 0;
  for (double k = -kGreatest; k <= kGreatest; ++k) {
    timing.clock = k * kStep;
    if (const double distance = mean(timing); distance < least) {
      least = distance;
      best = timing.clock;
    }
  }
  return best;
}

/// The best turn with the best clock. Each needs the other, so they are searched in turns, from
/// stamps at the end, in the middle and at the begin of a scan.
ScanTiming Search::bestOfAll() const {
  ScanTiming best;
  double least = std::numeric_limits<double>::infinity();
  for (const double stamp : {0.0, -0.5, 0.5}) {
    ScanTiming timing = bestTurn(stamp * m_seconds);
    double clock = bestClock(timing);
    for (int k = 0; k < 4 && clock != timing.clock; ++k) {
      timing = bestTurn(clock);
      clock = bestClock(timing);
    }
    if (const double distance = mean(timing); distance < least) {
      least = distance;
      best = timing;
    }
  }
  return best;
}

/// The best of all timings, beside none.
TimingEstimate searchAll(Search& search, double turnSeconds, bool clocks) {
  TimingEstimate result;
  const ScanTiming still{Turn::compensated, turnSeconds, M_PI, 0.5, 0};
  result.timing = still;
  // The second time with the pairs that the first result shows.
  for (int round = 0; round < 2; ++round) {
    search.associate(result.timing);
    result.pairs = search.pairs().size();
    if (result.pairs == 0) return result;
    ScanTiming best = search.bestTurn(0);
    const ScanTiming shifted = clocks ? search.bestOfAll() : best;
    result.clockSignificance = search.significance(shifted, best);
    if (result.clockSignificance >= kEnoughErrors) best = shifted;
    ScanTiming standing = still;
    standing.clock = best.clock;
    result.turnSignificance = search.significance(best, standing);
    const bool isClear = result.turnSignificance >= kEnoughErrors;
    result.timing = isClear ? best : standing;
    result.candidate = isClear ? ScanTiming() : best;
    result.withCandidate = search.mean(best);
  }
  result.before = search.mean(still);
  result.after = search.mean(result.timing);
  return result;
}

/// The stated timing, if clocks may differ with the best one if that is clear.
TimingEstimate keptTiming(const Search& search, const ScanTiming& stated, bool clocks) {
  TimingEstimate result;
  result.isStated = true;
  result.pairs = search.pairs().size();
  result.timing = stated;
  if (clocks) result.timing.clock = search.bestClock(stated);
  result.clockSignificance = search.significance(result.timing, stated);
  if (result.clockSignificance < kEnoughErrors) result.timing.clock = stated.clock;
  result.before = search.mean({Turn::compensated, stated.seconds, M_PI, 0.5, 0});
  result.after = search.mean(result.timing);
  return result;
}

}  // namespace

TimingEstimate searchTiming(const std::vector<TimedScan>& scans, double turnSeconds,
                            const ScanTiming& stated, bool clocks) {
  Search search(scans, turnSeconds);
  const TimingEstimate found = searchAll(search, turnSeconds, clocks);
  if (!stated.known() || found.pairs == 0) return found;
  TimingEstimate kept = keptTiming(search, stated, clocks);
  kept.turnSignificance = search.significance(found.timing, kept.timing);
  return kept.turnSignificance < kEnoughErrors ? kept : found;
}

bool RangeCorrection::isClear() const {
  return significance >= kEnoughErrors && std::abs(offset) <= 0.5 && std::abs(scale - 1) <= 0.1;
}

std::optional<RangeCorrection> searchRangeCorrection(const std::vector<TimedScan>& scans,
                                                     const ScanTiming& timing,
                                                     const Eigen::Vector2d& lidar_robot) {
  Search search(scans, timing.seconds);
  search.associate(timing);
  if (search.pairs().size() < kFewestPairs) return std::nullopt;
  const RangeCorrection found = search.bestRanges(timing, lidar_robot);
  return std::isfinite(found.offset + found.scale) ? std::optional(found) : std::nullopt;
}

}  // namespace polemcl
