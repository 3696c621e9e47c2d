#include "core/localization/LikelihoodKernels.h"

#include <algorithm>
#include <cmath>

#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"
#include "core/common/PoleIndex.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/localization/LikelihoodKernels.cpp"
// foreach_target.h stands before all that it compiles again.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace polemcl {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Poses worked on together: few enough for all that is kept of them to stay in the first cache.
constexpr std::size_t kBlock = 128;
/// Factors are at least 1e-10: a product of this number of factors cannot underflow.
constexpr std::size_t kFactorsPerLogarithm = 30;

/// A block of poses, and of one detection seen from each.
struct Block {
  HWY_ALIGN double x[kBlock], y[kBlock], cosine[kBlock], sine[kBlock];
  HWY_ALIGN double placeX[kBlock], placeY[kBlock];  ///< of the detection, map frame
  HWY_ALIGN double dx[kBlock], dy[kBlock];          ///< its offset from the nearest map pole
  HWY_ALIGN double variance[kBlock];                ///< of that pole; below 0: no pole
  HWY_ALIGN double product[maxWidenings][kBlock], sum[maxWidenings][kBlock];
};

template <LikelihoodModel model, bool weighted>
class Evaluation {
  using D = hn::ScalableTag<double>;
  using V = hn::Vec<D>;

 public:
  explicit Evaluation(const LikelihoodBatch& batch)
      : m_batch(batch), m_lanes(hn::Lanes(m_d)), m_levels(batch.widenings.size()) {
    for (std::size_t k = 0; k < m_levels; ++k) {
      const double sigma = batch.options.sigma * batch.widenings[k];
      m_squaredSigma[k] = sigma * sigma;
      const double peak = 1 / (sigma * std::sqrt(2 * M_PI));
      m_bellShare[k] = peak / (peak + batch.options.floor);
      m_floorShare[k] = batch.options.floor / (peak + batch.options.floor);
    }
  }

  void run(const Pose2D* poses, std::size_t count, std::vector<std::vector<double>>& out,
           std::size_t first) {
    load(poses, count);
    std::size_t factors = 0;
    for (const LikelihoodTerm& term : m_batch.terms) {
      place(term);
      search(count);
      for (std::size_t i = 0; i < m_size; i += m_lanes) addTerm(term, i);
      if (++factors % kFactorsPerLogarithm == 0) takeLogarithms();
    }
    takeLogarithms();
    for (std::size_t k = 0; k < m_levels; ++k)
      std::copy(m_block.sum[k], m_block.sum[k] + count, out[k].begin() + first);
  }

 private:
  void load(const Pose2D* poses, std::size_t count) {
    m_size = (count + m_lanes - 1) / m_lanes * m_lanes;
    Block& b = m_block;
    for (std::size_t i = 0; i < m_size; ++i) {
      const Pose2D& pose = poses[std::min(i, count - 1)];
      b.x[i] = pose.x;
      b.y[i] = pose.y;
      b.cosine[i] = pose.yaw;
    }
    for (std::size_t i = 0; i < m_size; i += m_lanes) {
      const V yaw = hn::Load(m_d, b.cosine + i);
      hn::Store(hn::Sin(m_d, yaw), m_d, b.sine + i);
      hn::Store(hn::Cos(m_d, yaw), m_d, b.cosine + i);
    }
    for (std::size_t k = 0; k < m_levels; ++k) {
      std::fill(b.product[k], b.product[k] + m_size, 1.0);
      std::fill(b.sum[k], b.sum[k] + m_size, 0.0);
    }
  }

  void place(const LikelihoodTerm& term) {
    Block& b = m_block;
    const V x = hn::Set(m_d, term.x), y = hn::Set(m_d, term.y);
    for (std::size_t i = 0; i < m_size; i += m_lanes) {
      const V c = hn::Load(m_d, b.cosine + i), s = hn::Load(m_d, b.sine + i);
      hn::Store(hn::Add(hn::Load(m_d, b.x + i), hn::Sub(hn::Mul(c, x), hn::Mul(s, y))), m_d,
                b.placeX + i);
      hn::Store(hn::Add(hn::Load(m_d, b.y + i), hn::Add(hn::Mul(s, x), hn::Mul(c, y))), m_d,
                b.placeY + i);
    }
  }

