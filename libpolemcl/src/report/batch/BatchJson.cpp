#include "report/batch/BatchJson.h"

#include <nlohmann/json.hpp>

namespace polemcl::report {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* resultsFormat = "polemcl batch results";
constexpr unsigned resultsVersion = 2;

// NaN becomes null by itself.
Json jsonOf(const ErrorMetrics& errors) {
  return {{"pos_mean", errors.posMean},
          {"pos_rmse", errors.posRmse},
          {"pos_max", errors.posMax},
          {"pos_end", errors.posEnd},
          {"lat_mean", errors.latMean},
          {"lat_std", errors.latStd},
          {"lon_mean", errors.lonMean},
          {"lon_std", errors.lonStd},
          {"x_rmse", errors.xRmse},
          {"y_rmse", errors.yRmse},
          {"ang_mean_deg", errors.angMeanDeg},
          {"ang_std_deg", errors.angStdDeg},
          {"ang_rmse_deg", errors.angRmseDeg},
          {"poses", errors.poses},
          {"unmatched", errors.unmatched}};
}

Json jsonOf(const HealthShares& health) {
  return {{"ok", health.ok},
          {"degraded", health.degraded},
          {"lost", health.lost},
          {"first_pose_scan", health.firstPoseScan ? Json(*health.firstPoseScan) : Json()},
          {"relocalizations", health.relocalizations}};
}

Json jsonOf(const BatchRun& run, double lostBound) {
  return {{"run", run.run},
          {"seed", run.seed},
          {"state", stateOf(run, lostBound)},
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
  return {{"truth", scores.truth},
          {"near_1m", jsonOf(scores.near)},
          {"one_to_one_1m", jsonOf(scores.oneToOne)},
          {"one_to_one_0.5m", jsonOf(scores.oneToOneHalf)}};
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
  json["results"] = Json::array();
  for (std::size_t i = 0; i < batch.configurations.size(); ++i)
    for (std::size_t k = 0; k < batch.sessions.size(); ++k)
      if (const SessionResult* result = batch.find(i, k))
        json["results"].push_back(jsonOf(*result, batch));
  return json;
}

}  // namespace

std::string resultsJson(const BatchResults& results) {
  // What a failed task said need not be UTF-8.
  return jsonOf(results).dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace polemcl::report
