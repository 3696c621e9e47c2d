#include "batch/BatchPlan.h"

#include <mrpt/system/md5.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "batch/BatchCommands.h"
#include "batch/BatchSpec.h"
#include "cli/Settings.h"
#include "config/Config.h"
#include "io/file/Bytes.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

/// Values of `--set` for the poles of maps, where these are others than for localization, see
/// loadMappingSession().
std::vector<std::string> mapAssignments(const AllSettings& settings) {
  const double least = settings.map.minConfidence;
  std::vector<std::string> assignments;
  const auto add = [&](const std::string& section, const ExtractionOptions& extraction) {
    if (least > 0 && least != extraction.scanLine.minConfidence)
      assignments.push_back(section + ".min_confidence=" + io::significant(least, 9));
  };
  add("scan_line", settings.extraction);
  for (const LidarOptions& lidar : settings.vehicle.lidars)
    add("scan_line:" + lidar.label, lidar.extraction);
  return assignments;
}

/// What pole-extract writes depends on this: configurations with the same text share their poles.
std::string extractionText(AllSettings settings) {
  settings.motion.covarianceFactor = 1;  // applied when the poles are read
  ConfigWriter writer;
  bind(writer, settings.sensor);
  bind(writer, settings.extraction);
  bind(writer, settings.vehicle, settings.sensor, settings.extraction);
  bind(writer, settings.motion);
  std::string text = writer.text();
  for (const std::string& assignment : mapAssignments(settings)) text += assignment + '\n';
  return text;
}

/// Puts together one plan.
class Planner {
 public:
  Planner(const BatchSpec& spec, const std::string& build) : m_spec(spec) {
    m_plan.name = spec.name;
    m_plan.build = build;
  }

  BatchPlan plan() {
    requirePublished(m_spec);
    for (const auto& configuration : m_spec.configurations) freeze(configuration);
    requireInputs();
    for (const auto& session : m_spec.sessions)
      if (isUsed(session.name)) addPoles(session);
    for (const auto& session : m_spec.sessions)
      if (session.truthMap == truthFromLabels && isScoredByAny(session)) addTruth(session);
    for (const auto& configuration : m_spec.configurations) {
      addMaps(configuration);
      for (const auto& session : m_spec.sessions)
        if (isScored(configuration, session)) addScore(configuration, session);
      addExperiments(configuration);
    }
    for (const auto& [name, content] : m_plan.files) m_plan.sums[name] = mrpt::system::md5(content);
    sortTasks();
    setKeys();
    return std::move(m_plan);
  }

 private:
  bool isUsed(const std::string& session) const {
    return std::any_of(
        m_spec.configurations.begin(), m_spec.configurations.end(), [&](const auto& configuration) {
          return has(configuration.sessions, session) || has(configuration.mapSessions, session);
        });
  }

  bool isScoredByAny(const BatchSession& session) const {
    return std::any_of(m_spec.configurations.begin(), m_spec.configurations.end(),
                       [&](const auto& configuration) { return isScored(configuration, session); });
  }

  void requireInputs() const {
    std::string missing;  // of the first sessions: enough to see what is wrong
    int count = 0;
    for (const auto& session : m_spec.sessions) {
      if (!isUsed(session.name)) continue;
      const std::string what = inputObstacle(session, isScoredByAny(session));
      if (!what.empty() && ++count <= 3)
        missing += (count > 1 ? "; " : "") + session.name + ": " + what;
    }
    if (count > 0)
      throw Error("batch " + m_spec.name + ": inputs of " + std::to_string(count) +
                  " sessions are missing: " + missing + (count > 3 ? "; and so on" : "") +
                  "; check --data, [sessions] input and truth_map, or leave these sessions out");
  }

  /// A frozen file, as the commands of a task name it, whose outputs depend on it.
  static std::string frozen(const std::string& name, BatchTask& task) {
    task.frozen.push_back(name);
    return "../../" + name;
  }
  static std::string settingsOf(const std::string& configuration, BatchTask& task) {
    return frozen("settings/" + configuration + ".ini", task);
  }