  /// The nearest map pole within the gate of each place.
  void search(std::size_t count) {
    const PoleIndex& index = m_batch.index;
    const double gate = m_batch.options.gate;
    const bool prepared = gate <= index.preparedRadius();
    if (prepared && searchTogether()) return;
    Block& b = m_block;
    for (std::size_t i = 0; i < m_size; ++i) {
      b.dx[i] = b.dy[i] = 0;
      b.variance[i] = -1;
      if (i >= count) continue;
      const double x = b.placeX[i], y = b.placeY[i];
      if (prepared) {
        const PoleGrid::Place* pole = index.grid().find(x, y, gate * gate);
        if (pole) set(i, x - pole->x, y - pole->y, index.variance(pole->index));
      } else if (const PointHit hit = index.tree().nearest(x, y, gate)) {
        const Eigen::Vector2d& pole = index.tree().point(hit.index);
        set(i, x - pole.x(), y - pole.y(), index.variance(hit.index));
      }
    }
  }

  /// The same in vectors, if the places lie so near to each other that few poles are near any of
  /// them, as they do once the pose is known. Else false.
  bool searchTogether() {
    Block& b = m_block;
    V lowX = hn::Load(m_d, b.placeX), highX = lowX, lowY = hn::Load(m_d, b.placeY), highY = lowY;
    V sum = hn::Add(lowX, lowY);
    for (std::size_t i = m_lanes; i < m_size; i += m_lanes) {
      const V x = hn::Load(m_d, b.placeX + i), y = hn::Load(m_d, b.placeY + i);
      lowX = hn::Min(lowX, x), highX = hn::Max(highX, x);
      lowY = hn::Min(lowY, y), highY = hn::Max(highY, y);
      sum = hn::Add(sum, hn::Add(x, y));
    }
    // Extremes may pass over what is not a number, their sum does not.
    if (!std::isfinite(hn::GetLane(hn::SumOfLanes(m_d, sum)))) return false;
    const auto least = [&](V v) { return hn::GetLane(hn::MinOfLanes(m_d, v)); };
    const auto greatest = [&](V v) { return hn::GetLane(hn::MaxOfLanes(m_d, v)); };
    if (!m_batch.index.grid().candidatesIn(least(lowX), least(lowY), greatest(highX),
                                           greatest(highY), m_candidates))
      return false;
    for (std::size_t i = 0; i < m_size; i += m_lanes) chooseNearest(i);
    return true;
  }

  HWY_INLINE void chooseNearest(std::size_t i) {
    Block& b = m_block;
    const V x = hn::Load(m_d, b.placeX + i), y = hn::Load(m_d, b.placeY + i);
    V dx = hn::Zero(m_d), dy = dx, variance = hn::Set(m_d, -1.0);
    V least = hn::Set(m_d, m_batch.options.gate * m_batch.options.gate);
    for (const PoleGrid::Place& pole : m_candidates) {  // of equals, the first stays
      const V offX = hn::Sub(x, hn::Set(m_d, pole.x)), offY = hn::Sub(y, hn::Set(m_d, pole.y));
      const V squared = hn::Add(hn::Mul(offX, offX), hn::Mul(offY, offY));
      const auto nearer = hn::Lt(squared, least);
      least = hn::IfThenElse(nearer, squared, least);
      dx = hn::IfThenElse(nearer, offX, dx);
      dy = hn::IfThenElse(nearer, offY, dy);
      const V its = hn::Set(m_d, m_batch.index.variance(pole.index));
      variance = hn::IfThenElse(nearer, its, variance);
    }
    hn::Store(dx, m_d, b.dx + i);
    hn::Store(dy, m_d, b.dy + i);
    hn::Store(variance, m_d, b.variance + i);
  }

