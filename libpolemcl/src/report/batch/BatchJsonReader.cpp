#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/common/Types.h"
#include "report/batch/BatchFiles.h"
#include "report/batch/BatchJson.h"
#include "report/batch/RunMetrics.h"

namespace polemcl::report {
namespace {

using ParsedJson = nlohmann::json;

/// A value with the way to it ("results[3].runs[0].seed"), for messages.
class Node {
 public:
  Node(const ParsedJson& value, std::string path) : m_value(value), m_path(std::move(path)) {}

  Node operator[](const char* key) const {
    if (!m_value.is_object()) throw expected("an object");
    const auto found = m_value.find(key);
    const std::string path = m_path.empty() ? key : m_path + "." + key;
    if (found == m_value.end()) throw Error("key '" + path + "' is missing");
    return {*found, path};
  }
  bool isNull() const { return m_value.is_null(); }
  std::vector<Node> elements() const {
    if (!m_value.is_array()) throw expected("a list");
    std::vector<Node> all;
    for (std::size_t i = 0; i < m_value.size(); ++i)
      all.emplace_back(m_value[i], m_path + "[" + std::to_string(i) + "]");
    return all;
  }
  std::string text() const {
    if (!m_value.is_string()) throw expected("text");
    return m_value.get<std::string>();
  }
  std::uint64_t count() const {
    if (!m_value.is_number_unsigned()) throw expected("a count");
    return m_value.get<std::uint64_t>();
  }
  std::optional<std::size_t> optionalCount() const {
    return m_value.is_null() ? std::nullopt : std::optional<std::size_t>(count());
  }
  /// null stands for a figure that does not exist.
  double figure() const {
    if (m_value.is_null()) return noFigure;
    if (!m_value.is_number()) throw expected("a number or null");
    return m_value.get<double>();
  }
  std::vector<double> figures() const {
    std::vector<double> values;
    for (const Node& element : elements()) values.push_back(element.figure());
    return values;
  }
  std::vector<Eigen::Vector2d> points() const {
    const std::vector<double> numbers = figures();
    if (numbers.size() % 2 != 0) throw expected("pairs of x and y");
    std::vector<Eigen::Vector2d> all;
    for (std::size_t i = 0; i < numbers.size(); i += 2)
      all.emplace_back(numbers[i], numbers[i + 1]);
    return all;
  }
  std::size_t indexIn(const std::map<std::string, std::size_t>& names) const {
    const auto found = names.find(text());
    if (found == names.end()) throw expected("one of the names listed before");
    return found->second;
  }

