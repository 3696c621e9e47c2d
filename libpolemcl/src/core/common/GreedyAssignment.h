#pragma once
/// \file GreedyAssignment.h
/// \brief One-to-one assignment between two sets, the closest pairs first.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

namespace polemcl {

/// \brief An element of one set and an element of another that may be the same thing.
struct AssignedPair {
  std::size_t first = 0, second = 0;  ///< indices into the two sets
  double distance = 0;                ///< greedyAssignment(): m; else in the caller's own measure
  /// \brief Closer pairs come first; pairs of equal distance come by their indices.
  bool operator<(const AssignedPair& other) const {
    return std::tie(distance, first, second) < std::tie(other.distance, other.first, other.second);
  }
};

/// \brief Chooses the least candidate by operator<, then the least whose two ends are both free,
/// and so on. \tparam Pair AssignedPair, or a type with `first`, `second` and operator<.
/// \return The chosen pairs in ascending order.
template <class Pair>
std::vector<Pair> chooseClosest(std::vector<Pair> candidates) {
  std::sort(candidates.begin(), candidates.end());
  std::size_t firstSize = 0, secondSize = 0;
  for (const Pair& pair : candidates) {
    firstSize = std::max<std::size_t>(firstSize, pair.first + 1);
    secondSize = std::max<std::size_t>(secondSize, pair.second + 1);
  }
  std::vector<bool> firstTaken(firstSize), secondTaken(secondSize);
  std::vector<Pair> chosen;
  for (const Pair& pair : candidates) {
    if (firstTaken[pair.first] || secondTaken[pair.second]) continue;
    firstTaken[pair.first] = secondTaken[pair.second] = true;
    chosen.push_back(pair);
  }
  return chosen;
}

/// \brief All pairs of points of two sets within the radius (inclusive), by `first`, then `second`.
/// \throws Error when a point is not finite, or the radius is not finite and positive.
std::vector<AssignedPair> pairsWithin(const std::vector<Eigen::Vector2d>& first,
                                      const std::vector<Eigen::Vector2d>& second, double radius);

/// \brief Pairs points of two sets, each point at most once. The closest pair within the radius
/// (inclusive) is chosen first, then the closest of the rest. Lower indices win ties.
/// maximumMatching() gives up close pairs to get more pairs; this function never does.
/// \return Pairs by ascending `first`.
/// \throws Error as pairsWithin().
std::vector<AssignedPair> greedyAssignment(const std::vector<Eigen::Vector2d>& first,
                                           const std::vector<Eigen::Vector2d>& second,
                                           double radius);

}  // namespace polemcl
