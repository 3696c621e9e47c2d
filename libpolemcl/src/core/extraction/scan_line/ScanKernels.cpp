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

/// Appends from + k for every bit k below `lanes` that is set, without branches.
inline std::size_t appendSet(std::uint32_t bits, std::size_t lanes, std::uint32_t from,
                             std::uint32_t* to) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < lanes; ++k) {
    to[n] = from + static_cast<std::uint32_t>(k);
    n += bits >> k & 1;
  }
  return n;
}

/// table[index] of every lane. Neighbours in a cloud mostly share a cell: one load is then enough.
template <class D, class VI>
HWY_INLINE hn::Vec<D> lookUp(D d, const float* table, VI index) {
  const hn::RebindToSigned<D> di;
  const auto first = hn::GetLane(index);
  if (hn::AllTrue(di, hn::Eq(index, hn::Set(di, first)))) return hn::Set(d, table[first]);
  return hn::GatherIndex(d, table, index);
}

/// Finds cells and lowest points a vector at a time.
class Collector {
  using D = hn::ScalableTag<float>;
  using DI = hn::RebindToSigned<D>;
  using V = hn::Vec<D>;
  using VI = hn::Vec<DI>;

 public:
  Collector(float minRange, float maxRange, const LowestPoints& out)
      : m_minRange(minRange), m_maxRange(maxRange), m_out(out) {}

  /// Every `step`th vector of the points; those whose number is a multiple of `skip` left out.
  void collect(const PointsView& points, std::size_t step, std::size_t skip) {
    const std::size_t lanes = hn::Lanes(m_d);
    Sums sums = noSums();
    std::size_t vectors = 0;
    for (std::size_t v = 0, i = 0; i + lanes <= points.size; v += step, i = v * lanes) {
      if (skip != 0 && v % skip == 0) continue;
      collectVector(points.x + i, points.y + i, points.z + i, i, sums);
      ++vectors;
    }
    add(sums, vectors * lanes);
  }

  /// The points left over by whole vectors, with zeros behind them, which count for nothing.
  void collectTail(const PointsView& points) {
    const std::size_t rest = points.size % hn::Lanes(m_d), from = points.size - rest;
    if (rest == 0) return;
    HWY_ALIGN float x[HWY_MAX_BYTES / 4] = {}, y[HWY_MAX_BYTES / 4] = {}, z[HWY_MAX_BYTES / 4] = {};
    std::memcpy(x, points.x + from, rest * sizeof(float));
    std::memcpy(y, points.y + from, rest * sizeof(float));
    std::memcpy(z, points.z + from, rest * sizeof(float));
    Sums sums = noSums();
    collectVector(x, y, z, from, sums);
    add(sums, rest);
  }

  const GroundGrid::Counts& counts() const { return m_counts; }

 private:
  /// Numbers of points, per lane.
  struct Sums {
    VI valid, inRange;
  };
  Sums noSums() const { return {hn::Zero(m_di), hn::Zero(m_di)}; }
  void add(const Sums& sums, std::size_t points) {
    const auto valid = static_cast<std::size_t>(hn::GetLane(hn::SumOfLanes(m_di, sums.valid)));
    m_counts.invalid += points - valid;
    m_counts.outOfRange +=
        valid - static_cast<std::size_t>(hn::GetLane(hn::SumOfLanes(m_di, sums.inRange)));
  }

