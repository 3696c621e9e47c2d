#include "core/extraction/scan_line/TipBlocks.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/extraction/scan_line/TipBlocks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace polemcl {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tips = hn::CappedTag<float, TipBlock::kSlots>;
using TipVector = hn::Vec<Tips>;

template <class D>
std::uint32_t maskBits(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}

/// Squared distances of the tips of a block; infinite for those that cannot be joined.
HWY_INLINE TipVector distances(const TipBlock& tips, int from, const TipQuery& query) {
  const Tips d;
  const hn::RebindToSigned<Tips> di;
  const auto dx = hn::Sub(hn::LoadU(d, tips.x + from), hn::Set(d, query.x));
  const auto dy = hn::Sub(hn::LoadU(d, tips.y + from), hn::Set(d, query.y));
  const auto above = hn::Sub(hn::LoadU(d, tips.z + from), hn::Set(d, query.z));
  const auto sameRow = hn::Eq(hn::LoadU(di, tips.row + from), hn::Set(di, query.row));
  const auto barred = hn::Or(hn::Gt(above, hn::Set(d, query.gap)), hn::RebindMask(d, sameRow));
  return hn::IfThenElse(barred, hn::Set(d, std::numeric_limits<float>::infinity()),
                        hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)));
}

/// No branch depends on whether there is a tip, which could not be foreseen.
HWY_INLINE std::uint32_t nearestTip(const TipGrid& grid, const TipQuery& query) {
  const Tips d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tips()));
  constexpr int kAll = 4 * TipBlock::kSlots, kVectors = kAll / kLanes;
  const std::uint32_t *lower = grid.first + query.corner, *upper = lower + grid.cells;
  std::uint32_t at[5] = {lower[0], lower[1], upper[0], upper[1], 0};
  std::uint32_t best = kNoCluster;
  float reach = grid.squaredReach;
  do {
    TipVector found[kVectors];
    for (int i = 0; i < kVectors; ++i)
      found[i] = distances(grid.blocks[at[i * kLanes / TipBlock::kSlots]],
                           i * kLanes % TipBlock::kSlots, query);
    TipVector least = found[0];
    for (int i = 1; i < kVectors; ++i) least = hn::Min(least, found[i]);
    const TipVector all = hn::MinOfLanes(d, least);
    const float nearest = hn::GetLane(all);
    std::uint32_t bits = 0;
    for (int i = 0; i < kVectors; ++i) bits |= maskBits(d, hn::Eq(found[i], all)) << (i * kLanes);
    bits &= nearest <= reach ? ~0u : 0u;
    best = nearest < reach ? kNoCluster : best;
    do {
      const auto tip = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits | 1u << kAll);  // the last is empty
      best =
          std::min(best, grid.blocks[at[tip / TipBlock::kSlots]].cluster[tip % TipBlock::kSlots]);
      bits &= bits - 1;
    } while (bits != 0);
    reach = std::min(reach, nearest);
    for (std::uint32_t& block : at) block = grid.blocks[block].next;
  } while ((at[0] | at[1] | at[2] | at[3]) != 0);
  return best;
}

void findNearestTips(const TipGrid& grid, const TipQuery* queries, std::size_t count,
                     std::uint32_t* clusters) {
  for (std::size_t i = 0; i < count; ++i) clusters[i] = nearestTip(grid, queries[i]);
}

}  // namespace HWY_NAMESPACE
}  // namespace polemcl
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace polemcl {
HWY_EXPORT(findNearestTips);

void findNearestTips(const TipGrid& grid, const TipQuery* queries, std::size_t count,
                     std::uint32_t* clusters) {
  HWY_DYNAMIC_DISPATCH(findNearestTips)(grid, queries, count, clusters);
}
}  // namespace polemcl
#endif
