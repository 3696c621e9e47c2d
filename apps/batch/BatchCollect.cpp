#include "batch/BatchCollect.h"

#include <mrpt/system/os.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <thread>

#include "batch/BatchCommands.h"
#include "cli/Version.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "io/data/Trajectory.h"
#include "io/file/AtomicFile.h"
#include "io/file/Bytes.h"
#include "io/file/Process.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "report/batch/BatchJson.h"
#include "report/batch/BatchMeasures.h"
#include "report/batch/PublishedResults.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

using report::noFigure;

/// Without the sections that tell of simulation, views and numbers of runs: a batch has its own.
std::string settingsShown(const std::string& ini) {
  std::string shown;
  for (std::size_t begin = 0; begin < ini.size();) {  // sections are apart by an empty line
    const std::size_t end = std::min(ini.find("\n\n", begin), ini.size());
    const std::string section = ini.substr(begin, end - begin);
    begin = end + 2;
    const auto is = [&](const char* name) { return section.find(name) != std::string::npos; };
    if (!is("[world]\n") && !is("[simulation]\n") && !is("[view]\n") && !is("[runs]\n"))
      shown += (shown.empty() ? "" : "\n\n") + section;
  }
  return shown;
}

std::string protocolOf(const BatchConfiguration& configuration) {
  const auto& maps = configuration.mapSessions;
  const std::string sessions =
      maps.size() == 1 ? "session " + maps.front() : std::to_string(maps.size()) + " sessions";
  if (configuration.protocol == MapProtocol::each)
    return configuration.sessions.empty()
               ? "A map of each session"
               : "A map of each session, which is localized in it (its own data is in it)";
  if (configuration.sessions.empty()) return "One map of " + sessions;
  if (configuration.map == MapTime::finished) {
    const bool own = std::any_of(maps.begin(), maps.end(), [&](const std::string& name) {
      return has(configuration.sessions, name);
    });
    return "One map of " + sessions + " for all" +
           (own ? "; sessions that made it are localized in it as well (their own data is in it)"
                : "; no session is localized in its own data");
  }
  if (maps.size() == 1) return "One map of " + sessions + ", never changed; later sessions in it";
  return configuration.protocol == MapProtocol::upkeep
             ? "Each session in the map as earlier ones left it, kept up session by session"
             : "Each session in one map of all earlier ones";
}

double lengthOf(const std::vector<StampedPose2D>& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += std::hypot(path[i].pose.x - path[i - 1].pose.x, path[i].pose.y - path[i - 1].pose.y);
  return length;
}

/// Reads the files of one batch.
class Collector {
 public:
  Collector(const BatchFolder& folder, const BatchPlan& plan, const BatchSpec& spec,
            const std::map<std::string, std::string>& failures)
      : m_folder(folder), m_plan(plan), m_spec(spec), m_failures(failures) {}

  report::BatchResults collect() {
    addFacts();
    for (const auto& experiment : m_plan.experiments) addExperiment(experiment);
    for (const auto& [task, reason] : m_failures)
      m_results.failures.push_back({task, reason, logOf(task)});
    return std::move(m_results);
  }

 private:
  static std::string logOf(const std::string& task) { return "logs/" + task + ".log"; }

  void addFacts() {
    m_results.name = m_spec.name;
    m_results.title = m_spec.title.empty() ? m_spec.name : m_spec.title;
    m_results.dataset = m_spec.published == "none" ? "" : m_spec.published;
    if (!m_spec.publishedSessions.empty())
      m_results.published = report::readPublishedSessions(m_spec.publishedSessions);
    m_results.versions = {std::string(version()) + " (build " + buildIdentity() + ")",
                          mrpt::system::MRPT_getVersion(), "GCC " __VERSION__};
    for (const auto& configuration : m_spec.configurations) {
      const fs::path config = m_folder.path() / "settings" / (configuration.name + ".ini");
      m_results.configurations.push_back({configuration.name, configuration.title,
                                          protocolOf(configuration),
                                          settingsShown(io::readBytes(config))});
    }
    for (const auto& session : m_spec.sessions) {
      if (!isUsed(session.name)) continue;
      report::BatchSession entry{session.name, session.date};
      if (const auto* truth = truthOf(session.name)) {
        entry.length = lengthOf(*truth);
        entry.scans = truth->size();
      }
      m_results.sessions.push_back(entry);
    }
  }

  bool isUsed(const std::string& session) const {
    return std::any_of(m_plan.experiments.begin(), m_plan.experiments.end(),
                       [&](const Experiment& experiment) { return experiment.session == session; });
  }

