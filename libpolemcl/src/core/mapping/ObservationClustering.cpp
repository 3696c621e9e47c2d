#include "core/mapping/ObservationClustering.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"

namespace polemcl {
namespace {

using Group = std::vector<std::uint32_t>;

constexpr int s_mostRounds = 10;  ///< dealing and growing settle in two or three

Eigen::Vector2d clusterCentreOf(const LandmarkObservation& sighting) {
  return {sighting.pole.x, sighting.pole.y};
}

void dropEmpty(std::vector<Group>& groups) {
  groups.erase(
      std::remove_if(groups.begin(), groups.end(), [](const Group& g) { return g.empty(); }),
      groups.end());
}

/// Indices of the sightings in an order that depends on what they say only.
Group canonicalOrder(const std::vector<LandmarkObservation>& sightings) {
  Group order(sightings.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const LandmarkObservation& s = sightings[i];
    const Eigen::Matrix2d& c = s.pole.covariance;
    return std::make_tuple(s.pole.x, s.pole.y, s.view, s.pole.confidence, c(0, 0), c(0, 1), c(1, 1),
                           s.pole.radius, s.pole.bottom, s.pole.top);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return order;
}

/// The work on sightings in canonical order.
class Merger {
 public:
  Merger(std::vector<LandmarkObservation> sightings, const ClusteringOptions& options)
      : m_sightings(std::move(sightings)),
        m_options(options),
        m_tree(points()),
        m_views(viewCount()) {}

  std::vector<Group> run() {
    growAll();
    for (int round = 0; round < s_mostRounds; ++round) {
      deal();
      if (!mergeNeighbours()) break;
    }
    prune();
    sortGroups();
    return std::move(m_groups);
  }

 private:
  std::vector<Eigen::Vector2d> points() const {
    std::vector<Eigen::Vector2d> result;
    result.reserve(m_sightings.size());
    for (const LandmarkObservation& sighting : m_sightings)
      result.push_back(clusterCentreOf(sighting));
    return result;
  }
  std::size_t viewCount() const {
    std::size_t count = 0;
    for (const LandmarkObservation& sighting : m_sightings)
      count = std::max<std::size_t>(count, sighting.view + 1);
    return count;
  }
  double squaredGate() const { return m_options.mergeDistance * m_options.mergeDistance; }

  std::vector<double> densities() const;
  void growAll();
  Group grow(std::uint32_t seed, const std::vector<bool>& taken);
  Group nearestPerView(const Eigen::Vector2d& centre, const std::vector<bool>& taken);
  std::vector<Eigen::Vector2d> observationCentres() const;
  void deal();
  bool mergeNeighbours();
  bool areApart(const Group& a, const Group& b) const;
  Group united(const Group& a, const Group& b) const;
  void prune();
  void sortGroups();

  std::vector<LandmarkObservation> m_sightings;
  ClusteringOptions m_options;
  KdTree2D m_tree;
  std::vector<PointHit> m_views;  ///< scratch: the nearest sighting of each view
  std::vector<PointHit> m_hits;   ///< scratch
  std::vector<Group> m_groups;
};

/// How much confidence lies round each sighting, counting less towards the gate.
std::vector<double> Merger::densities() const {
  std::vector<double> density(m_sightings.size());
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < m_sightings.size(); ++i) {
    const Eigen::Vector2d& p = m_tree.point(i);
    m_tree.within(p.x(), p.y(), m_options.mergeDistance, hits);
    for (const PointHit& hit : hits) {
      const double share = 1 - hit.squaredDistance / squaredGate();
      density[i] += m_sightings[hit.index].pole.confidence * share * share;
    }
  }
  return density;
}

void Merger::growAll() {
  const std::vector<double> density = densities();
  Group seeds(m_sightings.size());
  std::iota(seeds.begin(), seeds.end(), 0u);
  std::stable_sort(seeds.begin(), seeds.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return density[a] > density[b]; });
  std::vector<bool> taken(m_sightings.size(), false);
  for (const std::uint32_t seed : seeds) {
    while (!taken[seed]) {  // a centre may move away from its seed
      m_groups.push_back(grow(seed, taken));
      for (const std::uint32_t member : m_groups.back()) taken[member] = true;
    }
  }
}

Group Merger::grow(std::uint32_t seed, const std::vector<bool>& taken) {
  Group group{seed};
  for (int round = 0; round < s_mostRounds; ++round) {
    Group next = nearestPerView(fusedCentre(m_sightings, group), taken);
    if (next.empty() || next == group) break;
    group = std::move(next);
  }
  return group;
}

/// Of each view the nearest sighting inside the gate that no group has taken, by ascending index.
Group Merger::nearestPerView(const Eigen::Vector2d& centre, const std::vector<bool>& taken) {
  m_tree.within(centre.x(), centre.y(), m_options.mergeDistance, m_hits);
  const auto isTaken = [&](const PointHit& hit) { return taken[hit.index]; };
  m_hits.erase(std::remove_if(m_hits.begin(), m_hits.end(), isTaken), m_hits.end());
  for (const PointHit& hit : m_hits) {
    PointHit& best = m_views[m_sightings[hit.index].view];
    if (!best || hit.squaredDistance < best.squaredDistance) best = hit;
  }
  Group group;
  for (const PointHit& hit : m_hits) {
    if (m_views[m_sightings[hit.index].view].index == hit.index) group.push_back(hit.index);
  }
  for (const PointHit& hit : m_hits) m_views[m_sightings[hit.index].view] = {};
  return group;
}

std::vector<Eigen::Vector2d> Merger::observationCentres() const {
  std::vector<Eigen::Vector2d> result;
  result.reserve(m_groups.size());
  for (const Group& group : m_groups) result.push_back(fusedCentre(m_sightings, group));
  return result;
}

/// Deals the sightings of each view out to the centres, nearest pair first, until none moves.
void Merger::deal() {
  std::vector<Group> scans(m_views.size());
  for (std::uint32_t i = 0; i < m_sightings.size(); ++i) scans[m_sightings[i].view].push_back(i);
  for (int round = 0; round < s_mostRounds; ++round) {
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

/// Merges neighbours, nearest first, each group at most once; true if any were.
bool Merger::mergeNeighbours() {
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

/// Two poles, not one: often seen both in one scan.
bool Merger::areApart(const Group& a, const Group& b) const {
  std::vector<std::uint32_t> viewsOfA, viewsOfB, common;
  for (const std::uint32_t i : a) viewsOfA.push_back(m_sightings[i].view);
  for (const std::uint32_t i : b) viewsOfB.push_back(m_sightings[i].view);
  std::sort(viewsOfA.begin(), viewsOfA.end());
  std::sort(viewsOfB.begin(), viewsOfB.end());
  std::set_intersection(viewsOfA.begin(), viewsOfA.end(), viewsOfB.begin(), viewsOfB.end(),
                        std::back_inserter(common));
  return static_cast<double>(common.size()) >=
         m_options.apartShare * static_cast<double>(std::max(a.size(), b.size()));
}

/// Both, but of a view that has one in each only that of the larger (of equals the first).
Group Merger::united(const Group& a, const Group& b) const {
  const Group &large = a.size() >= b.size() ? a : b, &small = a.size() >= b.size() ? b : a;
  std::vector<std::uint32_t> views;
  for (const std::uint32_t i : large) views.push_back(m_sightings[i].view);
  std::sort(views.begin(), views.end());
  Group group = large;
  for (const std::uint32_t i : small) {
    if (!std::binary_search(views.begin(), views.end(), m_sightings[i].view)) group.push_back(i);
  }
  std::sort(group.begin(), group.end());
  return group;
}

/// Leaves out members that the last move of a centre left beyond the gate.
void Merger::prune() {
  for (Group& group : m_groups) {
    for (std::size_t before = 0; before != group.size();) {
      before = group.size();
      const Eigen::Vector2d centre = fusedCentre(m_sightings, group);
      const auto isBeyond = [&](std::uint32_t i) {
        return (clusterCentreOf(m_sightings[i]) - centre).squaredNorm() >= squaredGate();
      };
      group.erase(std::remove_if(group.begin(), group.end(), isBeyond), group.end());
      if (group.empty()) break;
    }
  }
  dropEmpty(m_groups);
}

void Merger::sortGroups() {
  const std::vector<Eigen::Vector2d> at = observationCentres();
  std::vector<std::size_t> order(m_groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_tuple(at[a].x(), at[a].y(), m_groups[a][0]) <
           std::make_tuple(at[b].x(), at[b].y(), m_groups[b][0]);
  });
  std::vector<Group> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(m_groups[i]));
  m_groups = std::move(sorted);
}

}  // namespace

std::vector<std::vector<std::uint32_t>> clusterObservations(
    const std::vector<LandmarkObservation>& sightings, const ClusteringOptions& options) {
  const Group order = canonicalOrder(sightings);
  std::vector<LandmarkObservation> ordered;
  ordered.reserve(order.size());
  for (const std::uint32_t i : order) ordered.push_back(sightings[i]);
  std::vector<Group> groups = Merger(std::move(ordered), options).run();
  for (Group& group : groups) {
    for (std::uint32_t& member : group) member = order[member];
  }
  return groups;
}

}  // namespace polemcl