  /// The same as frozen() for a file that settings name: it is copied into the batch's folder.
  std::string frozenCopy(const std::string& file, BatchTask& task) {
    if (file.empty()) return file;
    const std::string name = "files/" + fs::path(file).filename().string();
    const std::string content = io::readBytes(file);
    const auto [entry, isNew] = m_plan.files.emplace(name, content);
    if (!isNew && entry->second != content)
      throw Error("batch " + m_spec.name + ": two different files are called " +
                  fs::path(file).filename().string() + "; rename one of them");
    return frozen(name, task);
  }

  void freeze(const BatchConfiguration& configuration) {
    const AllSettings settings = settingsFor(m_spec, configuration);
    const auto [group, isNew] = m_groupOf.emplace(extractionText(settings), m_groups.size());
    m_group[configuration.name] = group->second;
    if (isNew) m_groups.push_back({configuration.name, mapAssignments(settings)});
    m_plan.files["settings/" + configuration.name + ".ini"] = settingsText(settings);
  }

  void addPoles(const BatchSession& session) {
    BatchTask task(polesPath(session.name));
    const std::string rawlog = session.name + ".rawlog", truth = session.name + ".tum";
    if (!hasGroups(session)) requireOneGroup(session);
    if (session.source == "simulated")
      simulate(session, task);
    else if (session.source == "poles")
      task.commands = {{"copy", session.input, rawlog},
                       {"copy", fs::path(session.input).replace_extension(".tum"), truth}};
    else
      import(session, task);
    task.outputs.push_back(truth);
    if (hasGroups(session)) {
      for (const auto& group : m_groups) {
        if (hasPoles(group, session.name)) task.outputs.push_back(group.name + "/" + rawlog);
        if (hasMapPoles(group, session.name))
          task.outputs.push_back(group.name + mapFolder + "/" + rawlog);
      }
    } else {
      task.outputs.push_back(rawlog);
    }
    m_plan.tasks.push_back(std::move(task));
  }

  void addTruth(const BatchSession& session) {
    BatchTask task(truthPath(session));
    task.commands = {labelsCommand(session)};
    task.outputs = {"truth.polemap"};
    m_plan.tasks.push_back(std::move(task));
  }

  void simulate(const BatchSession& session, BatchTask& task) {
    AllSettings settings = simulationFor(m_spec, session);
    for (std::string* file : {&settings.simulation.detections, &settings.simulation.world.track})
      *file = frozenCopy(*file, task);
    const std::string file = "settings/simulate." + session.name + ".ini";
    m_plan.files[file] = settingsText(settings);
    Command command = program("pole-simulate");
    append(command, {"--config", frozen(file, task), "--poles", session.name + ".rawlog"});
    task.commands = {command};
    task.outputs = {session.name + "_poles_gt.csv"};
  }

  void import(const BatchSession& session, BatchTask& task) {
    const std::string truth = session.name + ".tum";
    std::string scans = session.name + ".rawlog";
    if (session.source == "scans") {
      scans = session.input;
      task.commands = {{"copy", fs::path(session.input).replace_extension(".tum"), truth}};
    } else {
      task.commands = {importCommand(session, m_spec.seed)};
    }
    for (const auto& group : m_groups) {
      if (!hasPoles(group, session.name) && !hasMapPoles(group, session.name)) continue;
      const std::string rawlog = "/" + session.name + ".rawlog";
      Command command = program("pole-extract");
      append(command, {"--config", settingsOf(group.name, task), "--input", scans});
      Command forMaps = command;
      append(command, {"--output", group.name + rawlog});
      if (hasPoles(group, session.name)) task.commands.push_back(command);
      if (!hasMapPoles(group, session.name)) continue;
      for (const std::string& value : group.forMaps) append(forMaps, {"--set", value});
      append(forMaps, {"--output", group.name + mapFolder + rawlog});
      task.commands.push_back(forMaps);
    }
  }

  /// Stored and simulated poles are those of all configurations.
  static bool hasGroups(const BatchSession& session) {
    return session.source != "simulated" && session.source != "poles";
  }

  /// Settings of the extraction would be compared on the same poles.
  void requireOneGroup(const BatchSession& session) const {
    const std::string* first = nullptr;
    for (const Group& group : m_groups) {
      if (!hasPoles(group, session.name) && !hasMapPoles(group, session.name)) continue;
      if (first)
        throw Error("batch " + m_spec.name + ": settings " + *first + " and " + group.name +
                    " extract poles in different ways, but session " + session.name +
                    " (source = " + session.source +
                    ") has its poles already; give both the same extraction, or scans");
      first = &group.name;
    }
  }

