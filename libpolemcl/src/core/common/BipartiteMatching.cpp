#include "core/common/BipartiteMatching.h"

#include <limits>
#include <utility>

namespace polemcl {

std::size_t maximumMatching(const std::vector<std::vector<std::uint32_t>>& edges,
                            std::size_t rightCount) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> rightOf(edges.size(), kNone), leftOf(rightCount, kNone);
  std::vector<std::uint32_t> seenFor(rightCount, kNone);  // last search that reached a right node
  std::vector<std::uint32_t> reachedFrom(rightCount);     // the left node before it on its path
  std::vector<bool> exhausted(rightCount, false);         // no free node can be reached from it
  std::size_t matches = 0;
  std::vector<std::uint32_t> queue, seen;

  // Breadth first over alternating paths; returns a free right node.
  const auto search = [&](std::uint32_t start) {
    queue.assign(1, start);
    seen.clear();
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (const std::uint32_t right : edges[queue[head]]) {
        if (exhausted[right] || seenFor[right] == start) continue;
        seenFor[right] = start;
        reachedFrom[right] = queue[head];
        if (leftOf[right] == kNone) return right;
        seen.push_back(right);
        queue.push_back(leftOf[right]);
      }
    }
    for (const std::uint32_t right : seen) exhausted[right] = true;
    return kNone;
  };

  for (std::uint32_t start = 0; start < edges.size(); ++start) {
    std::uint32_t right = search(start);
    if (right == kNone) continue;
    ++matches;
    // Back along the path: each left node takes the right node that it reached.
    while (right != kNone) {
      const std::uint32_t left = reachedFrom[right];
      leftOf[right] = left;
      std::swap(right, rightOf[left]);
    }
  }
  return matches;
}

}  // namespace polemcl
