#include <polemcl/core/PoleLikelihood.h>
#include <polemcl/core/PrincipalAxes.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace polemcl {
namespace {

/// One detection, with all that does not depend on the pose.
struct Term {
  double x, y;         ///< centre, robot frame
  double share;        ///< p: probability of belonging to a map pole
  double floor;        ///< 1 - p, without the rounding of that difference
  double confidence;   ///< c; 1 unless weighted
  double cost;         ///< paper: cost of no match
  PrincipalAxes axes;  ///< of its covariance, robot frame; nothing unless weighted
};

[[noreturn]] void refuse(const char* field, double value, const char* allowed) {
  std::ostringstream text;
  text << "[likelihood] " << field << " = " << value << " is not allowed; it must be " << allowed;
  throw Error(text.str());
}

[[noreturn]] void refuseDetection(std::size_t index, const std::string& what) {
  throw Error("pole detection " + std::to_string(index) + " " + what +
              "; correct it or set [likelihood] weighted = false");
}

std::vector<Term> prepare(const std::vector<PoleDetection>& poles,
                          const LikelihoodOptions& options) {
  std::vector<Term> terms;
  terms.reserve(poles.size());
  const double squaredSigma = options.sigma * options.sigma;
  for (const PoleDetection& pole : poles) {
    Term term{};
    term.x = pole.x;
    term.y = pole.y;
    term.confidence = 1;
    if (options.weighted) {
      if (!(pole.confidence >= 0 && pole.confidence <= 1)) {
        refuseDetection(terms.size(), "has a confidence outside [0, 1]");
      }
      term.confidence = pole.confidence;
      const std::optional<PrincipalAxes> axes = principalAxes(pole.covariance);
      if (!axes)
        refuseDetection(terms.size(),
                        "has a covariance that is not symmetric positive semidefinite");
      term.axes = *axes;
    }
    term.share = (1 - options.outlier) * term.confidence;
    term.floor = 1 - term.confidence + options.outlier * term.confidence;
    term.cost =
        options.gate * options.gate / (2 * squaredSigma + term.axes.first + term.axes.second);
    terms.push_back(term);
  }
  return terms;
}

/// A product of factors in (0, 1] as a logarithm: multiplied up while it cannot underflow, so that
/// a pose takes one logarithm and not one per detection.
class LogProduct {
 public:
  void multiply(double factor) {
    if (m_product < 1e-200) {
      m_log += std::log(m_product);
      m_product = 1;
    }
    m_product *= factor;
  }
  double log() const { return m_log + std::log(m_product); }

 private:
  double m_product = 1, m_log = 0;
};

/// Half the squared Mahalanobis distance, and the height of the bell σ²/√det S.
struct Bell {
  double exponent, height;
};

class Evaluation {
 public:
  Evaluation(const std::vector<PoleDetection>& poles, const PoleIndex& index,
             const LikelihoodOptions& options)
      : m_terms(prepare(poles, options)),
        m_index(index),
        m_squaredSigma(options.sigma * options.sigma),
        m_gate(options.gate) {}

  template <LikelihoodModel model, bool weighted, bool prepared>
  double at(const Pose2D& pose) const {
    const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
    LogProduct product;
    double cost = 0;
    for (const Term& term : m_terms) {
      const double x = pose.x + (c * term.x - s * term.y), y = pose.y + (s * term.x + c * term.y);
      const PointHit hit = prepared ? m_index.grid().nearest(x, y, m_gate * m_gate)
                                    : m_index.tree().nearest(x, y, m_gate);
      if constexpr (model == LikelihoodModel::mixture) {
        double factor = term.floor;
        if (hit) {
          const Bell b = bell<weighted>(term, hit, x, y, c, s);
          factor += term.share * b.height * std::exp(-b.exponent);
        }
        product.multiply(factor);
      } else {  // Eq. 3
        const double matched = hit ? bell<weighted>(term, hit, x, y, c, s).exponent : term.cost;
        cost += term.confidence * std::min(matched, term.cost);
      }
    }
    return model == LikelihoodModel::mixture ? product.log() : -cost;
  }

 private:
  template <bool weighted>
  Bell bell(const Term& term, const PointHit& hit, double x, double y, double c, double s) const {
    if constexpr (!weighted) return {hit.squaredDistance / (2 * m_squaredSigma), 1};
    const Eigen::Vector2d& pole = m_index.tree().point(hit.index);
    const double axisX = c * term.axes.x - s * term.axes.y,
                 axisY = s * term.axes.x + c * term.axes.y;
    const double dx = x - pole.x(), dy = y - pole.y();
    const double along = axisX * dx + axisY * dy, across = axisX * dy - axisY * dx;
    const double common = m_squaredSigma + m_index.variance(hit.index);
    const double first = term.axes.first + common, second = term.axes.second + common;
    const double determinant = first * second;
    return {0.5 * (along * along * second + across * across * first) / determinant,
            m_squaredSigma / std::sqrt(determinant)};
  }

  std::vector<Term> m_terms;
  const PoleIndex& m_index;
  double m_squaredSigma, m_gate;
};

using PoseFunction = double (Evaluation::*)(const Pose2D&) const;

template <LikelihoodModel model>
PoseFunction chooseFor(bool weighted, bool prepared) {
  if (weighted)
    return prepared ? &Evaluation::at<model, true, true> : &Evaluation::at<model, true, false>;
  return prepared ? &Evaluation::at<model, false, true> : &Evaluation::at<model, false, false>;
}

PoseFunction choose(const PoleIndex& index, const LikelihoodOptions& options) {
  const bool prepared = options.gate <= index.preparedRadius();
  return options.model == LikelihoodModel::mixture
             ? chooseFor<LikelihoodModel::mixture>(options.weighted, prepared)
             : chooseFor<LikelihoodModel::paper>(options.weighted, prepared);
}

}  // namespace

void LikelihoodOptions::validate() const {
  if (!(std::isfinite(sigma) && sigma > 0)) refuse("sigma", sigma, "above 0 m");
  if (!(outlier >= 1e-9 && outlier < 1)) refuse("outlier", outlier, "a share in [1e-9, 1)");
  if (!(std::isfinite(gate) && gate > 0)) refuse("gate", gate, "above 0 m");
}

double logLikelihood(const std::vector<PoleDetection>& poles_robot, const Pose2D& pose_map_robot,
                     const PoleIndex& index, const LikelihoodOptions& options) {
  options.validate();
  const Evaluation evaluation(poles_robot, index, options);
  return (evaluation.*choose(index, options))(pose_map_robot);
}

void logLikelihoods(const std::vector<PoleDetection>& poles_robot, const std::vector<Pose2D>& poses,
                    const PoleIndex& index, const LikelihoodOptions& options,
                    std::vector<double>& out) {
  options.validate();
  const Evaluation evaluation(poles_robot, index, options);
  const PoseFunction at = choose(index, options);
  out.resize(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) out[i] = (evaluation.*at)(poses[i]);
}

}  // namespace polemcl