  static TaskPath polesPath(const std::string& session) { return {TaskKind::poles, {session}}; }
  static TaskPath truthPath(const BatchSession& session) {
    return {TaskKind::truth, {session.name}};
  }
  static TaskPath scorePath(const BatchConfiguration& configuration, const std::string& session) {
    return {TaskKind::score, {configuration.name, session}};
  }
  static TaskPath mapPath(const BatchConfiguration& configuration, const std::string& session) {
    return {TaskKind::map, {configuration.name, session}};
  }

  std::string rawlogOf(const BatchConfiguration& configuration, const std::string& session,
                       bool forMaps = false) const {
    std::string folder;
    if (hasGroups(m_spec.session(session))) {
      const Group& group = m_groups[m_group.at(configuration.name)];
      folder = group.name + (forMaps && !group.forMaps.empty() ? mapFolder : "") + "/";
    }
    return polesPath(session).file(folder + session + ".rawlog");
  }
  static std::string truthOf(const std::string& session) {
    return polesPath(session).file(session + ".tum");
  }

  std::size_t placeOf(const std::string& session) const {
    for (std::size_t i = 0; i < m_spec.sessions.size(); ++i)
      if (m_spec.sessions[i].name == session) return i;
    return m_spec.sessions.size();
  }

  /// The map that a session is localized in: the number of its last map session, from 1.
  std::size_t mapFor(const BatchConfiguration& configuration, const std::string& session) const {
    const auto& maps = configuration.mapSessions;
    if (configuration.protocol == MapProtocol::each)
      return static_cast<std::size_t>(std::find(maps.begin(), maps.end(), session) - maps.begin()) +
             1;
    if (configuration.map == MapTime::finished) return maps.size();
    return static_cast<std::size_t>(
        std::count_if(maps.begin(), maps.end(),
                      [&](const std::string& name) { return placeOf(name) < placeOf(session); }));
  }

  void addMaps(const BatchConfiguration& configuration) {
    std::set<std::size_t> wanted;
    for (const auto& session : configuration.sessions)
      wanted.insert(mapFor(configuration, session));
    for (const auto& session : m_spec.sessions)
      if (isScored(configuration, session))
        wanted.insert(configuration.protocol == MapProtocol::each
                          ? mapFor(configuration, session.name)
                          : configuration.mapSessions.size());
    if (wanted.empty()) return;
    const bool chain = configuration.protocol == MapProtocol::upkeep;
    for (std::size_t n = 1; n <= *wanted.rbegin(); ++n)
      if (chain || wanted.count(n)) addMap(configuration, n);
  }

  /// Dates that some have and others have not would be years apart.
  bool allDated(const BatchConfiguration& configuration) const {
    return std::none_of(configuration.mapSessions.begin(), configuration.mapSessions.end(),
                        [&](const std::string& name) { return m_spec.session(name).date.empty(); });
  }

  static TaskPath runPath(const BatchConfiguration& configuration, const std::string& session,
                          int run) {
    const std::string number = std::to_string(run);
    return {TaskKind::run,
            {configuration.name, session, std::string(number.size() < 2 ? 1 : 0, '0') + number}};
  }

  /// Whether a session updates a map by the estimates of its own first run.
  static bool updatesByEstimate(const BatchConfiguration& configuration,
                                const std::string& session) {
    const auto& names = configuration.mapSessions;
    return configuration.poses == MapPoses::estimate && names.front() != session &&
           has(names, session);
  }