  HWY_INLINE void set(std::size_t i, double dx, double dy, double variance) {
    m_block.dx[i] = dx;
    m_block.dy[i] = dy;
    m_block.variance[i] = variance;
  }

  /// Half the squared Mahalanobis distance, and the height of the bell σ²/√det S.
  HWY_INLINE void bell(const LikelihoodTerm& term, std::size_t i, V dx, V dy, V variance,
                       double squaredSigma, V& exponent, V& height) const {
    if constexpr (!weighted) {
      exponent = hn::Div(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Set(m_d, 2 * squaredSigma));
      height = hn::Set(m_d, 1.0);
      return;
    }
    const V c = hn::Load(m_d, m_block.cosine + i), s = hn::Load(m_d, m_block.sine + i);
    const V ax = hn::Set(m_d, term.axes.x), ay = hn::Set(m_d, term.axes.y);
    const V axisX = hn::Sub(hn::Mul(c, ax), hn::Mul(s, ay));
    const V axisY = hn::Add(hn::Mul(s, ax), hn::Mul(c, ay));
    const V along = hn::Add(hn::Mul(axisX, dx), hn::Mul(axisY, dy));
    const V across = hn::Sub(hn::Mul(axisX, dy), hn::Mul(axisY, dx));
    const V common = hn::Add(hn::Set(m_d, squaredSigma), variance);
    const V first = hn::Add(hn::Set(m_d, term.axes.first), common);
    const V second = hn::Add(hn::Set(m_d, term.axes.second), common);
    const V determinant = hn::Mul(first, second);
    const V squares =
        hn::Add(hn::Mul(hn::Mul(along, along), second), hn::Mul(hn::Mul(across, across), first));
    const V inverse = hn::Div(hn::Set(m_d, 1.0), determinant);
    exponent = hn::Mul(hn::Mul(hn::Set(m_d, 0.5), squares), inverse);
    height = hn::Mul(hn::Set(m_d, squaredSigma), hn::Sqrt(inverse));
  }

  HWY_INLINE void addTerm(const LikelihoodTerm& term, std::size_t i) {
    Block& b = m_block;
    const V dx = hn::Load(m_d, b.dx + i), dy = hn::Load(m_d, b.dy + i);
    const V variance = hn::Load(m_d, b.variance + i);
    const auto found = hn::Ge(variance, hn::Zero(m_d));
    const bool none = hn::AllFalse(m_d, found);
    V miss = hn::Zero(m_d);
    if constexpr (model == LikelihoodModel::mixture) miss = outlier(term, dx, dy, found);
    for (std::size_t k = 0; k < m_levels; ++k) {
      V exponent = hn::Zero(m_d), height = exponent;
      if (!none) bell(term, i, dx, dy, variance, m_squaredSigma[k], exponent, height);
      if constexpr (model == LikelihoodModel::floored) {
        const V clipped = hn::Set(m_d, costOfNoMatch(term, k));
        const V value = hn::Exp(m_d, hn::Neg(hn::IfThenElse(found, exponent, clipped)));
        const V bellShare = hn::Set(m_d, m_bellShare[k]), rest = hn::Set(m_d, m_floorShare[k]);
        const V factor = hn::Add(hn::Mul(bellShare, value), rest);
        hn::Store(hn::Mul(hn::Load(m_d, b.product[k] + i), factor), m_d, b.product[k] + i);
      } else if constexpr (model == LikelihoodModel::mixture) {
        V factor = miss;
        if (!none) {
          const V value = hn::Exp(m_d, hn::Neg(exponent));
          const V hit = hn::Mul(hn::Mul(hn::Set(m_d, term.share), height), value);
          factor = hn::Add(factor, hn::IfThenElseZero(found, hit));
        }
        hn::Store(hn::Mul(hn::Load(m_d, b.product[k] + i), factor), m_d, b.product[k] + i);
      } else {  // Eq. 3
        const V cost = hn::Set(m_d, costOfNoMatch(term, k));
        const V matched = hn::Min(hn::IfThenElse(found, exponent, cost), cost);
        const V counted = hn::Mul(hn::Set(m_d, term.confidence), matched);
        hn::Store(hn::Sub(hn::Load(m_d, b.sum[k] + i), counted), m_d, b.sum[k] + i);
      }
    }
  }

