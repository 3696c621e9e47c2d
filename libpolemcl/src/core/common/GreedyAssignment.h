#pragma once
/// \file GreedyAssignment.h
/// \brief Which point of one set is which of another: one to one, the closest pairs first.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace polemcl {

/// \brief Two points taken for the same thing.
struct AssignedPair {
  std::size_t first = 0, second = 0;  ///< indices into the two sets
  double distance = 0;                ///< m
};

/// \brief Pairs points of two sets, each at most once: of all pairs within the radius (inclusive)
/// the closest is taken, then the closest of what is left. Of equal distances, the lower indices.
/// Unlike maximumMatching() it never gives up a close pair for the sake of more pairs, so that the
/// distances mean something. \return Pairs by ascending `first`.
/// \throws Error when a point is not finite, or the radius is not finite and positive.
std::vector<AssignedPair> greedyAssignment(const std::vector<Eigen::Vector2d>& first,
                                           const std::vector<Eigen::Vector2d>& second,
                                           double radius);

}  // namespace polemcl