  /// The map of the first n map sessions, or of the n-th alone.
  void addMap(const BatchConfiguration& configuration, std::size_t n) {
    const auto& names = configuration.mapSessions;
    BatchTask task(mapPath(configuration, names[n - 1]));
    const bool updates = configuration.protocol == MapProtocol::upkeep && n > 1;
    Command command = program("pole-map");
    append(command, {updates ? "update" : "build", "--config", settingsOf(configuration.name, task),
                     "--output", "map.polemap"});
    const std::size_t first = configuration.protocol == MapProtocol::together ? 0 : n - 1;
    if (updates) {
      const TaskPath before = mapPath(configuration, names[n - 2]);
      append(command, {"--map", before.file("map.polemap")});
      task.needs.push_back(before.id());
    }
    const bool byEstimate = updatesByEstimate(configuration, names[n - 1]);
    Command inputs{"--input"}, poses{byEstimate ? "--estimate" : "--truth"}, dates{"--date"};
    for (std::size_t i = first; i < n; ++i) {
      const TaskPath run = runPath(configuration, names[i], 0);
      inputs.push_back(rawlogOf(configuration, names[i], true));
      poses.push_back(byEstimate ? run.file("out/run_00.tum") : truthOf(names[i]));
      if (byEstimate) task.needs.push_back(run.id());
      dates.push_back(m_spec.session(names[i]).date);
      task.needs.push_back(polesPath(names[i]).id());
    }
    append(command, inputs);
    append(command, poses);
    if (allDated(configuration)) append(command, dates);
    task.commands = {command};
    task.outputs = {"map.polemap"};
    m_plan.tasks.push_back(std::move(task));
  }

  /// Scores the map that the session completes.
  void addScore(const BatchConfiguration& configuration, const BatchSession& session) {
    BatchTask task(scorePath(configuration, session.name));
    const TaskPath map = mapPath(configuration, session.name);
    task.needs = {map.id()};
    std::string truth = session.truthMap;
    if (truth == truthFromLabels) {
      task.needs.push_back(truthPath(session).id());
      truth = truthPath(session).file("truth.polemap");
    }
    task.commands = scoreCommands(map.file("map.polemap"), truth);
    task.outputs.assign(std::begin(scoreFiles), std::end(scoreFiles));
    m_plan.tasks.push_back(std::move(task));
  }

  void addExperiments(const BatchConfiguration& configuration) {
    for (const auto& session : m_spec.sessions) {
      const bool mapped = has(configuration.mapSessions, session.name);
      const bool localized = has(configuration.sessions, session.name);
      if (!localized && !mapped) continue;
      Experiment experiment;
      experiment.configuration = configuration.name;
      experiment.session = session.name;
      if (mapped) experiment.ownMap = lastMapOf(configuration, session.name);
      if (isScored(configuration, session))
        experiment.score = scorePath(configuration, session.name).id();
      if (localized) addRuns(configuration, experiment);
      m_plan.experiments.push_back(std::move(experiment));
    }
  }

  /// A map that the session went into: the first there is.
  std::string lastMapOf(const BatchConfiguration& configuration, const std::string& session) const {
    const auto& names = configuration.mapSessions;
    const auto at = std::find(names.begin(), names.end(), session);
    for (auto name = at; name != names.end(); ++name)
      for (const auto& task : m_plan.tasks)
        if (task.id == mapPath(configuration, *name).id()) return task.id;
    return {};
  }

  void addRuns(const BatchConfiguration& configuration, Experiment& experiment) {
    const TaskPath map = mapPath(
        configuration, configuration.mapSessions[mapFor(configuration, experiment.session) - 1]);
    experiment.map = map.id();
    for (int run = 0; run < m_spec.runs; ++run) {
      BatchTask task(runPath(configuration, experiment.session, run));
      task.needs = {polesPath(experiment.session).id(), experiment.map};
      const auto seed = seedOf(m_spec.seed, experiment.session + "/run " + std::to_string(run));
      Command command = program("pole-localize");
      append(command, {"--config", settingsOf(configuration.name, task), "--input",
                       rawlogOf(configuration, experiment.session), "--truth",
                       truthOf(experiment.session), "--map", map.file("map.polemap"), "--output",
                       "out", "--runs", "1", "--seed", std::to_string(seed)});
      task.commands = {command};
      task.outputs = {"out/run_00.tum", "out/run_00_health.csv", "out/summary.json"};
      if (run == 0 && updatesByEstimate(configuration, experiment.session))
        task.outputs.push_back("out/run_00_cov.csv");
      experiment.runs.push_back(task.id);
      experiment.seeds.push_back(seed);
      m_plan.tasks.push_back(std::move(task));
    }
  }

