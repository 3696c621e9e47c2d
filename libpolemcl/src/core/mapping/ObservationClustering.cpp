#include "core/mapping/ObservationClustering.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/common/DisjointSets.h"
#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

using Group = std::vector<std::uint32_t>;

constexpr int kMostRounds = 10;  ///< assigning and growing usually end after two or three

void dropEmpty(std::vector<Group>& groups) {
  groups.erase(
      std::remove_if(groups.begin(), groups.end(), [](const Group& g) { return g.empty(); }),
      groups.end());
}

/// Indices of the observations, in an order that depends on their content only.
Group canonicalOrder(const std::vector<LandmarkObservation>& observations) {
  Group order(observations.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const LandmarkObservation& s = observations[i];
    const Eigen::Matrix2d& c = s.pole.covariance;
    return std::make_tuple(s.pole.x, s.pole.y, s.scan, s.pole.confidence, c(0, 0), c(0, 1), c(1, 1),
                           s.pole.radius, s.pole.bottom, s.pole.top);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return order;
}

/// The work on observations in canonical order.
class Clusterer {
 public:
  Clusterer(std::vector<LandmarkObservation> observations, const ClusteringOptions& options)
      : m_observations(std::move(observations)),
        m_options(options),
        m_tree(centresOf(m_observations)),
        m_nearest(scanCount()) {}

  std::vector<Group> run() {
    growAll();
    for (int round = 0; round < kMostRounds; ++round) {
      assign();
      if (!mergeNeighbours()) break;
    }
    prune();
    sortGroups();
    return std::move(m_groups);
  }

 private:
  std::size_t scanCount() const {
    std::size_t count = 0;
    for (const LandmarkObservation& observation : m_observations)
      count = std::max<std::size_t>(count, observation.scan + 1);
    return count;
  }
  double squaredGate() const { return m_options.mergeDistance * m_options.mergeDistance; }

  std::vector<double> densities() const;
  void growAll();
  Group grow(std::uint32_t seed, const std::vector<bool>& taken);
  Group nearestPerScan(const Eigen::Vector2d& centre, const std::vector<bool>& taken);
  std::vector<Eigen::Vector2d> observationCentres() const;
  void assign();
  bool mergeNeighbours();
  bool areApart(const Group& a, const Group& b) const;
  Group united(const Group& a, const Group& b) const;
  void prune();
  void sortGroups();

  std::vector<LandmarkObservation> m_observations;
  ClusteringOptions m_options;
  KdTree2D m_tree;
  std::vector<PointHit> m_nearest;  ///< scratch: the nearest observation of each scan
  std::vector<PointHit> m_hits;     ///< scratch
  std::vector<Group> m_groups;
};

/// Sum of confidences around each observation, weighted less towards the gate.
std::vector<double> Clusterer::densities() const {
  std::vector<double> density(m_observations.size());
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < m_observations.size(); ++i) {
    const Eigen::Vector2d& p = m_tree.point(i);
    m_tree.within(p.x(), p.y(), m_options.mergeDistance, hits);
    for (const PointHit& hit : hits) {
      const double share = 1 - hit.squaredDistance / squaredGate();
      density[i] += m_observations[hit.index].pole.confidence * share * share;
    }
  }
  return density;
}

void Clusterer::growAll() {
  const std::vector<double> density = densities();
  Group seeds(m_observations.size());
  std::iota(seeds.begin(), seeds.end(), 0u);
  std::stable_sort(seeds.begin(), seeds.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return density[a] > density[b]; });
  std::vector<bool> taken(m_observations.size(), false);
  for (const std::uint32_t seed : seeds) {
    while (!taken[seed]) {  // a centre may move away from its seed
      m_groups.push_back(grow(seed, taken));
      for (const std::uint32_t member : m_groups.back()) taken[member] = true;
    }
  }
}

Group Clusterer::grow(std::uint32_t seed, const std::vector<bool>& taken) {
  Group group{seed};
  for (int round = 0; round < kMostRounds; ++round) {
    Group next = nearestPerScan(fusedCentre(m_observations, group), taken);
    if (next.empty() || next == group) break;
    group = std::move(next);
  }
  return group;
}

/// Nearest observation of each scan inside the gate that no group has taken, by ascending index.
Group Clusterer::nearestPerScan(const Eigen::Vector2d& centre, const std::vector<bool>& taken) {
  m_tree.within(centre.x(), centre.y(), m_options.mergeDistance, m_hits);
  const auto isTaken = [&](const PointHit& hit) { return taken[hit.index]; };
  m_hits.erase(std::remove_if(m_hits.begin(), m_hits.end(), isTaken), m_hits.end());
  for (const PointHit& hit : m_hits) {
    PointHit& best = m_nearest[m_observations[hit.index].scan];
    if (!best || hit.squaredDistance < best.squaredDistance) best = hit;
  }
  Group group;
  for (const PointHit& hit : m_hits) {
    if (m_nearest[m_observations[hit.index].scan].index == hit.index) group.push_back(hit.index);
  }
  for (const PointHit& hit : m_hits) m_nearest[m_observations[hit.index].scan] = {};
  return group;
}

