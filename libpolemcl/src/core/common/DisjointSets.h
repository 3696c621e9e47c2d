#pragma once
/// \file DisjointSets.h
/// \brief Numbers that are joined to sets (union-find). Private to the library.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace polemcl {

/// \brief At first each number is a set of its own. The root of a set is its lowest number.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : m_parents(count) {
    std::iota(m_parents.begin(), m_parents.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (m_parents[i] != i) i = m_parents[i] = m_parents[m_parents[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    m_parents[high] = low;
  }

 private:
  std::vector<std::size_t> m_parents;
};

}  // namespace polemcl