  bool isDone(const std::string& task) const {
    return !task.empty() && m_folder.isDone(m_plan.task(task));
  }

  std::string failureOf(const std::string& task) const {
    const auto known = m_failures.find(task);
    if (known != m_failures.end()) return known->second;
    return isDone(task) ? "" : "not done, as what it needs failed";
  }

  /// True poses of a session; null while its poles are not done.
  const std::vector<StampedPose2D>* truthOf(const std::string& session) {
    const auto known = m_truth.find(session);
    if (known != m_truth.end()) return &known->second;
    const std::string task = TaskPath{TaskKind::poles, {session}}.id();
    if (!isDone(task) || m_broken.count(session)) return nullptr;
    try {
      return &(m_truth[session] = io::readPlanarTum(m_folder.work(task) / (session + ".tum")));
    } catch (const Error& error) {
      m_broken.insert(session);
      m_results.failures.push_back({task, error.what(), "logs/" + task + ".log"});
      return nullptr;
    }
  }

  const io::PoleMapData& mapOf(const std::string& task) {
    const auto known = m_maps.find(task);
    if (known != m_maps.end()) return known->second;
    return m_maps[task] = io::readPoleMap(m_folder.work(task) / "map.polemap");
  }

  template <class Named>
  static std::size_t indexOf(const std::vector<Named>& all, const std::string& name) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Named& entry) { return entry.name == name; });
    return static_cast<std::size_t>(found - all.begin());
  }

  /// Share of a session's scans that its map used, as pole-map noted it.
  double mapShare(const Experiment& experiment) {
    if (!isDone(experiment.ownMap)) return noFigure;
    const auto& info = mapOf(experiment.ownMap).info;
    const auto share = info.find("f_map." + experiment.session);
    if (share == info.end()) return noFigure;
    return io::parseNumber(share->second).value_or(noFigure);
  }

  /// Scores of the map that the session completes; none when there are none.
  std::optional<report::MapScores> scoresOf(const Experiment& experiment) const {
    if (!isDone(experiment.score)) return {};
    report::MapScores scores;
    const std::string& truth = m_spec.session(experiment.session).truthMap;
    scores.truth = truth == truthFromLabels ? truth : fs::path(truth).filename().string();
    MapScore* const all[] = {&scores.near, &scores.oneToOne, &scores.oneToOneHalf};
    for (std::size_t i = 0; i < std::size(scoreFiles); ++i) {
      const Json json = readJson(m_folder.work(experiment.score) / scoreFiles[i]);
      json.at("precision").get_to(all[i]->precision);
      json.at("recall").get_to(all[i]->recall);
      json.at("f1").get_to(all[i]->f1);
      json.at("matches").get_to(all[i]->matches);
      json.at("map_poles").get_to(all[i]->mapPoles);
      json.at("truth_poles").get_to(all[i]->truthPoles);
    }
    return scores;
  }

  void addExperiment(const Experiment& experiment) {
    report::SessionResult result;
    result.configuration = indexOf(m_results.configurations, experiment.configuration);
    result.session = indexOf(m_results.sessions, experiment.session);
    result.mapShare = mapShare(experiment);
    result.score = scoresOf(experiment);
    if (isDone(experiment.map)) {
      const auto& map = mapOf(experiment.map);
      result.mapPoles = map.poles.size();
      for (const auto& pole : map.poles) result.plots.mapPoles.push_back({pole.x, pole.y});
    }
    if (const auto* truth = truthOf(experiment.session))
      result.plots.truth = report::thinPath(*truth);
    for (std::size_t i = 0; i < experiment.runs.size(); ++i)
      result.runs.push_back(readRun(experiment, i, result));
    m_results.results.push_back(std::move(result));
  }

  report::BatchRun readRun(const Experiment& experiment, std::size_t i,
                           report::SessionResult& result) {
    report::BatchRun run;
    run.run = i;
    run.seed = experiment.seeds[i];
    run.failure = failureOf(experiment.runs[i]);
    if (run.failure.empty() && !truthOf(experiment.session)) run.failure = "no true poses";
    if (!run.failure.empty()) return run;
    const fs::path out = m_folder.work(experiment.runs[i]) / "out";
    const Json summary = readJson(out / "summary.json");
    auto& session = m_results.sessions[result.session];
    session.scans = summary.at("scans");
    session.polesPerScan = summary.at("poles_per_scan");
    const Json& health = summary.at("runs").at(0).at("health");
    run.health = healthOf(health);
    if (health.at("first_pose_scan").is_null()) return run;  // it never knew where it was
    try {
      judge(out / "run_00.tum", *truthOf(experiment.session), run, result.plots);
    } catch (const Error& error) {
      run.failure = error.what();
      m_results.failures.push_back({experiment.runs[i], run.failure, logOf(experiment.runs[i])});
    }
    return run;
  }

  static report::HealthShares healthOf(const Json& json) {
    report::HealthShares shares;
    const double ok = json.at("ok"), degraded = json.at("degraded"), lost = json.at("lost");
    const double all = ok + degraded + lost;
    shares.ok = ok / all;
    shares.degraded = degraded / all;
    shares.lost = lost / all;
    if (!json.at("first_pose_scan").is_null()) shares.firstPoseScan = json.at("first_pose_scan");
    shares.relocalizations = json.at("relocalizations");
    return shares;
  }

  void judge(const fs::path& file, const std::vector<StampedPose2D>& truth, report::BatchRun& run,
             report::SessionPlots& plots) const {
    const auto estimate = io::readPlanarTum(file);
    const auto sampling = m_spec.perMetre ? Sampling::perMetre : Sampling::perPose;
    const TrajectoryErrors errors = evaluateTrajectory(truth, estimate, sampling);
    run.errors = report::errorMetrics(errors, truth);
    report::addErrors(plots, errors);
    if (run.run > 0) return;
    plots.estimate = report::thinPath(estimate);
    plots.position = report::positionOverDistance(errors, truth);
  }

  const BatchFolder& m_folder;
  const BatchPlan& m_plan;
  const BatchSpec& m_spec;
  const std::map<std::string, std::string>& m_failures;
  report::BatchResults m_results;
  std::map<std::string, std::vector<StampedPose2D>> m_truth;
  std::set<std::string> m_broken;  ///< sessions whose true poses cannot be read
  std::map<std::string, io::PoleMapData> m_maps;
};

