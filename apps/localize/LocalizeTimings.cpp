#include "localize/LocalizeTimings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace polemcl::apps {
namespace {

const std::pair<const char*, LatencyHistogram LocalizeTimings::*> stages[] = {
    {"read", &LocalizeTimings::read},
    {"extract", &LocalizeTimings::extract},
    {"step", &LocalizeTimings::step},
    {"write", &LocalizeTimings::write},
    {"total", &LocalizeTimings::total}};

constexpr double milliseconds = 1e3;  // in a second

}  // namespace

void LatencyHistogram::add(double seconds) {
  const double above = std::log(std::clamp(seconds, shortest, longest) / shortest);
  const auto bin = static_cast<std::size_t>(above / std::log(binRatio));
  ++m_counts[std::min(bin, bins - 1)];
  ++m_count;
  m_sum += seconds;
  m_worst = std::max(m_worst, seconds);
}

double LatencyHistogram::percentile(double share) const {
  if (m_count == 0) return 0;
  const auto rank =
      static_cast<std::uint64_t>(std::max(1.0, std::ceil(share * static_cast<double>(m_count))));
  std::size_t bin = 0;
  for (std::uint64_t below = m_counts[0]; below < rank && bin + 1 < bins; below += m_counts[bin])
    ++bin;
  const double middle = shortest * std::pow(binRatio, static_cast<double>(bin) + 0.5);
  return std::min(middle, m_worst);
}

nlohmann::ordered_json timingsJson(const LocalizeTimings& timings) {
  nlohmann::ordered_json json;
  json["wall_s"] = timings.wallSeconds;
  json["rate"] = timings.rate ? nlohmann::ordered_json(*timings.rate) : "max";
  json["filter_s"] = timings.filterSeconds;
  for (const auto& [name, member] : stages) {
    const LatencyHistogram& stage = timings.*member;
    if (stage.count() == 0) continue;
    json["latency_ms"][name] = {{"median", milliseconds * stage.percentile(0.5)},
                                {"p99", milliseconds * stage.percentile(0.99)},
                                {"p99.9", milliseconds * stage.percentile(0.999)},
                                {"worst", milliseconds * stage.worst()},
                                {"count", stage.count()}};
  }
  return json;
}

std::string timingsLine(const LocalizeTimings& timings) {
  std::string line = "latency in ms (median, 99 %, worst):";
  const char* separator = " ";
  for (const auto& [name, member] : stages) {
    const LatencyHistogram& stage = timings.*member;
    if (stage.count() == 0) continue;
    char text[100];
    std::snprintf(text, sizeof text, "%s%s %.3g %.3g %.3g", separator, name,
                  milliseconds * stage.percentile(0.5), milliseconds * stage.percentile(0.99),
                  milliseconds * stage.worst());
    line += text;
    separator = "; ";
  }
  return line;
}

}  // namespace polemcl::apps
