#include "core/extraction/scan_line/GroundKernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/extraction/scan_line/GroundKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace polemcl {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Finds the cells of points a vector at a time.
class CellFinder {
  using D = hn::ScalableTag<float>;
  using DI = hn::RebindToSigned<D>;
  using D16 = hn::Rebind<std::uint16_t, D>;
  using V = hn::Vec<D>;
  using VI = hn::Vec<DI>;

 public:
  CellFinder(float minRange, float maxRange, std::uint16_t* cell)
      : m_minRange(minRange), m_maxRange(maxRange), m_cell(cell) {}

  GroundGrid::Counts find(const PointsView& points) {
    const std::size_t lanes = hn::Lanes(D()), rest = points.size % lanes,
                      whole = points.size - rest;
    for (std::size_t i = 0; i < whole; i += lanes)
      findVector(points.x + i, points.y + i, points.z + i, m_cell + i);
    if (rest == 0) return m_counts;
    // The points left over, with zeros behind them, which are dropped.
    HWY_ALIGN float x[HWY_MAX_BYTES / 4] = {}, y[HWY_MAX_BYTES / 4] = {}, z[HWY_MAX_BYTES / 4] = {};
    std::copy(points.x + whole, points.x + points.size, x);
    std::copy(points.y + whole, points.y + points.size, y);
    std::copy(points.z + whole, points.z + points.size, z);
    findVector(x, y, z, m_cell + whole);
    m_counts.invalid -= lanes - rest;
    return m_counts;
  }

 private:
  HWY_INLINE void findVector(const float* x, const float* y, const float* z, std::uint16_t* to) {
    const D d;
    const V vx = hn::LoadU(d, x), vy = hn::LoadU(d, y), vz = hn::LoadU(d, z);
    const V rho = hn::Sqrt(hn::Add(hn::Mul(vx, vx), hn::Mul(vy, vy)));
    const V place = estimateSector(vx, vy);
    const V sector = nearestWhole(place), offBy = hn::Abs(hn::Sub(place, sector));
    const auto inRange =
        hn::And(hn::Ge(rho, hn::Set(d, m_minRange)), hn::Le(rho, hn::Set(d, m_maxRange)));
    // False for what is not a number; and zeros are what sensors give for no return.
    const auto valid = hn::And(hn::Gt(rho, hn::Zero(d)),
                               hn::Le(hn::Abs(vz), hn::Set(d, std::numeric_limits<float>::max())));
    const auto sure = hn::Lt(offBy, hn::Set(d, 0.499f));
    if (HWY_LIKELY(hn::AllTrue(d, hn::And(hn::And(inRange, valid), sure)))) {
      hn::StoreU(hn::DemoteTo(D16(), cellOf(sector, rho)), D16(), to);
    } else {
      findExactly(vx, vy, vz, rho, to);
    }
  }

  /// The same for points some of which are dropped, or near the border of a sector.
  HWY_NOINLINE void findExactly(V x, V y, V z, V rho, std::uint16_t* to) {
    const D d;
    const V size = hn::Add(rho, hn::Abs(z));
    const auto valid = hn::And(hn::Gt(size, hn::Zero(d)),
                               hn::Le(size, hn::Set(d, std::numeric_limits<float>::max())));
    const auto inRange = hn::And(
        valid, hn::And(hn::Ge(rho, hn::Set(d, m_minRange)), hn::Le(rho, hn::Set(d, m_maxRange))));
    const std::size_t kept = hn::CountTrue(d, inRange), some = hn::CountTrue(d, valid);
    m_counts.invalid += hn::Lanes(d) - some;
    m_counts.outOfRange += some - kept;
    const V sum =
        hn::Max(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Set(d, std::numeric_limits<float>::min()));
    const V place = hn::Mul(hn::Add(turnOf(x, y, hn::Div(y, sum)), hn::Set(d, 2.f)),
                            hn::Set(d, GroundGrid::kSectors / 4.f));
    const V sector = hn::Floor(hn::Min(place, hn::Set(d, GroundGrid::kSectors - 1.f)));
    const VI cell = hn::IfThenElse(hn::RebindMask(DI(), inRange), cellOf(sector, rho),
                                   hn::Set(DI(), GroundGrid::kNoCell));
    hn::StoreU(hn::DemoteTo(D16(), cell), D16(), to);
  }

  /// GroundGrid's place among the sectors, less 0.5. A division would take longest of all here; an
  /// estimate, made better by one step of Newton's, is off by less than 0.001.
  HWY_INLINE V estimateSector(V x, V y) const {
    const D d;
    const V sum = hn::Add(hn::Abs(x), hn::Abs(y)), estimate = hn::ApproximateReciprocal(sum);
    const V perSum = hn::Mul(estimate, hn::Sub(hn::Set(d, 2.f), hn::Mul(sum, estimate)));
    return hn::Add(
        hn::Mul(turnOf(x, y, hn::Mul(y, perSum)), hn::Set(d, GroundGrid::kSectors / 4.f)),
        hn::Set(d, GroundGrid::kSectors / 2.f - 0.5f));
  }