  /// Size and time of a file from outside, so that another one in its place is noticed.
  static std::string stamp(const std::string& argument) {
    std::error_code none;
    if (!fs::path(argument).is_absolute() || !fs::is_regular_file(argument, none)) return {};
    const auto size = fs::file_size(argument, none);
    const auto time = fs::last_write_time(argument, none).time_since_epoch().count();
    return std::to_string(size) + "@" + std::to_string(time);
  }

  /// Tasks after all that they need, otherwise in the order they were planned: updates by estimates
  /// were planned before the runs that make these.
  void sortTasks() {
    std::vector<BatchTask> sorted;
    std::set<std::string> done;
    const auto isReady = [&](const BatchTask& task) {
      return std::all_of(task.needs.begin(), task.needs.end(),
                         [&](const std::string& need) { return done.count(need) > 0; });
    };
    while (!m_plan.tasks.empty()) {
      std::vector<BatchTask> waiting;
      const std::size_t before = sorted.size();
      for (BatchTask& task : m_plan.tasks) {
        const bool ready = isReady(task);
        if (ready) done.insert(task.id);
        (ready ? sorted : waiting).push_back(std::move(task));
      }
      if (sorted.size() == before)
        throw Error("batch: task " + waiting.front().id + " needs one that is not planned");
      m_plan.tasks = std::move(waiting);
    }
    m_plan.tasks = std::move(sorted);
  }

  void setKeys() {
    std::map<std::string, std::string> keys;
    for (auto& task : m_plan.tasks) {
      std::string text = std::string("polemcl ") + version() + "\n" + m_plan.build + "\n";
      for (const auto& command : task.commands)
        for (const auto& argument : command) text += argument + "\n" + stamp(argument);
      for (const auto& name : task.frozen) text += m_plan.files.at(name);
      for (const auto& need : task.needs) text += keys.at(need) + "\n";
      task.key = keys[task.id] = mrpt::system::md5(text);
    }
  }

  const BatchSpec& m_spec;
  BatchPlan m_plan;
  /// Configurations that share their poles.
  struct Group {
    std::string name;                  ///< of the first of them
    std::vector<std::string> forMaps;  ///< mapAssignments()
  };
  static constexpr const char* mapFolder = ".map";

  /// Whether any configuration of the group takes the session's poles for that.
  bool isFor(const Group& group, const std::string& session,
             std::vector<std::string> BatchConfiguration::*purpose) const {
    return std::any_of(m_spec.configurations.begin(), m_spec.configurations.end(),
                       [&](const auto& configuration) {
                         return m_groups[m_group.at(configuration.name)].name == group.name &&
                                has(configuration.*purpose, session);
                       });
  }
  /// Poles for maps are those of localization, unless the group has others for maps.
  bool hasMapPoles(const Group& group, const std::string& session) const {
    return !group.forMaps.empty() && isFor(group, session, &BatchConfiguration::mapSessions);
  }
  bool hasPoles(const Group& group, const std::string& session) const {
    return isFor(group, session, &BatchConfiguration::sessions) ||
           (group.forMaps.empty() && isFor(group, session, &BatchConfiguration::mapSessions));
  }

  std::map<std::string, std::size_t> m_groupOf;  ///< text of the extraction -> index of the group
  std::map<std::string, std::size_t> m_group;    ///< configuration -> index of the group
  std::vector<Group> m_groups;
};

}  // namespace

BatchPlan planBatch(const BatchSpec& spec, const std::string& build) {
  return Planner(spec, build).plan();
}

const BatchTask& BatchPlan::task(const std::string& id) const {
  for (const auto& task : tasks)
    if (task.id == id) return task;
  throw Error("batch " + name + " has no task '" + id + "'");
}

std::vector<std::vector<std::string>> levels(const BatchPlan& plan) {
  std::map<std::string, std::size_t> level;
  std::vector<std::vector<std::string>> result;
  for (const auto& task : plan.tasks) {
    std::size_t own = 0;
    for (const auto& need : task.needs) own = std::max(own, level.at(need) + 1);
    level[task.id] = own;
    if (result.size() <= own) result.resize(own + 1);
    result[own].push_back(task.id);
  }
  return result;
}

}  // namespace polemcl::apps