  /// What the outliers add: (1-p)·o(d).
  template <class Mask>
  HWY_INLINE V outlier(const LikelihoodTerm& term, V dx, V dy, Mask found) const {
    const double far = m_batch.options.farOutlier, gate = m_batch.options.gate;
    const V everywhere = hn::Set(m_d, far * term.floor);
    if (far == 1 || hn::AllFalse(m_d, found)) return everywhere;
    const V squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const V left = hn::Sub(hn::Set(m_d, 1.0), hn::Mul(squared, hn::Set(m_d, 1 / (gate * gate))));
    const V cube = hn::Mul(left, hn::Mul(left, left));
    const V beside = hn::Mul(hn::Set(m_d, (1 - far) * term.confidence * term.floor), cube);
    return hn::Add(everywhere, hn::IfThenElseZero(found, beside));
  }

  double costOfNoMatch(const LikelihoodTerm& term, std::size_t k) const {
    const double gate = m_batch.options.gate;
    return gate * gate / (2 * m_squaredSigma[k] + term.axes.first + term.axes.second);
  }

  void takeLogarithms() {
    if constexpr (model == LikelihoodModel::paper) return;
    for (std::size_t k = 0; k < m_levels; ++k) {
      double *product = m_block.product[k], *sum = m_block.sum[k];
      for (std::size_t i = 0; i < m_size; i += m_lanes) {
        const V value = hn::Log(m_d, hn::Load(m_d, product + i));
        hn::Store(hn::Add(hn::Load(m_d, sum + i), value), m_d, sum + i);
        hn::Store(hn::Set(m_d, 1.0), m_d, product + i);
      }
    }
  }

  const LikelihoodBatch& m_batch;
  const D m_d;
  const std::size_t m_lanes, m_levels;
  std::size_t m_size = 0;  ///< poses in the block, filled up to whole vectors
  double m_squaredSigma[maxWidenings];
  /// The density's peak and the floor as shares of their sum; floored only.
  double m_bellShare[maxWidenings], m_floorShare[maxWidenings];
  std::vector<PoleGrid::Place> m_candidates;
  Block m_block;
};

template <LikelihoodModel model, bool weighted>
void evaluate(const LikelihoodBatch& batch, const std::vector<Pose2D>& poses,
              std::vector<std::vector<double>>& out) {
  Evaluation<model, weighted> evaluation(batch);
  for (std::size_t first = 0; first < poses.size(); first += kBlock)
    evaluation.run(&poses[first], std::min(kBlock, poses.size() - first), out, first);
}

void likelihoods(const LikelihoodBatch& batch, const std::vector<Pose2D>& poses,
                 std::vector<std::vector<double>>& out) {
  const bool weighted = batch.options.weighted;
  if (batch.options.model == LikelihoodModel::mixture)
    weighted ? evaluate<LikelihoodModel::mixture, true>(batch, poses, out)
             : evaluate<LikelihoodModel::mixture, false>(batch, poses, out);
  else if (batch.options.model == LikelihoodModel::floored)
    evaluate<LikelihoodModel::floored, false>(batch, poses, out);
  else
    weighted ? evaluate<LikelihoodModel::paper, true>(batch, poses, out)
             : evaluate<LikelihoodModel::paper, false>(batch, poses, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace polemcl
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace polemcl {
HWY_EXPORT(likelihoods);

void likelihoods(const LikelihoodBatch& batch, const std::vector<Pose2D>& poses,
                 std::vector<std::vector<double>>& out) {
  HWY_DYNAMIC_DISPATCH(likelihoods)(batch, poses, out);
}
}  // namespace polemcl
#endif
