#include "report/batch/BatchResults.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include <polemcl/core/common/Types.h>

namespace polemcl::report {
namespace {

constexpr double lowestExponent = -3;
constexpr double binsPerDecade = 10;

template <typename Named>
void requireNames(const std::vector<Named>& all, const char* what) {
  std::set<std::string> seen;
  for (const Named& one : all) {
    if (one.name.empty())
      throw Error(std::string("report: a ") + what + " has no name; name it in the batch file");
    if (!seen.insert(one.name).second)
      throw Error(std::string("report: two ") + what + "s are called '" + one.name +
                  "'; names must differ");
  }
}

bool isShare(double value) {
  return std::isnan(value) || (value >= 0 && value <= 1);
}

bool allFinite(const std::vector<Eigen::Vector2d>& points) {
  return std::all_of(points.begin(), points.end(),
                     [](const Eigen::Vector2d& p) { return p.allFinite(); });
}

void requireValid(const SessionResult& result, const std::string& where) {
  if (!isShare(result.mapShare))
    throw Error(where + "f_map is " + std::to_string(result.mapShare) +
                "; it is a share, from 0 to 1");
  for (const BatchRun& run : result.runs)
    for (double share : {run.health.ok, run.health.degraded, run.health.lost})
      if (!isShare(share))
        throw Error(where + "run " + std::to_string(run.run) +
                    " has a share of scans outside 0 to 1");
  if (result.score)
    for (const MapScore* score :
         {&result.score->near, &result.score->oneToOne, &result.score->oneToOneHalf})
      if (!isShare(score->precision) || !(score->recall >= 0) || !isShare(score->f1 / 2))
        throw Error(where + "the score of its map is not one: precision " +
                    std::to_string(score->precision) + ", recall " + std::to_string(score->recall) +
                    ", F1 " + std::to_string(score->f1));
  const SessionPlots& plots = result.plots;
  if (!allFinite(plots.mapPoles) || !allFinite(plots.truth) || !allFinite(plots.estimate))
    throw Error(where + "a coordinate of its plots is not finite; check the trajectories and map");
  if (!(plots.position.binWidth > 0) || !std::isfinite(plots.position.binWidth))
    throw Error(where + "the error over distance needs bins of positive width");
  for (const ErrorHistogram* histogram : {&plots.positionErrors, &plots.headingErrors})
    if (histogram->counts.size() != ErrorHistogram::bins)
      throw Error(where + "a histogram has " + std::to_string(histogram->counts.size()) +
                  " bins; it needs " + std::to_string(ErrorHistogram::bins));
}

}  // namespace

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

void ErrorHistogram::add(const ErrorHistogram& other) {
  for (std::size_t i = 0; i < bins; ++i) counts[i] += other.counts[i];
}

std::uint64_t ErrorHistogram::total() const {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

const SessionResult* BatchResults::find(std::size_t configuration, std::size_t session) const {
  const auto found = std::find_if(results.begin(), results.end(), [&](const SessionResult& r) {
    return r.configuration == configuration && r.session == session;
  });
  return found == results.end() ? nullptr : &*found;
}

void BatchResults::validate() const {
  if (configurations.empty() || sessions.empty())
    throw Error("report: batch '" + name + "' has no " +
                (configurations.empty() ? "settings" : "sessions") +
                "; there is nothing to report");
  if (!(lostBound > 0)) throw Error("report: the bound of lost runs must be positive, in metres");
  requireNames(configurations, "setting");
  requireNames(sessions, "session");
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const SessionResult& result : results) {
    if (result.configuration >= configurations.size() || result.session >= sessions.size())
      throw Error("report: a result belongs to setting " + std::to_string(result.configuration) +
                  " and session " + std::to_string(result.session) + ", but there are only " +
                  std::to_string(configurations.size()) + " and " +
                  std::to_string(sessions.size()));
    const std::string where = "report: session '" + sessions[result.session].name + "', setting '" +
                              configurations[result.configuration].name + "': ";
    if (!seen.insert({result.configuration, result.session}).second)
      throw Error(where + "there are two results; there can be one");
    requireValid(result, where);
  }
}

}  // namespace polemcl::report