  /// -2 to 2. \param t y / (|x| + |y|)
  static HWY_INLINE V turnOf(V x, V y, V t) {
    const V beyond = hn::Sub(hn::CopySign(hn::Set(D(), 2.f), y), t);
    return hn::IfThenElse(hn::Lt(x, hn::Zero(D())), beyond, t);
  }

  /// For numbers from -2^22 to 2^22.
  static HWY_INLINE V nearestWhole(V v) {
    const V large = hn::Set(D(), 12582912.f);  // its last bit is worth 1
    return hn::Sub(hn::Add(v, large), large);
  }

  static HWY_INLINE VI cellOf(V sector, V rho) {
    const D d;
    const V ring = hn::Floor(hn::Min(hn::Mul(rho, hn::Set(d, 1 / GroundGrid::kRingWidth)),
                                     hn::Set(d, GroundGrid::kRings - 1.f)));
    const V cell = hn::Add(hn::Mul(sector, hn::Set(d, GroundGrid::kRings)), ring);
    // The last bits of a sum whose last bit is worth 1 are the number.
    return hn::And(hn::BitCast(DI(), hn::Add(cell, hn::Set(d, 8388608.f))), hn::Set(DI(), 0xffff));
  }

  float m_minRange, m_maxRange;
  std::uint16_t* m_cell;
  GroundGrid::Counts m_counts;
};

/// Enters one height into the two lowest of its cell. Heights are rounded down, or the noise of
/// each point would make it the lowest again and again.
inline void enterLowest(std::size_t cell, float z, const LowestPoints& out) {
  constexpr float kCoarse = 1.f / 32;  // m
  float &lowest = out.lowest[cell], &second = out.second[cell];
  const float height = std::floor(z * (1 / kCoarse)) * kCoarse;
  if (height >= second) return;  // lowered by a point of the same vector
  second = std::max(height, std::min(lowest, second));
  lowest = std::min(height, lowest);
}

constexpr std::size_t kStep = 8;  ///< of the points that are entered first

/// Enters every 8th point, beginning at the end of the cloud that lies lower.
inline void enterSome(const PointsView& points, const LowestPoints& out) {
  const std::size_t count = (points.size + kStep - 1) / kStep, half = count / 2;
  float sum[2] = {0, 0};
  for (std::size_t k = 0; k < half; k += kStep) {
    sum[0] += points.z[k * kStep];
    sum[1] += points.z[(count - 1 - k) * kStep];
  }
  const bool backwards = sum[1] < sum[0];
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (backwards ? count - 1 - k : k) * kStep;
    if (points.z[i] < out.second[out.cell[i]]) enterLowest(out.cell[i], points.z[i], out);
  }
}

inline void enterOthers(const PointsView& points, const LowestPoints& out) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::uint16_t, decltype(d)> d16;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= points.size; i += lanes) {
    const auto cell = hn::PromoteTo(di, hn::LoadU(d16, out.cell + i));
    const auto low = hn::Lt(hn::LoadU(d, points.z + i), hn::GatherIndex(d, out.second, cell));
    const std::uint32_t entered = i % kStep == 0 ? 0x01010101u : 0u;
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, low, bytes);
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof bits);
    for (bits &= ~entered; bits != 0; bits &= bits - 1) {
      const std::size_t k = i + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
      enterLowest(out.cell[k], points.z[k], out);
    }
  }
  for (; i < points.size; ++i)
    if (i % kStep != 0 && points.z[i] < out.second[out.cell[i]])
      enterLowest(out.cell[i], points.z[i], out);
}

GroundGrid::Counts collectLowest(const PointsView& points, float minRange, float maxRange,
                                 const LowestPoints& out) {
  const GroundGrid::Counts counts = CellFinder(minRange, maxRange, out.cell).find(points);
  // A beam's points come nearer and lower from point to point, and would be entered one after the
  // other: some from everywhere first leave little to enter.
  enterSome(points, out);
  enterOthers(points, out);
  return counts;
}

}  // namespace HWY_NAMESPACE
}  // namespace polemcl
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace polemcl {
HWY_EXPORT(collectLowest);

GroundGrid::Counts collectLowest(const PointsView& points, float minRange, float maxRange,
                                 const LowestPoints& out) {
  return HWY_DYNAMIC_DISPATCH(collectLowest)(points, minRange, maxRange, out);
}
}  // namespace polemcl
#endif
