#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "io/file/AtomicFile.h"
#include "report/batch/BatchFiles.h"
#include "report/batch/RunMetrics.h"

namespace polemcl::report {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* resultsFormat = "polemcl batch results";
constexpr unsigned resultsVersion = 2;

// NaN becomes null by itself.
Json jsonOf(const ErrorMetrics& errors) {
  Json json;
  for (const MetricName& name : metricNames) json[name.key] = errors.*name.figure;
  json["poses"] = errors.poses;
  json["unmatched"] = errors.unmatched;
  return json;
}

Json jsonOf(const HealthShares& health) {
  Json json;
  for (const ShareName& name : shareNames) json[name.key] = health.*name.share;
  json["first_pose_scan"] = health.firstPoseScan ? Json(*health.firstPoseScan) : Json();
  json["relocalizations"] = health.relocalizations;
  return json;
}

Json jsonOf(const BatchRun& run, double lostBound) {
  return {{"run", run.run},
          {"seed", run.seed},
          {"state", name(stateOf(run, lostBound))},
          {"failure", run.failure},
          {"errors", jsonOf(run.errors)},
          {"health", jsonOf(run.health)}};
}

/// x0, y0, x1, y1, ...
Json jsonOf(const std::vector<Eigen::Vector2d>& points) {
  Json json = Json::array();
  for (const Eigen::Vector2d& point : points) {
    json.push_back(point.x());
    json.push_back(point.y());
  }
  return json;
}

Json jsonOf(const SessionPlots& plots) {
  return {{"map_poles_xy", jsonOf(plots.mapPoles)},
          {"truth_xy", jsonOf(plots.truth)},
          {"estimate_xy", jsonOf(plots.estimate)},
          {"position_bin_m", plots.position.binWidth},
          {"position_largest_m", plots.position.largest},
          {"position_histogram", plots.positionErrors.counts},
          {"heading_histogram", plots.headingErrors.counts}};
}

Json jsonOf(const MapScore& score) {
  return {{"precision", score.precision},
          {"recall", score.recall},
          {"f1", score.f1},
          {"matches", score.matches},
          {"map_poles", score.mapPoles},
          {"truth_poles", score.truthPoles}};
}

Json jsonOf(const MapScores& scores) {
  Json json;
  json["truth"] = scores.truth;
  for (const ScoreName& name : scoreNames) json[name.key] = jsonOf(scores.*name.score);
  return json;
}

Json jsonOf(const SessionResult& result, const BatchResults& batch) {
  Json json;
  json["setting"] = batch.configurations[result.configuration].name;
  json["session"] = batch.sessions[result.session].name;
  json["f_map"] = result.mapShare;
  json["map_poles"] = result.mapPoles;
  json["map_score"] = result.score ? jsonOf(*result.score) : Json();
  json["runs"] = Json::array();
  for (const BatchRun& run : result.runs) json["runs"].push_back(jsonOf(run, batch.lostBound));
  json["plots"] = jsonOf(result.plots);
  return json;
}

Json jsonOf(const Spread& spread) {
  return {{"mean", spread.mean},
          {"deviation", spread.deviation},
          {"largest", spread.largest},
          {"count", spread.count}};
}

Json jsonOf(const MetricSpreads& figures) {
  Json json;
  for (const MetricName& name : metricNames) json[name.key] = jsonOf(figures.*name.spread);
  json["axis_rmse"] = jsonOf(figures.axisRmse);
  for (const ShareName& name : shareNames)
    json[std::string(name.key) + "_share"] = jsonOf(figures.*name.spread);
  return json;
}

void setCounts(Json& json, const RunCounts& counts) {
  json["runs"] = counts.runs;
  json["lost"] = counts.lost;
  json["failed"] = counts.failed;
}

Json jsonOf(const ConfigurationSummary& summary, const BatchResults& batch,
            std::size_t configuration) {
  Json json;
  json["setting"] = batch.configurations[configuration].name;
  setCounts(json, summary.counts);
  json["localized_sessions"] = summary.localized;
  json["lost_sessions"] = summary.lostSessions;
  json["last_over_first"] = summary.lastOverFirst;
  json["f_map"] = jsonOf(summary.mapShare);
  json["scored_maps"] = summary.scores.maps;
  for (const ScoreName& name : scoreNames) {
    const ScoreMeans& means = summary.scores.*name.means;
    json["map_score"][name.key] = {
        {"precision", means.precision}, {"recall", means.recall}, {"f1", means.f1}};
  }
  json["figures"] = jsonOf(summary.figures);
  json["sessions"] = Json::array();
  for (const SessionSummary& session : summary.sessions) {
    Json one;
    one["session"] = batch.sessions[session.session].name;
    one["f_map"] = session.mapShare;
    one["map_poles"] = session.mapPoles;
    setCounts(one, session.counts);
    one["relocalizations"] = session.relocalizations;
    one["figures"] = jsonOf(session.figures);
    json["sessions"].push_back(std::move(one));
  }
  return json;
}

Json jsonOf(const BatchResults& batch) {
  Json json;
  json["format"] = resultsFormat;
  json["format_version"] = resultsVersion;
  json["name"] = batch.name;
  json["title"] = batch.title;
  json["dataset"] = batch.dataset;
  json["date"] = batch.date;
  json["command"] = batch.command;
  json["versions"] = {{"polemcl", batch.versions.polemcl},
                      {"mrpt", batch.versions.mrpt},
                      {"compiler", batch.versions.compiler}};
  json["lost_bound_m"] = batch.lostBound;
  json["settings"] = Json::array();
  for (const BatchConfiguration& configuration : batch.configurations)
    json["settings"].push_back({{"name", configuration.name},
                                {"description", configuration.description},
                                {"protocol", configuration.protocol},
                                {"config", configuration.config}});
  json["sessions"] = Json::array();
  for (const BatchSession& session : batch.sessions)
    json["sessions"].push_back({{"name", session.name},
                                {"date", session.date},
                                {"length_m", session.length},
                                {"scans", session.scans},
                                {"poles_per_scan", session.polesPerScan}});
  json["published_sessions"] = Json::array();
  for (const PublishedSession& one : batch.published)
    json["published_sessions"].push_back({{"system", one.system},
                                          {"session", one.session},
                                          {"f_map", one.mapShare},
                                          {"pos_mean", one.posMean},
                                          {"pos_rmse", one.posRmse},
                                          {"ang_mean_deg", one.angMeanDeg},
                                          {"ang_rmse_deg", one.angRmseDeg}});
  json["failures"] = Json::array();
  for (const FailedTask& task : batch.failures)
    json["failures"].push_back({{"task", task.task}, {"reason", task.reason}, {"log", task.log}});
  json["summary"] = Json::array();
  const Summaries summaries = summarize(batch);
  for (std::size_t i = 0; i < summaries.size(); ++i)
    json["summary"].push_back(jsonOf(summaries[i], batch, i));
  json["results"] = Json::array();
  for (std::size_t i = 0; i < batch.configurations.size(); ++i)
    for (std::size_t k = 0; k < batch.sessions.size(); ++k)
      if (const SessionResult* result = batch.find(i, k))
        json["results"].push_back(jsonOf(*result, batch));
  return json;
}

bool fitsALine(const Json& value) {
  return value.empty() ||
         (value.is_array() && std::none_of(value.begin(), value.end(), [](const Json& element) {
            return element.is_structured();
          }));
}

/// Indented by two, but lists of plain values on one line: a path is not a page.
void print(std::ostream& out, const Json& value, std::size_t indent) {
  const auto text = [](const Json& part) {
    return part.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  if (!value.is_structured() || fitsALine(value)) {
    out << text(value);
    return;
  }
  const bool object = value.is_object();
  const std::string margin(indent + 2, ' ');
  bool first = true;
  out << (object ? '{' : '[');
  for (auto element = value.begin(); element != value.end(); ++element) {
    out << (first ? "\n" : ",\n") << margin;
    if (object) out << text(element.key()) << ": ";
    print(out, *element, indent + 2);
    first = false;
  }
  out << '\n' << std::string(indent, ' ') << (object ? '}' : ']');
}

}  // namespace

void writeResultsJson(const std::filesystem::path& file, const BatchResults& results) {
  io::AtomicFile out(file);
  print(out.stream(), jsonOf(results), 0);
  out.stream() << '\n';
  out.commit();
}

}  // namespace polemcl::report
