#include "report/batch/BatchResults.h"

#include <algorithm>
#include <cmath>

#include <polemcl/core/common/Types.h>

namespace polemcl::report {
namespace {

constexpr double lowestExponent = -3;
constexpr double binsPerDecade = 10;

}  // namespace

const char* stateOf(const BatchRun& run, double lostBound) {
  if (!run.failure.empty()) return "failed";
  const ErrorMetrics& errors = run.errors;
  const bool known = errors.poses > 0 && std::isfinite(errors.posMean);
  return !known || errors.posMean > lostBound || errors.posEnd > lostBound ? "lost" : "ok";
}

double ErrorHistogram::edge(std::size_t bin) {
  return std::pow(10, lowestExponent + static_cast<double>(bin) / binsPerDecade);
}

void ErrorHistogram::add(double value) {
  if (!(value >= 0) || !std::isfinite(value))
    throw Error("report: a histogram takes finite values of at least 0, not " +
                std::to_string(value));
  // Compared with the edges, not computed by a logarithm: an edge belongs to the bin above it.
  std::size_t bin = 0;
  while (bin + 1 < bins && value >= edge(bin + 1)) ++bin;
  ++counts[bin];
}

const SessionResult* BatchResults::find(std::size_t configuration, std::size_t session) const {
  const auto found = std::find_if(results.begin(), results.end(), [&](const SessionResult& r) {
    return r.configuration == configuration && r.session == session;
  });
  return found == results.end() ? nullptr : &*found;
}

}  // namespace polemcl::report
