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

std::uint32_t nearestTipKernel(const TipBlock* blocks, const std::uint32_t* lower,
                               const std::uint32_t* upper, const TipQuery& query) {
  const Tips d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tips()));
  constexpr int kVectors = 4 * TipBlock::kSlots / kLanes;
  std::uint32_t at[4] = {lower[0], lower[1], upper[0], upper[1]};
  if ((at[0] | at[1] | at[2] | at[3]) == 0) return kNoCluster;
  std::uint32_t best = kNoCluster;
  float reach = query.squaredReach;
  do {
    TipVector found[kVectors];
    for (int i = 0; i < kVectors; ++i)
      found[i] = distances(blocks[at[i * kLanes / TipBlock::kSlots]], i * kLanes % TipBlock::kSlots,
                           query);
    TipVector least = found[0];
    for (int i = 1; i < kVectors; ++i) least = hn::Min(least, found[i]);
    const float nearest = hn::GetLane(hn::MinOfLanes(d, least));
    if (nearest <= reach) {
      if (nearest < reach) best = kNoCluster;
      reach = nearest;
      std::uint32_t bits = 0;
      for (int i = 0; i < kVectors; ++i)
        bits |= maskBits(d, hn::Eq(found[i], hn::Set(d, nearest))) << (i * kLanes);
      for (; bits != 0; bits &= bits - 1) {
        const auto tip = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
        best = std::min(best, blocks[at[tip / TipBlock::kSlots]].cluster[tip % TipBlock::kSlots]);
      }
    }
    for (std::uint32_t& block : at) block = blocks[block].next;
  } while ((at[0] | at[1] | at[2] | at[3]) != 0);
  return best;
}

}  // namespace HWY_NAMESPACE
}  // namespace polemcl
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace polemcl {
HWY_EXPORT(nearestTipKernel);

NearestTip nearestTip() {
  return HWY_DYNAMIC_DISPATCH(nearestTipKernel);
}
}  // namespace polemcl
#endif
