#include "core/localization/PoleLikelihood.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "core/common/PrincipalAxes.h"
#include "core/localization/LikelihoodKernels.h"

namespace polemcl {
namespace {

template <class Value>
[[noreturn]] void refuseLikelihood(const char* field, Value value, const char* allowed) {
  std::ostringstream text;
  text << "[likelihood] " << field << " = " << value << " is not allowed; it must be " << allowed;
  throw Error(text.str());
}

[[noreturn]] void refuseDetection(std::size_t index, const std::string& what) {
  throw Error("pole detection " + std::to_string(index) + " " + what +
              "; correct it or set [likelihood] weighted = false");
}

std::vector<LikelihoodTerm> prepare(const std::vector<PoleDetection>& poles,
                                    const LikelihoodOptions& options) {
  std::vector<LikelihoodTerm> terms;
  terms.reserve(poles.size());
  for (const PoleDetection& pole : poles) {
    LikelihoodTerm term{};
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
    terms.push_back(term);
  }
  return terms;
}

}  // namespace

void LikelihoodOptions::validate() const {
  if (!(std::isfinite(sigma) && sigma > 0)) refuseLikelihood("sigma", sigma, "above 0 m");
  if (!(outlier >= 1e-9 && outlier < 1))
    refuseLikelihood("outlier", outlier, "a share in [1e-9, 1)");
  if (!(std::isfinite(gate) && gate > 0)) refuseLikelihood("gate", gate, "above 0 m");
  // Against the peak of the density, so that products of many factors do not underflow.
  const double peak = 1 / (sigma * std::sqrt(2 * M_PI));
  if (!(std::isfinite(floor) && floor > 0)) refuseLikelihood("floor", floor, "above 0");
  if (model == LikelihoodModel::floored && floor < 1e-9 * (peak + floor))
    refuseLikelihood("floor", floor, "at least 1e-9 of the density's peak");
  if (model == LikelihoodModel::floored && weighted)
    refuseLikelihood("weighted", "true",
                     "false with model = floored, which takes all detections alike");
}

double logLikelihood(const std::vector<PoleDetection>& poles_robot, const Pose2D& pose_map_robot,
                     const PoleIndex& index, const LikelihoodOptions& options) {
  std::vector<double> out;
  logLikelihoods(poles_robot, {pose_map_robot}, index, options, out);
  return out[0];
}

void logLikelihoods(const std::vector<PoleDetection>& poles_robot, const std::vector<Pose2D>& poses,
                    const PoleIndex& index, const LikelihoodOptions& options,
                    std::vector<double>& out) {
  std::vector<std::vector<double>> widened(1);
  widened[0].swap(out);
  widenedLogLikelihoods(poles_robot, poses, index, options, {1}, widened);
  out.swap(widened[0]);
}

void widenedLogLikelihoods(const std::vector<PoleDetection>& poles_robot,
                           const std::vector<Pose2D>& poses, const PoleIndex& index,
                           const LikelihoodOptions& options, const std::vector<double>& widenings,
                           std::vector<std::vector<double>>& out) {
  options.validate();
  if (widenings.size() > maxWidenings)
    throw Error("a likelihood was asked for with " + std::to_string(widenings.size()) +
                " sigmas at once; at most " + std::to_string(maxWidenings) + " are allowed");
  out.resize(widenings.size());
  for (auto& values : out) values.resize(poses.size());
  likelihoods({prepare(poles_robot, options), index, options, widenings}, poses, out);
}

}  // namespace polemcl
