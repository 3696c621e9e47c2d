#include "core/common/BipartiteMatching.h"

#include <limits>

namespace polemcl {
namespace {

constexpr std::uint32_t s_free = std::numeric_limits<std::uint32_t>::max();

class HopcroftKarp {
 public:
  HopcroftKarp(const std::vector<std::vector<std::uint32_t>>& edges, std::size_t rightCount)
      : m_edges(edges),
        m_partnerOfLeft(edges.size(), s_free),
        m_partnerOfRight(rightCount, s_free) {}

  std::size_t run() {
    std::size_t matches = 0;
    while (layer()) {
      m_next.assign(m_edges.size(), 0);
      for (std::uint32_t left = 0; left < m_edges.size(); ++left) {
        if (m_partnerOfLeft[left] == s_free && augment(left)) ++matches;
      }
    }
    return matches;
  }

 private:
  /// Breadth first from all free left nodes; true if some free right node can be reached.
  bool layer() {
    m_layer.assign(m_edges.size(), s_free);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t left = 0; left < m_edges.size(); ++left) {
      if (m_partnerOfLeft[left] != s_free) continue;
      m_layer[left] = 0;
      queue.push_back(left);
    }
    bool reached = false;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (const std::uint32_t right : m_edges[queue[head]]) {
        const std::uint32_t next = m_partnerOfRight[right];
        if (next == s_free) {
          reached = true;
        } else if (m_layer[next] == s_free) {
          m_layer[next] = m_layer[queue[head]] + 1;
          queue.push_back(next);
        }
      }
    }
    return reached;
  }

  /// Depth first down the layers, with a stack of its own: paths can be as long as the graph.
  bool augment(std::uint32_t start) {
    std::vector<std::uint32_t> path{start};
    while (!path.empty()) {
      const std::uint32_t left = path.back();
      if (m_next[left] == m_edges[left].size()) {
        path.pop_back();
        continue;
      }
      const std::uint32_t next = m_partnerOfRight[m_edges[left][m_next[left]++]];
      if (next == s_free) {
        flip(path);
        return true;
      }
      if (m_layer[next] == m_layer[left] + 1) path.push_back(next);
    }
    return false;
  }

  /// Each left node of the path takes the right node it looked at last.
  void flip(const std::vector<std::uint32_t>& path) {
    for (const std::uint32_t left : path) {
      const std::uint32_t right = m_edges[left][m_next[left] - 1];
      m_partnerOfLeft[left] = right;
      m_partnerOfRight[right] = left;
    }
  }

  const std::vector<std::vector<std::uint32_t>>& m_edges;
  std::vector<std::uint32_t> m_partnerOfLeft, m_partnerOfRight;
  std::vector<std::uint32_t> m_layer;  ///< of left nodes
  std::vector<std::size_t> m_next;     ///< first edge of each left node not looked at in this phase
};

}  // namespace

std::size_t maximumMatching(const std::vector<std::vector<std::uint32_t>>& edges,
                            std::size_t rightCount) {
  return HopcroftKarp(edges, rightCount).run();
}

}  // namespace polemcl