std::vector<Eigen::Vector2d> Clusterer::observationCentres() const {
  std::vector<Eigen::Vector2d> result;
  result.reserve(m_groups.size());
  for (const Group& group : m_groups) result.push_back(fusedCentre(m_observations, group));
  return result;
}

/// Assigns the observations of each scan to the centres, nearest pair first, until nothing changes.
void Clusterer::assign() {
  std::vector<Group> scans(m_nearest.size());
  for (std::uint32_t i = 0; i < m_observations.size(); ++i)
    scans[m_observations[i].scan].push_back(i);
  for (int round = 0; round < kMostRounds; ++round) {
    const KdTree2D tree(observationCentres());
    std::vector<Group> groups(m_groups.size());
    for (const Group& scan : scans) {
      std::vector<AssignedPair> pairs;  // member of the scan, group
      for (std::size_t i = 0; i < scan.size(); ++i) {
        const Eigen::Vector2d& p = m_tree.point(scan[i]);
        tree.within(p.x(), p.y(), m_options.mergeDistance, m_hits);
        for (const PointHit& hit : m_hits) pairs.push_back({i, hit.index, hit.squaredDistance});
      }
      for (const AssignedPair& pair : chooseClosest(std::move(pairs)))
        groups[pair.second].push_back(scan[pair.first]);
    }
    for (Group& group : groups) std::sort(group.begin(), group.end());
    dropEmpty(groups);
    const bool settled = groups == m_groups;
    m_groups = std::move(groups);
    if (settled) return;
  }
}

/// Merges neighbours, nearest first, each group at most once. Returns whether any were merged.
bool Clusterer::mergeNeighbours() {
  struct Pair {
    double squaredDistance;
    std::uint32_t a, b;
  };
  const KdTree2D tree(observationCentres());
  std::vector<Pair> pairs;
  for (std::uint32_t a = 0; a < m_groups.size(); ++a) {
    const Eigen::Vector2d& p = tree.point(a);
    tree.within(p.x(), p.y(), m_options.mergeDistance, m_hits);
    for (const PointHit& hit : m_hits) {
      if (hit.index > a) pairs.push_back({hit.squaredDistance, a, hit.index});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
    return x.squaredDistance < y.squaredDistance;
  });
  std::vector<bool> merged(m_groups.size(), false);
  bool any = false;
  for (const Pair& pair : pairs) {
    if (merged[pair.a] || merged[pair.b] || areApart(m_groups[pair.a], m_groups[pair.b])) continue;
    m_groups[pair.a] = united(m_groups[pair.a], m_groups[pair.b]);
    m_groups[pair.b].clear();
    merged[pair.a] = merged[pair.b] = any = true;
  }
  dropEmpty(m_groups);
  return any;
}

/// Whether two groups are two poles: scans often saw both.
bool Clusterer::areApart(const Group& a, const Group& b) const {
  std::vector<std::uint32_t> scansOfA, scansOfB, common;
  for (const std::uint32_t i : a) scansOfA.push_back(m_observations[i].scan);
  for (const std::uint32_t i : b) scansOfB.push_back(m_observations[i].scan);
  std::sort(scansOfA.begin(), scansOfA.end());
  std::sort(scansOfB.begin(), scansOfB.end());
  std::set_intersection(scansOfA.begin(), scansOfA.end(), scansOfB.begin(), scansOfB.end(),
                        std::back_inserter(common));
  return static_cast<double>(common.size()) >=
         m_options.apartShare * static_cast<double>(std::max(a.size(), b.size()));
}

/// Union of two groups. A scan with a member in each keeps the member of the larger group; the
/// first group wins ties.
Group Clusterer::united(const Group& a, const Group& b) const {
  const Group &large = a.size() >= b.size() ? a : b, &small = a.size() >= b.size() ? b : a;
  std::vector<std::uint32_t> scans;
  for (const std::uint32_t i : large) scans.push_back(m_observations[i].scan);
  std::sort(scans.begin(), scans.end());
  Group group = large;
  for (const std::uint32_t i : small) {
    if (!std::binary_search(scans.begin(), scans.end(), m_observations[i].scan)) group.push_back(i);
  }
  std::sort(group.begin(), group.end());
  return group;
}

