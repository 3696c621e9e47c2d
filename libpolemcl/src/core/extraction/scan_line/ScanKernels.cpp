#include "core/extraction/scan_line/ScanKernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/extraction/scan_line/ScanKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace polemcl {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kPi = 3.14159265358979f;

/// atan2 by a polynomial in the smaller over the larger coordinate; error below 3e-7 rad.
template <class D, class V = hn::Vec<D>>
V arcTangent(D d, V y, V x) {
  const V ax = hn::Abs(x), ay = hn::Abs(y);
  const V larger = hn::Max(ax, ay), smaller = hn::Min(ax, ay);
  const V t = hn::Div(smaller, larger), s = hn::Mul(t, t);
  V p = hn::Set(d, -0.00405456518f);
  for (const float c : {0.0218629554f, -0.0559123327f, 0.0964219874f, -0.139086307f, 0.19946566f,
                        -0.333298608f, 0.999999336f})
    p = hn::Add(hn::Mul(p, s), hn::Set(d, c));
  p = hn::Mul(p, t);
  p = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, kPi / 2), p), p);
  p = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, kPi), p), p);
  return hn::CopySign(p, y);
}

/// The lanes of a mask as bits. (Highway 1.0's CompressStore copies a table of 1 kB at each call.)
template <class D>
std::uint32_t maskBits(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

/// Appends from + k for every bit k that is set. Writes up to 8 numbers more.
inline std::size_t appendSet(std::uint32_t bits, std::uint32_t from, std::uint32_t* to) {
  const hn::CappedTag<std::uint32_t, 8> d;
  std::size_t n = 0;
  for (; bits != 0; bits >>= 8, from += 8) {
    const std::uint8_t* set = kSetBits.of[bits & 255];
    for (std::size_t k = 0; k < 8; k += hn::Lanes(d))
      hn::StoreU(
          hn::Add(hn::PromoteTo(d, hn::LoadU(hn::Rebind<std::uint8_t, decltype(d)>(), set + k)),
                  hn::Set(d, from)),
          d, to + n + k);
    n += hwy::PopCount(bits & 255);
  }
  return n;
}

/// Points side by side that wait to be classified together.
struct KeptPoints {
  using D = hn::CappedTag<float, 8>;
  static constexpr std::size_t kRoom = 512;

  /// Appends those of a vector of points, the first of which is number `from`, whose bit is set.
  HWY_INLINE void append(std::uint32_t bits, hn::Vec<D> vx, hn::Vec<D> vy, hn::Vec<D> vz,
                         std::size_t from) {
    const D d;
    const hn::RebindToSigned<D> di;
    const auto lane =
        hn::PromoteTo(di, hn::LoadU(hn::Rebind<std::uint8_t, D>(), kSetBits.of[bits]));
    const auto lanes = hn::IndicesFromVec(d, lane);
    hn::StoreU(hn::TableLookupLanes(vx, lanes), d, x + count);
    hn::StoreU(hn::TableLookupLanes(vy, lanes), d, y + count);
    hn::StoreU(hn::TableLookupLanes(vz, lanes), d, z + count);
    hn::StoreU(hn::Add(lane, hn::Set(di, static_cast<std::int32_t>(from))), di, point + count);
    count += hwy::PopCount(bits);
  }

  std::size_t count = 0;
  float x[kRoom + kKernelPadding], y[kRoom + kKernelPadding], z[kRoom + kKernelPadding];
  std::int32_t point[kRoom + kKernelPadding];
};

/// Makes returns of points. Two vectors at a time, as one would wait for its own results.
class Classifier {
 public:
  using D = hn::ScalableTag<float>;
  using V = hn::Vec<D>;
  using VI = hn::Vec<hn::RebindToSigned<D>>;
  static constexpr std::size_t kMostLanes = HWY_MAX_BYTES / sizeof(float);

  Classifier(const RingLookup& lookup, int rows, const ReturnStreams& out)
      : m_lookup(lookup), m_rows(rows), m_out(out) {}

  void operator()(const KeptPoints& points) const {
    const std::size_t lanes = hn::Lanes(D());
    std::size_t i = 0;
    for (; i + 2 * lanes <= points.count; i += 2 * lanes) {
      const Returns a = classify(points, i), b = classify(points, i + lanes);
      write(a, lanes);
      write(b, lanes);
    }
    for (; i < points.count; i += lanes)
      write(classify(points, i), std::min(lanes, points.count - i));
  }

 private:
  struct Returns {
    V azimuth, rho, z, point;
    VI stream;
  };

  HWY_INLINE Returns classify(const KeptPoints& points, std::size_t i) const {
    const D d;
    const hn::RebindToSigned<D> di;
    const V x = hn::LoadU(d, points.x + i), y = hn::LoadU(d, points.y + i),
            z = hn::LoadU(d, points.z + i);
    const V rho = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
    const V azimuth = arcTangent(d, y, x);
    const VI row = m_lookup.planes ? rowOfPlane(d, x, y, z) : rowOf(d, rho, z);
    const auto ahead = hn::VecFromMask(di, hn::RebindMask(di, hn::Ge(azimuth, hn::Zero(d))));
    const VI stream = hn::Min(hn::Sub(hn::Add(row, row), ahead), hn::Set(di, 2 * m_rows));
    return {azimuth, rho, z, hn::BitCast(d, hn::LoadU(di, points.point + i)), stream};
  }

  HWY_INLINE void write(const Returns& r, std::size_t count) const {
    const D d;
    const hn::RebindToSigned<D> di;
    const auto first = static_cast<std::size_t>(hn::GetLane(r.stream));
    const std::uint32_t next = m_out.next[first];
    // Neighbours in the cloud mostly are of one beam.
    if (count == hn::Lanes(d) && next + count <= m_out.end[first] &&
        hn::AllTrue(di, hn::Eq(r.stream, hn::Set(di, hn::GetLane(r.stream))))) {
      hn::StoreInterleaved4(r.azimuth, r.rho, r.z, r.point, d, &m_out.returns[next].azimuth);
      m_out.next[first] = next + static_cast<std::uint32_t>(count);
      return;
    }
    HWY_ALIGN std::int32_t stream[kMostLanes];
    HWY_ALIGN Return returns[kMostLanes];
    hn::Store(r.stream, di, stream);
    hn::StoreInterleaved4(r.azimuth, r.rho, r.z, r.point, d, &returns[0].azimuth);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t to = m_out.next[stream[k]]++;
      if (to < m_out.end[stream[k]]) m_out.returns[to] = returns[k];
    }
  }

  /// Row of every point; the number of rows for those out of view.
  HWY_INLINE VI rowOf(D d, V rho, V z) const {
    const hn::RebindToSigned<D> di;
    const auto lower = hn::Lt(z, hn::Add(hn::Mul(rho, hn::Set(d, m_lookup.splitSlope)),
                                         hn::Set(d, m_lookup.splitOffset)));
    const auto pick = [&](const float* of) {
      return hn::IfThenElse(lower, hn::Set(d, of[1]), hn::Set(d, of[0]));
    };
    const auto slope = hn::Div(hn::Sub(z, pick(m_lookup.offset)), rho);
    const auto cell =
        hn::Mul(hn::Sub(slope, pick(m_lookup.minSlope)), hn::Set(d, m_lookup.cellsPerSlope));
    const auto inView = hn::And(hn::Ge(cell, hn::Zero(d)), hn::Lt(cell, pick(m_lookup.cells)));
    const auto base = hn::IfThenElse(hn::RebindMask(di, lower), hn::Set(di, m_lookup.base[1]),
                                     hn::Set(di, m_lookup.base[0]));
    const auto index = hn::Add(hn::ConvertTo(di, hn::IfThenElseZero(inView, cell)), base);
    return hn::IfThenElse(hn::RebindMask(di, inView),
                          hn::GatherIndex(di, m_lookup.row.data(), index), hn::Set(di, m_rows));
  }

  /// The same for a depth camera.
  VI rowOfPlane(D d, V x, V y, V z) const {
    const hn::RebindToSigned<D> di;
    const auto along = [&](const float* axis) {
      return hn::Add(hn::Add(hn::Mul(x, hn::Set(d, axis[0])), hn::Mul(y, hn::Set(d, axis[1]))),
                     hn::Mul(z, hn::Set(d, axis[2])));
    };
    const auto ahead = along(m_lookup.ahead);
    const auto slope = hn::Div(along(m_lookup.up), ahead);
    const auto cell = hn::Mul(hn::Sub(slope, hn::Set(d, m_lookup.minSlope[0])),
                              hn::Set(d, m_lookup.cellsPerSlope));
    const auto inView =
        hn::And(hn::Gt(ahead, hn::Zero(d)),
                hn::And(hn::Ge(cell, hn::Zero(d)), hn::Lt(cell, hn::Set(d, m_lookup.cells[0]))));
    const auto fromBottom = hn::ConvertTo(di, hn::IfThenElseZero(inView, cell));
    return hn::IfThenElse(hn::RebindMask(di, inView), hn::Sub(hn::Set(di, m_rows - 1), fromBottom),
                          hn::Set(di, m_rows));
  }

  const RingLookup& m_lookup;
  int m_rows;
  ReturnStreams m_out;
};

