#include "ScanKernels.h"

#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ScanKernels.cpp"
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

class Classifier {
 public:
  Classifier(const RowLookup& lookup, int bucketsPerRow, float minRange, float maxRange)
      : m_lookup(lookup), m_buckets(bucketsPerRow), m_minRange(minRange), m_maxRange(maxRange) {}

  /// Classifies one vector of points; `lanes` of them count.
  void operator()(const float* x, const float* y, const float* z, std::size_t lanes,
                  const PointKeys& keys, std::size_t at, ScanLines::Counts& counts) const {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const auto vx = hn::LoadU(d, x), vy = hn::LoadU(d, y), vz = hn::LoadU(d, z);
    const auto zero = hn::Zero(d);
    const auto rho = hn::Sqrt(hn::Add(hn::Mul(vx, vx), hn::Mul(vy, vy)));
    // 0 · v is 0 for finite v only.
    const auto finite = hn::Eq(hn::Mul(zero, hn::Add(rho, vz)), zero);
    const auto valid = hn::And(finite, hn::Or(hn::Gt(rho, zero), hn::Ne(vz, zero)));
    const auto inRange = hn::And(
        valid, hn::And(hn::Ge(rho, hn::Set(d, m_minRange)), hn::Le(rho, hn::Set(d, m_maxRange))));
    const auto safeRho = hn::IfThenElse(inRange, rho, hn::Set(d, 1.f));
    const auto safeX = hn::IfThenElse(inRange, vx, hn::Set(d, 1.f));
    const auto safeY = hn::IfThenElse(inRange, vy, zero), safeZ = hn::IfThenElse(inRange, vz, zero);

    const auto lower = hn::Lt(safeZ, hn::Add(hn::Mul(safeRho, hn::Set(d, m_lookup.splitSlope)),
                                             hn::Set(d, m_lookup.splitOffset)));
    const auto pick = [&](const float* of) {
      return hn::IfThenElse(lower, hn::Set(d, of[1]), hn::Set(d, of[0]));
    };
    const auto slope = hn::Div(hn::Sub(safeZ, pick(m_lookup.offset)), safeRho);
    const auto cell =
        hn::Mul(hn::Sub(slope, pick(m_lookup.minSlope)), hn::Set(d, m_lookup.cellsPerSlope));
    const auto inView =
        hn::And(inRange, hn::And(hn::Ge(cell, zero), hn::Lt(cell, pick(m_lookup.cells))));
    const auto base = hn::IfThenElse(hn::RebindMask(di, lower), hn::Set(di, m_lookup.base[1]),
                                     hn::Set(di, m_lookup.base[0]));
    const auto index = hn::Add(hn::ConvertTo(di, hn::IfThenElseZero(inView, cell)), base);
    const auto row = hn::GatherIndex(di, m_lookup.row.data(), index);

    const auto azimuth = arcTangent(d, safeY, safeX);
    const float perRadian = static_cast<float>(m_buckets) / (2 * kPi);
    const auto column =
        hn::ConvertTo(di, hn::Mul(hn::Add(azimuth, hn::Set(d, kPi)), hn::Set(d, perRadian)));
    const auto clamped = hn::Min(hn::Max(column, hn::Zero(di)), hn::Set(di, m_buckets - 1));
    const auto bucket = hn::Add(hn::Mul(row, hn::Set(di, m_buckets)), clamped);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, inView), bucket, hn::Set(di, -1)), di,
               keys.bucket + at);
    hn::StoreU(azimuth, d, keys.azimuth + at);
    hn::StoreU(rho, d, keys.rho + at);

    const auto counted = hn::FirstN(d, lanes);
    const std::size_t nValid = hn::CountTrue(d, hn::And(counted, valid));
    const std::size_t nInRange = hn::CountTrue(d, hn::And(counted, inRange));
    const std::size_t nInView = hn::CountTrue(d, hn::And(counted, inView));
    counts.invalid += lanes - nValid;
    counts.outOfRange += nValid - nInRange;
    counts.outOfView += nInRange - nInView;
    counts.used += nInView;
  }

 private:
  const RowLookup& m_lookup;
  int m_buckets;
  float m_minRange, m_maxRange;
};

ScanLines::Counts classifyPoints(const PointsView& points, const RowLookup& lookup,
                                 int bucketsPerRow, float minRange, float maxRange,
                                 const PointKeys& keys) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const Classifier classify(lookup, bucketsPerRow, minRange, maxRange);
  ScanLines::Counts counts;
  std::size_t i = 0;
  for (; i + lanes <= points.size; i += lanes)
    classify(points.x + i, points.y + i, points.z + i, lanes, keys, i, counts);
  if (const std::size_t rest = points.size - i; rest > 0) {
    HWY_ALIGN float x[HWY_MAX_BYTES / 4] = {}, y[HWY_MAX_BYTES / 4] = {}, z[HWY_MAX_BYTES / 4] = {};
    std::memcpy(x, points.x + i, rest * sizeof(float));
    std::memcpy(y, points.y + i, rest * sizeof(float));
    std::memcpy(z, points.z + i, rest * sizeof(float));
    classify(x, y, z, rest, keys, i, counts);
  }
  return counts;
}

std::size_t findBreaks(const Return* returns, std::size_t count, float step, float gap,
                       std::uint32_t* breaks) {
  if (count < 2) return 0;
  const hn::ScalableTag<float> d;
  const hn::RebindToUnsigned<decltype(d)> du;
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
    const auto here = hn::Iota(du, static_cast<std::uint32_t>(i));
    found += hn::CompressStore(here, hn::RebindMask(du, hn::Not(same)), du, breaks + found);
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
HWY_EXPORT(classifyPoints);
HWY_EXPORT(findBreaks);

ScanLines::Counts classifyPoints(const PointsView& points, const RowLookup& lookup,
                                 int bucketsPerRow, float minRange, float maxRange,
                                 const PointKeys& keys) {
  return HWY_DYNAMIC_DISPATCH(classifyPoints)(points, lookup, bucketsPerRow, minRange, maxRange,
                                              keys);
}

std::size_t findBreaks(const Return* returns, std::size_t count, float step, float gap,
                       std::uint32_t* breaks) {
  return HWY_DYNAMIC_DISPATCH(findBreaks)(returns, count, step, gap, breaks);
}
}  // namespace polemcl
#endif