/// "2 cores, Intel Xeon".
std::string machine() {
  std::string name;
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("model name", 0) == 0 && line.find(':') != std::string::npos) {
      name = ", " + std::string(io::trimmed(line.substr(line.find(':') + 1)));
      break;
    }
  return std::to_string(std::thread::hardware_concurrency()) + " cores" + name;
}

}  // namespace

report::BatchResults collectBatch(const BatchFolder& folder, const BatchPlan& plan,
                                  const BatchSpec& spec,
                                  const std::map<std::string, std::string>& failures,
                                  const std::string& command) {
  report::BatchResults results = Collector(folder, plan, spec, failures).collect();
  results.command = command;
  return results;
}

Json collectTimings(const BatchFolder& folder, const BatchPlan& plan) {
  Json timings{{"machine", machine()}, {"wall_s", nullptr}, {"jobs", 0}, {"tasks", Json::array()}};
  Json& kinds = timings["tasks"];
  for (const auto& task : plan.tasks) {
    const double seconds = folder.seconds(task.id);
    if (std::isnan(seconds)) continue;
    auto kind = std::find_if(kinds.begin(), kinds.end(),
                             [&](const Json& times) { return times["kind"] == name(task.kind); });
    if (kind == kinds.end())
      kind = kinds.insert(kind, Json{{"kind", name(task.kind)}, {"seconds", Json::array()}});
    (*kind)["seconds"].push_back(seconds);
  }
  return timings;
}

void removeResults(const BatchFolder& folder, bool timings) {
  for (const char* name :
       {"results.json", "report.html", "table.tex", "runs.csv", "sessions.csv", "maps.csv"})
    fs::remove(folder.path() / name);
  if (timings) fs::remove(folder.path() / "timings.json");
  io::syncFolder(folder.path());
}

void writeBatchFiles(const BatchFolder& folder, const report::BatchResults& results) {
  const std::string text = report::resultsJson(results);
  try {
    std::vector<std::string> command = io::pythonScript("report.py");
    command.insert(command.end(), {fs::absolute(folder.path()).string(), "-"});
    io::runFilter(command, text);
  } catch (const Error& error) {
    const fs::path file = folder.path() / "results.json";
    if (!fs::exists(file)) io::writeFile(file, text);
    throw Error(
        "report.html, table.tex, the CSV files and `summary` of results.json are not written, "
        "all other results are: " +
        std::string(error.what()));
  }
}

}  // namespace polemcl::apps