void classifyPoints(const PointsView& points, const std::uint16_t* cell, const float* level,
                    const float* limit, const RingLookup& lookup, int rows,
                    const ReturnStreams& out) {
  const KeptPoints::D d;
  const hn::RebindToSigned<KeptPoints::D> di;
  const hn::Rebind<std::uint16_t, KeptPoints::D> d16;
  const std::size_t lanes = hn::Lanes(d);
  const Classifier classify(lookup, rows, out);
  KeptPoints kept = {};
  const auto look = [&](const PointsView& some, const float* levels, std::size_t from) {
    const auto c = hn::PromoteTo(di, hn::LoadU(d16, cell + from));
    const std::uint32_t bits =
        maskBits(d, hn::Ge(hn::LoadU(d, levels), hn::GatherIndex(d, limit, c)));
    if (bits == 0) return;  // most often
    kept.append(bits, hn::LoadU(d, some.x), hn::LoadU(d, some.y), hn::LoadU(d, some.z), from);
    if (kept.count < KeptPoints::kRoom) return;
    classify(kept);
    kept.count = 0;
  };
  std::size_t i = 0;
  for (; i + lanes <= points.size; i += lanes)
    look({points.x + i, points.y + i, points.z + i, lanes}, level + i, i);
  if (i < points.size) {
    // Points that are left over; the lanes behind them are of no cell.
    HWY_ALIGN float x[8] = {}, y[8] = {}, z[8] = {}, levels[8] = {};
    std::copy(points.x + i, points.x + points.size, x);
    std::copy(points.y + i, points.y + points.size, y);
    std::copy(points.z + i, points.z + points.size, z);
    std::copy(level + i, level + points.size, levels);
    look({x, y, z, lanes}, levels, i);
  }
  classify(kept);
}

