#include "localize/LocalizeTimings.h"

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