  HWY_INLINE void collectVector(const float* x, const float* y, const float* z, std::size_t at,
                                Sums& sums) const {
    const V vx = hn::LoadU(m_d, x), vy = hn::LoadU(m_d, y), vz = hn::LoadU(m_d, z);
    const V rho = hn::Sqrt(hn::Add(hn::Mul(vx, vx), hn::Mul(vy, vy)));
    // False for what is not a number; and zeros are what sensors give for no return.
    const V size = hn::Add(rho, hn::Abs(vz));
    const auto valid = hn::And(hn::Gt(size, hn::Zero(m_d)),
                               hn::Le(size, hn::Set(m_d, std::numeric_limits<float>::max())));
    const auto inRange = hn::And(valid, hn::And(hn::Ge(rho, hn::Set(m_d, m_minRange)),
                                                hn::Le(rho, hn::Set(m_d, m_maxRange))));
    sums.valid = hn::Sub(sums.valid, hn::VecFromMask(m_di, hn::RebindMask(m_di, valid)));
    sums.inRange = hn::Sub(sums.inRange, hn::VecFromMask(m_di, hn::RebindMask(m_di, inRange)));
    const auto cell = hn::IfThenElse(hn::RebindMask(m_di, inRange), groundCell(vx, vy, rho),
                                     hn::Set(m_di, GroundGrid::kNoCell));
    const hn::Rebind<std::uint16_t, D> d16;
    hn::StoreU(hn::DemoteTo(d16, cell), d16, m_out.cell + at);
    const auto low = hn::Lt(vz, hn::GatherIndex(m_d, m_out.second, cell));
    for (std::uint32_t bits = maskBits(m_d, low); bits != 0; bits &= bits - 1)
      enterLowest(m_out.cell[at + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)],
                  z[hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)]);
  }

  /// GroundGrid::cell(); anything for points out of range.
  HWY_INLINE VI groundCell(V x, V y, V rho) const {
    const V two = hn::Set(m_d, 2.f);
    const V sum =
        hn::Max(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Set(m_d, std::numeric_limits<float>::min()));
    const V t = hn::Div(y, sum);
    const V turn = hn::IfThenElse(hn::Lt(x, hn::Zero(m_d)), hn::Sub(hn::CopySign(two, y), t), t);
    const V place = hn::Mul(hn::Add(turn, two), hn::Set(m_d, GroundGrid::kSectors / 4.f));
    const V ring = hn::Mul(rho, hn::Set(m_d, 1 / GroundGrid::kRingWidth));
    const VI sector = hn::ConvertTo(m_di, hn::Min(place, hn::Set(m_d, GroundGrid::kSectors - 1.f)));
    const VI inner = hn::ConvertTo(m_di, hn::Min(ring, hn::Set(m_d, GroundGrid::kRings - 1.f)));
    return hn::Add(hn::Mul(sector, hn::Set(m_di, GroundGrid::kRings)), inner);
  }

  /// Enters one point into the two lowest of its cell. Heights are rounded down, or the noise of
  /// each point would make it the lowest again and again.
  void enterLowest(std::size_t cell, float z) const {
    constexpr float kCoarse = 1.f / 32;  // m
    float &lowest = m_out.lowest[cell], &second = m_out.second[cell];
    const float height = std::floor(z * (1 / kCoarse)) * kCoarse;
    if (height >= second) return;  // lowered by a point of the same vector
    second = std::max(height, std::min(lowest, second));
    lowest = std::min(height, lowest);
  }

  D m_d;
  DI m_di;
  float m_minRange, m_maxRange;
  LowestPoints m_out;
  GroundGrid::Counts m_counts;
};

GroundGrid::Counts collectLowest(const PointsView& points, float minRange, float maxRange,
                                 const LowestPoints& out) {
  Collector collector(minRange, maxRange, out);
  // A beam's points come nearer and lower from point to point, and would be entered one after the
  // other: a few from everywhere first leave little to enter.
  constexpr std::size_t kFew = 16;
  collector.collect(points, kFew, 0);
  collector.collect(points, 1, kFew);
  collector.collectTail(points);
  return collector.counts();
}

class Classifier {
 public:
  Classifier(const PointsView& points, const RingLookup& lookup, int rows, int bucketsPerRow,
             const UnsortedReturns& out)
      : m_points(points), m_lookup(lookup), m_rows(rows), m_buckets(bucketsPerRow), m_out(out) {}

  /// Classifies one vector of points, and writes it behind what was written before.
  /// \param point Their indices.
  void operator()(const std::uint32_t* point, std::size_t at) const {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const auto index = hn::BitCast(di, hn::LoadU(hn::RebindToUnsigned<decltype(d)>(), point));
    // Neighbours in the cloud are mostly kept or dropped together.
    const std::size_t lanes = hn::Lanes(d);
    const bool together = point[lanes - 1] - point[0] == lanes - 1;
    const auto load = [&](const float* from) {
      return together ? hn::LoadU(d, from + point[0]) : hn::GatherIndex(d, from, index);
    };
    const auto vx = load(m_points.x), vy = load(m_points.y), vz = load(m_points.z);
    const auto rho = hn::Sqrt(hn::Add(hn::Mul(vx, vx), hn::Mul(vy, vy)));
    const auto azimuth = arcTangent(d, vy, vx);
    const auto perRadian = hn::Set(d, static_cast<float>(m_buckets) / (2 * kPi));
    const auto column = hn::ConvertTo(di, hn::Mul(hn::Add(azimuth, hn::Set(d, kPi)), perRadian));
    const auto clamped = hn::Min(hn::Max(column, hn::Zero(di)), hn::Set(di, m_buckets - 1));
    const auto row = m_lookup.planes ? rowOfPlane(d, vx, vy, vz) : rowOf(d, rho, vz);
    const auto first = hn::Mul(row, hn::Set(di, m_buckets));
    const auto bucket = hn::Min(hn::Add(first, clamped), hn::Set(di, m_rows * m_buckets));
    hn::StoreU(bucket, di, m_out.bucket + at);
    hn::StoreInterleaved4(azimuth, rho, vz, hn::BitCast(d, index), d, &m_out.returns[at].azimuth);
  }