std::size_t findDisorder(const Return* returns, std::size_t count, std::size_t from) {
  const hn::ScalableTag<float> d;
  const std::size_t some = std::max<std::size_t>(1, hn::Lanes(d) / 4);
  std::size_t i = from;
  for (; i + some < count; i += some) {
    // Whole returns are compared, of which every fourth lane, the azimuth, counts.
    const auto before =
        hn::Lt(hn::LoadU(d, &returns[i].azimuth), hn::LoadU(d, &returns[i + 1].azimuth));
    const std::uint32_t bits = maskBits(d, hn::Not(before)) & 0x11111111u;
    if (bits != 0) return i + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits) / 4;
  }
  for (; i + 1 < count; ++i)
    if (!(returns[i].azimuth < returns[i + 1].azimuth)) return i;
  return count;
}

/// What is beside a run's end, from its next two neighbours outwards: a mixed pixel may stand
/// between the edge and what lies behind it.
template <class D>
class SideFinder {
 public:
  using V = hn::Vec<D>;
  using VI = hn::Vec<hn::RebindToSigned<D>>;
  SideFinder(float step, float gap, float edge) : m_step(-step), m_gap(gap), m_edge(edge) {}

  HWY_INLINE VI operator()(V azimuth, V rho, V azimuth1, V rho1, V azimuth2, V rho2) const {
    const hn::RebindToSigned<D> di;
    const VI next = beside(hn::Sub(azimuth2, azimuth1), hn::Sub(rho2, rho));
    const VI first = beside(hn::Sub(azimuth1, azimuth), hn::Sub(rho1, rho));
    return hn::IfThenElse(hn::Eq(first, hn::Set(di, kAttached)), next, first);
  }