 private:
  Error expected(const std::string& what) const {
    return Error("key '" + m_path + "' is not " + what);
  }
  const ParsedJson& m_value;
  std::string m_path;
};

ErrorHistogram histogram(const Node& node) {
  ErrorHistogram histogram;
  histogram.counts.clear();
  for (const Node& element : node.elements()) histogram.counts.push_back(element.count());
  return histogram;
}

BatchRun run(const Node& node) {
  BatchRun run;
  run.run = node["run"].count();
  run.seed = node["seed"].count();
  run.failure = node["failure"].text();
  const Node errors = node["errors"], health = node["health"];
  for (const MetricName& name : metricNames) run.errors.*name.figure = errors[name.key].figure();
  run.errors.poses = errors["poses"].count();
  run.errors.unmatched = errors["unmatched"].count();
  for (const ShareName& name : shareNames) run.health.*name.share = health[name.key].figure();
  run.health.firstPoseScan = health["first_pose_scan"].optionalCount();
  run.health.relocalizations = health["relocalizations"].count();
  return run;
}

MapScore mapScore(const Node& node) {
  MapScore score;
  score.precision = node["precision"].figure();
  score.recall = node["recall"].figure();
  score.f1 = node["f1"].figure();
  score.matches = node["matches"].count();
  score.mapPoles = node["map_poles"].count();
  score.truthPoles = node["truth_poles"].count();
  return score;
}

std::optional<MapScores> mapScores(const Node& node) {
  if (node.isNull()) return {};
  MapScores scores;
  scores.truth = node["truth"].text();
  for (const ScoreName& name : scoreNames) scores.*name.score = mapScore(node[name.key]);
  return scores;
}

SessionPlots plots(const Node& node) {
  SessionPlots plots;
  plots.mapPoles = node["map_poles_xy"].points();
  plots.truth = node["truth_xy"].points();
  plots.estimate = node["estimate_xy"].points();
  plots.position.binWidth = node["position_bin_m"].figure();
  plots.position.largest = node["position_largest_m"].figures();
  plots.positionErrors = histogram(node["position_histogram"]);
  plots.headingErrors = histogram(node["heading_histogram"]);
  return plots;
}

void readLists(BatchResults& batch, const Node& root) {
  for (const Node& node : root["settings"].elements())
    batch.configurations.push_back({node["name"].text(), node["description"].text(),
                                    node["protocol"].text(), node["config"].text()});
  for (const Node& node : root["sessions"].elements())
    batch.sessions.push_back({node["name"].text(), node["date"].text(), node["length_m"].figure(),
                              node["scans"].count(), node["poles_per_scan"].figure()});
  for (const Node& node : root["published_sessions"].elements())
    batch.published.push_back({node["system"].text(), node["session"].text(),
                               node["f_map"].figure(), node["pos_mean"].figure(),
                               node["pos_rmse"].figure(), node["ang_mean_deg"].figure(),
                               node["ang_rmse_deg"].figure()});
  for (const Node& node : root["failures"].elements())
    batch.failures.push_back({node["task"].text(), node["reason"].text(), node["log"].text()});
}

void readResults(BatchResults& batch, const Node& root) {
  std::map<std::string, std::size_t> settings, sessions;
  for (std::size_t i = 0; i < batch.configurations.size(); ++i)
    settings[batch.configurations[i].name] = i;
  for (std::size_t i = 0; i < batch.sessions.size(); ++i) sessions[batch.sessions[i].name] = i;
  for (const Node& node : root["results"].elements()) {
    SessionResult result;
    result.configuration = node["setting"].indexIn(settings);
    result.session = node["session"].indexIn(sessions);
    result.mapShare = node["f_map"].figure();
    result.mapPoles = node["map_poles"].count();
    result.score = mapScores(node["map_score"]);
    for (const Node& one : node["runs"].elements()) result.runs.push_back(run(one));
    result.plots = plots(node["plots"]);
    batch.results.push_back(std::move(result));
  }
}

BatchResults resultsOf(const Node& root) {
  if (root["format"].text() != resultsFormat)
    throw Error("key 'format' is not '" + std::string(resultsFormat) + "'");
  if (root["format_version"].count() != resultsVersion)
    throw Error("its format version is " + std::to_string(root["format_version"].count()) +
                "; this program reads version " + std::to_string(resultsVersion));
  BatchResults batch;
  batch.name = root["name"].text();
  batch.title = root["title"].text();
  batch.dataset = root["dataset"].text();
  batch.date = root["date"].text();
  batch.command = root["command"].text();
  const Node versions = root["versions"];
  batch.versions = {versions["polemcl"].text(), versions["mrpt"].text(),
                    versions["compiler"].text()};
  batch.lostBound = root["lost_bound_m"].figure();
  readLists(batch, root);
  readResults(batch, root);
  batch.validate();
  return batch;
}

}  // namespace

BatchResults readResultsJson(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be read; run the batch to its end first");
  try {
    const ParsedJson json = ParsedJson::parse(in);
    return resultsOf({json, ""});
  } catch (const ParsedJson::exception& error) {
    throw Error(file.string() + ": no complete JSON file: " + error.what() +
                "; run the batch again with --resume");
  } catch (const Error& error) {
    throw Error(file.string() + ": no results of a batch: " + error.what());
  }
}

}  // namespace polemcl::report