 private:
  /// Row of every point; the number of rows for those out of view.
  template <class D>
  hn::Vec<hn::RebindToSigned<D>> rowOf(D d, hn::Vec<D> rho, hn::Vec<D> z) const {
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
  template <class D>
  hn::Vec<hn::RebindToSigned<D>> rowOfPlane(D d, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z) const {
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

  const PointsView& m_points;
  const RingLookup& m_lookup;
  int m_rows, m_buckets;
  const UnsortedReturns& m_out;
};

std::size_t classifyPoints(const PointsView& points, const std::uint16_t* cell, const float* limit,
                           const RingLookup& lookup, int rows, int bucketsPerRow,
                           const UnsortedReturns& out) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::uint16_t, decltype(d)> d16;
  const std::size_t lanes = hn::Lanes(d);
  const Classifier classify(points, lookup, rows, bucketsPerRow, out);
  constexpr std::size_t kRoom = 512;  // points that wait, so that whole vectors are classified
  std::uint32_t point[kRoom + 2 * HWY_MAX_BYTES / 4];
  std::size_t count = 0, written = 0;
  for (std::size_t i = 0; i < points.size; i += lanes) {
    const std::size_t rest = points.size - i;
    HWY_ALIGN float tail[HWY_MAX_BYTES / 4] = {};
    const float* z = points.z + i;
    if (HWY_UNLIKELY(rest < lanes)) z = static_cast<float*>(std::memcpy(tail, z, rest * 4));
    const auto c = hn::PromoteTo(di, hn::LoadU(d16, cell + i));
    const auto keep = hn::Ge(hn::LoadU(d, z), lookUp(d, limit, c));
    const std::uint32_t bits = maskBits(d, keep);
    if (bits == 0) continue;  // most often
    count += appendSet(bits, std::min(lanes, rest), static_cast<std::uint32_t>(i), point + count);
    if (count < kRoom) continue;
    std::size_t done = 0;
    for (; done + lanes <= count; done += lanes) classify(point + done, written + done);
    written += done;
    count -= done;
    std::copy(point + done, point + done + count, point);
  }
  for (std::size_t done = 0; done < count; done += lanes) {
    for (std::size_t k = count; k < done + lanes; ++k) point[k] = point[0];  // somewhere
    classify(point + done, written + done);
  }
  return written + count;
}

std::size_t findBreaks(const Return* returns, std::size_t count, float step, float gap,
                       std::uint32_t* breaks) {
  if (count < 2) return 0;
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t found = 0, i = 0;
  for (; i + lanes < count; i += lanes) {
    hn::Vec<decltype(d)> azimuth, rho, z, point, nextAzimuth, nextRho;
    hn::LoadInterleaved4(d, &returns[i].azimuth, azimuth, rho, z, point);
    hn::LoadInterleaved4(d, &returns[i + 1].azimuth, nextAzimuth, nextRho, z, point);
    const auto turn = hn::Sub(nextAzimuth, azimuth);
    const auto near = hn::Lt(hn::Abs(hn::Sub(nextRho, rho)), hn::Set(d, step));
    const auto bridged =
        hn::And(hn::Lt(turn, hn::Set(d, 2 * gap)), hn::Lt(hn::Mul(turn, rho), hn::Set(d, kBridge)));
    const auto same = hn::And(near, hn::Or(hn::Lt(turn, hn::Set(d, gap)), bridged));
    const std::uint32_t bits = maskBits(d, hn::Not(same));
    if (bits) found += appendSet(bits, lanes, static_cast<std::uint32_t>(i), breaks + found);
  }
  for (; i + 1 < count; ++i) {
    const Return &a = returns[i], &b = returns[i + 1];
    const bool same = joined(a, b, b.azimuth - a.azimuth, step, gap);
    breaks[found] = static_cast<std::uint32_t>(i);
    found += !same;
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace polemcl
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace polemcl {
HWY_EXPORT(collectLowest);
HWY_EXPORT(classifyPoints);
HWY_EXPORT(findBreaks);

GroundGrid::Counts collectLowest(const PointsView& points, float minRange, float maxRange,
                                 const LowestPoints& out) {
  return HWY_DYNAMIC_DISPATCH(collectLowest)(points, minRange, maxRange, out);
}

std::size_t classifyPoints(const PointsView& points, const std::uint16_t* cell, const float* limit,
                           const RingLookup& lookup, int rows, int bucketsPerRow,
                           const UnsortedReturns& out) {
  return HWY_DYNAMIC_DISPATCH(classifyPoints)(points, cell, limit, lookup, rows, bucketsPerRow,
                                              out);
}

std::size_t findBreaks(const Return* returns, std::size_t count, float step, float gap,
                       std::uint32_t* breaks) {
  return HWY_DYNAMIC_DISPATCH(findBreaks)(returns, count, step, gap, breaks);
}
}  // namespace polemcl
#endif