 private:
  static constexpr std::int32_t kFree = 0, kAttached = 1, kOccluded = 2;  // as Side
  HWY_INLINE VI beside(V turn, V behind) const {
    const D d;
    const hn::RebindToSigned<D> di;
    const auto free =
        hn::Or(hn::Gt(hn::Abs(turn), hn::Set(d, m_gap)), hn::Gt(behind, hn::Set(d, m_edge)));
    const auto before = hn::Lt(behind, hn::Set(d, m_step));
    const VI side =
        hn::IfThenElse(hn::RebindMask(di, before), hn::Set(di, kOccluded), hn::Set(di, kAttached));
    return hn::IfThenElse(hn::RebindMask(di, free), hn::Set(di, kFree), side);
  }
  float m_step, m_gap, m_edge;
};

std::size_t findEdges(const Return* returns, std::size_t count, float step, float gap, float edge,
                      const RowEdges& out) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::Vec<decltype(d)> azimuth, rho, z, point;
    hn::LoadInterleaved4(d, &returns[i].azimuth, azimuth, rho, z, point);
    hn::StoreU(azimuth, d, out.azimuth + i);
    hn::StoreU(rho, d, out.rho + i);
  }
  for (; i < count; ++i) {
    out.azimuth[i] = returns[i].azimuth;
    out.rho[i] = returns[i].rho;
  }
  // Before the first and behind the last return stands anything: its results are not used.
  const SideFinder<decltype(d)> side(step, gap, edge);
  std::size_t found = 0;
  std::uint32_t breaks = 0;
  for (i = 0; i + 1 < count; i += lanes) {
    const auto load = [&](const float* from) { return hn::LoadU(d, from); };
    const float *a = out.azimuth + i, *r = out.rho + i;
    const auto azimuth = load(a), rho = load(r), azimuth1 = load(a + 1), rho1 = load(r + 1);
    const auto turn = hn::Sub(azimuth1, azimuth);
    const auto near = hn::Lt(hn::Abs(hn::Sub(rho1, rho)), hn::Set(d, step));
    const auto bridged =
        hn::And(hn::Lt(turn, hn::Set(d, 2 * gap)), hn::Lt(hn::Mul(turn, rho), hn::Set(d, kBridge)));
    const auto same = hn::And(near, hn::Or(hn::Lt(turn, hn::Set(d, gap)), bridged));
    const bool brokenBefore = (breaks >> (lanes - 1) & 1) != 0;
    breaks = maskBits(d, hn::Not(same));
    if (breaks == 0 && !brokenBefore) continue;
    const auto left = side(azimuth, rho, azimuth1, rho1, load(a + 2), load(r + 2));
    const auto right = side(azimuth, rho, load(a - 1), load(r - 1), load(a - 2), load(r - 2));
    hn::StoreU(hn::Add(left, hn::ShiftLeft<2>(right)), di, out.sides + i);
    if (count - 1 - i < lanes) breaks &= (1u << (count - 1 - i)) - 1;
    found += appendSet(breaks, static_cast<std::uint32_t>(i), out.breaks + found);
  }
  return found;
}

using Tips = hn::CappedTag<float, TipBlock::kSlots>;
using TipVector = hn::Vec<Tips>;

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
HWY_EXPORT(classifyPoints);
HWY_EXPORT(findDisorder);
HWY_EXPORT(findEdges);
HWY_EXPORT(findNearestTips);

void classifyPoints(const PointsView& points, const std::uint16_t* cell, const float* level,
                    const float* limit, const RingLookup& lookup, int rows,
                    const ReturnStreams& out) {
  HWY_DYNAMIC_DISPATCH(classifyPoints)(points, cell, level, limit, lookup, rows, out);
}

std::size_t findDisorder(const Return* returns, std::size_t count, std::size_t from) {
  return HWY_DYNAMIC_DISPATCH(findDisorder)(returns, count, from);
}

std::size_t findEdges(const Return* returns, std::size_t count, float step, float gap, float edge,
                      const RowEdges& out) {
  return HWY_DYNAMIC_DISPATCH(findEdges)(returns, count, step, gap, edge, out);
}

void findNearestTips(const TipGrid& grid, const TipQuery* queries, std::size_t count,
                     std::uint32_t* clusters) {
  HWY_DYNAMIC_DISPATCH(findNearestTips)(grid, queries, count, clusters);
}
}  // namespace polemcl
#endif
