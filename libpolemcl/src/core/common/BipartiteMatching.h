#pragma once
/// \file BipartiteMatching.h
/// \brief Maximum matching in a sparse bipartite graph (augmenting paths, Kuhn 1955).

#include <cstddef>
#include <cstdint>
#include <vector>

namespace polemcl {

/// \brief Size of the largest set of edges of which no two share an end. O(edges · matches).
/// \param edges edges[l] lists the right nodes that left node l may take, each in [0, rightCount).
std::size_t maximumMatching(const std::vector<std::vector<std::uint32_t>>& edges,
                            std::size_t rightCount);

}  // namespace polemcl
