#include <cmath>
#include <optional>

#include <polemcl/core/localization/PoleLikelihood.h>
#include "core/common/Binder.h"
#include "core/common/Covariance.h"
#include "core/common/PoleIndex.h"
#include "core/localization/LikelihoodKernels.h"

namespace polemcl {
namespace {

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
  checkOptions(options);
  if (widenings.size() > maxWidenings)
    throw Error("a likelihood was asked for with " + std::to_string(widenings.size()) +
                " sigmas at once; at most " + std::to_string(maxWidenings) + " are allowed");
  out.resize(widenings.size());
  for (auto& values : out) values.resize(poses.size());
  likelihoods({prepare(poles_robot, options), index, options, widenings}, poses, out);
}

}  // namespace polemcl