/// Removes members that lie beyond the gate after the last move of a centre.
void Clusterer::prune() {
  for (Group& group : m_groups) {
    for (std::size_t before = 0; before != group.size();) {
      before = group.size();
      const Eigen::Vector2d centre = fusedCentre(m_observations, group);
      const auto isBeyond = [&](std::uint32_t i) {
        return (centreOf(m_observations[i]) - centre).squaredNorm() >= squaredGate();
      };
      group.erase(std::remove_if(group.begin(), group.end(), isBeyond), group.end());
      if (group.empty()) break;
    }
  }
  dropEmpty(m_groups);
}

void Clusterer::sortGroups() {
  const std::vector<Eigen::Vector2d> at = observationCentres();
  std::vector<std::size_t> order(m_groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_tuple(at[a].x(), at[a].y(), m_groups[a][0]) <
           std::make_tuple(at[b].x(), at[b].y(), m_groups[b][0]);
  });
  std::vector<Group> sorted;
  sorted.reserve(m_groups.size());
  for (const std::size_t i : order) sorted.push_back(std::move(m_groups[i]));
  m_groups = std::move(sorted);
}

/// The same sums of coordinates and radii as the boxes are made of, so that rounding decides alike.
bool overlap(const PoleDetection& a, const PoleDetection& b) {
  return a.x - a.radius <= b.x + b.radius && a.x + a.radius >= b.x - b.radius &&
         a.y - a.radius <= b.y + b.radius && a.y + a.radius >= b.y - b.radius;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> clusterObservations(
    const std::vector<LandmarkObservation>& observations, const ClusteringOptions& options) {
  const Group order = canonicalOrder(observations);
  std::vector<LandmarkObservation> ordered;
  ordered.reserve(order.size());
  for (const std::uint32_t i : order) ordered.push_back(observations[i]);
  std::vector<Group> groups = Clusterer(std::move(ordered), options).run();
  for (Group& group : groups) {
    for (std::uint32_t& member : group) member = order[member];
  }
  return groups;
}

std::vector<std::vector<std::uint32_t>> joinOverlappingBoxes(
    const std::vector<LandmarkObservation>& observations) {
  double widest = 0;
  for (const LandmarkObservation& observation : observations)
    widest = std::max(widest, observation.pole.radius);
  const KdTree2D tree(centresOf(observations));
  DisjointSets sets(observations.size());
  std::vector<PointHit> near;
  for (std::uint32_t i = 0; i < observations.size(); ++i) {
    const PoleDetection& pole = observations[i].pole;
    // Corners of boxes that touch are the farthest; the margin is for rounding, and radii of 0.
    const double reach = 1.415 * std::max(0.0, pole.radius + widest) + 1e-6;
    tree.within(pole.x, pole.y, reach, near);
    for (const PointHit& hit : near)
      if (hit.index < i && overlap(observations[hit.index].pole, pole)) sets.join(hit.index, i);
  }
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::size_t> groupOf(observations.size());
  for (std::uint32_t i = 0; i < observations.size(); ++i) {
    const std::size_t root = sets.root(i);
    if (root == i) {
      groupOf[i] = groups.size();
      groups.emplace_back();
    }
    groups[groupOf[root]].push_back(i);
  }
  return groups;
}

MapPole plainMean(const std::vector<LandmarkObservation>& observations,
                  const std::vector<std::uint32_t>& members) {
  std::vector<const PoleDetection*> poles;
  poles.reserve(members.size());
  for (const std::uint32_t member : members) poles.push_back(&observations[member].pole);
  // Sums round by their order: this one does not depend on that of the detections.
  std::sort(poles.begin(), poles.end(), [](const PoleDetection* a, const PoleDetection* b) {
    return std::tie(a->x, a->y, a->radius, a->bottom, a->top, a->confidence) <
           std::tie(b->x, b->y, b->radius, b->bottom, b->top, b->confidence);
  });
  const PoleDetection& first = *poles.front();  // no digits are lost far from the origin
  const double share = 1 / static_cast<double>(poles.size());
  MapPole mean;
  mean.x = first.x;
  mean.y = first.y;
  mean.radius = mean.bottom = mean.top = mean.confidence = 0;
  mean.covariance.setZero();
  for (const PoleDetection* pole : poles) {
    mean.x += share * (pole->x - first.x);
    mean.y += share * (pole->y - first.y);
    mean.radius += share * pole->radius;
    mean.bottom += share * pole->bottom;
    mean.top += share * pole->top;
    mean.confidence += share * pole->confidence;
    mean.covariance += share * share * pole->covariance;
  }
  mean.confidence = std::min(mean.confidence, 1.0);
  mean.count = static_cast<std::uint32_t>(poles.size());
  return mean;
}

}  // namespace polemcl
