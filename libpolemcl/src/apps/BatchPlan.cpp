#include <mrpt/system/md5.h>
#include <polemcl/apps/BatchPlan.h>
#include <polemcl/apps/Settings.h>
#include <polemcl/io/Nclt.h>
#include <polemcl/io/TextFile.h>
#include <polemcl/mrpt/Bindings.h>
#include <polemcl/mrpt/Config.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

using Command = std::vector<std::string>;

Command program(const std::string& name) {
  return {name, "--quiet", "--threads", "1"};  // one process for each core
}

void append(Command& command, const Command& more) {
  command.insert(command.end(), more.begin(), more.end());
}

std::string contentOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file + ": cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Least confidence of poles for maps where it is another than for localization, see surveyDrive().
std::string mapConfidence(const Settings& settings) {
  const double map = settings.map.minConfidence, native = settings.extraction.native.minConfidence;
  return map > 0 && map != native ? io::significant(map, 9) : "";
}

/// What the extraction depends on: settings with the same text share their poles.
std::string extractionText(Settings settings) {
  ConfigWriter writer;
  bind(writer, settings.sensor);
  bind(writer, settings.extraction);
  return writer.text() + mapConfidence(settings);
}

/// Puts together one plan.
class Planner {
 public:
  Planner(const BatchSpec& spec, const std::string& build) : m_spec(spec) {
    m_plan.name = spec.name;
    m_plan.build = build;
  }

  BatchPlan plan() {
    requireInputs();
    for (const auto& setting : m_spec.settings) freeze(setting);
    for (const auto& session : m_spec.sessions)
      if (isUsed(session.name)) addPoles(session);
    for (const auto& setting : m_spec.settings) {
      addMaps(setting);
      addCells(setting);
    }
    for (const auto& [name, content] : m_plan.files) m_plan.sums[name] = mrpt::system::md5(content);
    setKeys();
    return std::move(m_plan);
  }

 private:
  bool isUsed(const std::string& session) const {
    const auto has = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), session) != names.end();
    };
    return std::any_of(m_spec.settings.begin(), m_spec.settings.end(), [&](const auto& setting) {
      return has(setting.sessions) || has(setting.mapSessions);
    });
  }

  /// What is wrong with a session's input; empty when nothing is.
  static std::string obstacle(const BatchSession& session) {
    const bool isFile =
        session.source == "simulated" || session.source == "poles" || session.source == "scans";
    if (session.source == "nclt" && io::isNcltSession(session.input)) return {};
    if (!fs::exists(session.input)) return session.input + " is not there";
    if (isFile && !fs::is_regular_file(session.input)) return session.input + " is no file";
    if (!isFile && !fs::is_directory(session.input)) return session.input + " is no folder";
    const fs::path truth = fs::path(session.input).replace_extension(".tum");
    if (isFile && session.source != "simulated" && !fs::is_regular_file(truth))
      return truth.string() + ", its true poses, is not there";
    return {};
  }

  void requireInputs() const {
    std::string missing;
    for (const auto& session : m_spec.sessions) {
      if (!isUsed(session.name)) continue;
      const std::string what = obstacle(session);
      if (!what.empty()) missing += (missing.empty() ? "" : "; ") + session.name + ": " + what;
    }
    if (!missing.empty())
      throw Error("batch " + m_spec.name + ": inputs are missing: " + missing +
                  "; check --data and [sessions] input, or leave these sessions out");
  }

  /// A file that settings name, copied into the batch's folder; the name it has from a task's.
  std::string frozen(const std::string& file) {
    if (file.empty()) return file;
    const std::string name = "files/" + fs::path(file).filename().string();
    const std::string content = contentOf(file);
    const auto [entry, isNew] = m_plan.files.emplace(name, content);
    if (!isNew && entry->second != content)
      throw Error("batch " + m_spec.name + ": two different files are called " +
                  fs::path(file).filename().string() + "; rename one of them");
    return "../../" + name;
  }

  void freeze(const BatchSetting& setting) {
    const Settings settings = loadSettings(setting.config, setting.set);
    const auto [group, isNew] = m_groupOf.emplace(extractionText(settings), setting.name);
    m_group[setting.name] = group->second;
    if (isNew) m_groups.push_back({setting.name, mapConfidence(settings)});
    m_plan.files["settings/" + setting.name + ".ini"] = settingsText(settings);
  }

  void addPoles(const BatchSession& session) {
    BatchTask task;
    task.id = "poles." + session.name;
    task.kind = "poles";
    const std::string rawlog = session.name + ".rawlog", truth = session.name + ".tum";
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
        task.outputs.push_back(group.name + "/" + rawlog);
        if (!group.mapConfidence.empty())
          task.outputs.push_back(group.name + mapFolder + "/" + rawlog);
      }
    } else {
      task.outputs.push_back(rawlog);
    }
    m_plan.tasks.push_back(std::move(task));
  }

  void simulate(const BatchSession& session, BatchTask& task) {
    Settings settings = loadSettings(session.input, session.set);
    settings.simulation.detections = frozen(settings.simulation.detections);
    settings.simulation.world.track = frozen(settings.simulation.world.track);
    const std::string file = "settings/simulate." + session.name + ".ini";
    m_plan.files[file] = settingsText(settings);
    Command command = program("pole-simulate");
    append(command, {"--config", "../../" + file, "--poles", session.name + ".rawlog"});
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
      task.commands = {importCommand(session)};
    }
    for (const auto& group : m_groups) {
      const std::string rawlog = "/" + session.name + ".rawlog";
      Command command = program("pole-extract");
      append(command, {"--config", "../../settings/" + group.name + ".ini", "--input", scans});
      Command forMaps = command;
      append(command, {"--output", group.name + rawlog});
      task.commands.push_back(command);
      if (group.mapConfidence.empty()) continue;
      append(forMaps, {"--set", "native.min_confidence=" + group.mapConfidence, "--output",
                       group.name + mapFolder + rawlog});
      task.commands.push_back(forMaps);
    }
  }

  Command importCommand(const BatchSession& session) const {
    Command command = program("pole-import");
    append(command,
           {session.source, "--input", session.input, "--output", session.name + ".rawlog",
            "--every", std::to_string(session.every), "--offset", std::to_string(session.offset)});
    if (session.odometryNoise > 0) {
      const auto seed = seedOf(m_spec.seed, session.name + "/odometry");
      append(command, {"--odometry-noise", std::to_string(session.odometryNoise), "--seed",
                       std::to_string(seed)});
    }
    if (!session.sensorPose.empty()) append(command, {"--sensor-pose", session.sensorPose});
    if (!session.poses.empty())
      append(command, {"--poses", session.poses, "--poses-of", session.posesOf});
    if (!session.calib.empty()) append(command, {"--calib", session.calib});
    return command;
  }

  /// Stored and simulated poles are those of all settings.
  static bool hasGroups(const BatchSession& session) {
    return session.source != "simulated" && session.source != "poles";
  }

  std::string rawlogOf(const BatchSetting& setting, const std::string& session,
                       bool forMaps = false) const {
    std::string folder = "../poles." + session + "/";
    if (hasGroups(m_spec.session(session))) {
      const std::string& name = m_group.at(setting.name);
      const auto group = std::find_if(m_groups.begin(), m_groups.end(),
                                      [&](const Group& entry) { return entry.name == name; });
      folder += name + (forMaps && !group->mapConfidence.empty() ? mapFolder : "") + "/";
    }
    return folder + session + ".rawlog";
  }
  static std::string truthOf(const std::string& session) {
    return "../poles." + session + "/" + session + ".tum";
  }
  static std::string mapId(const BatchSetting& setting, const std::string& session) {
    return "map." + setting.name + "." + session;
  }

  std::size_t placeOf(const std::string& session) const {
    for (std::size_t i = 0; i < m_spec.sessions.size(); ++i)
      if (m_spec.sessions[i].name == session) return i;
    return m_spec.sessions.size();
  }

  /// The map that a session is localized in: how many of the map sessions went into it.
  std::size_t mapFor(const BatchSetting& setting, const std::string& session) const {
    const auto& maps = setting.mapSessions;
    if (setting.map == MapTime::finished) return maps.size();
    return static_cast<std::size_t>(
        std::count_if(maps.begin(), maps.end(),
                      [&](const std::string& name) { return placeOf(name) < placeOf(session); }));
  }

  void addMaps(const BatchSetting& setting) {
    std::set<std::size_t> wanted;
    for (const auto& session : setting.sessions) wanted.insert(mapFor(setting, session));
    const bool chain = setting.protocol == MapProtocol::upkeep;
    for (std::size_t n = 1; n <= *wanted.rbegin(); ++n)
      if (chain || wanted.count(n)) addMap(setting, n, chain);
  }

  /// Dates that some have and others have not would be years apart.
  bool allDated(const BatchSetting& setting) const {
    return std::none_of(setting.mapSessions.begin(), setting.mapSessions.end(),
                        [&](const std::string& name) { return m_spec.session(name).date.empty(); });
  }

  /// The map of the first n map sessions.
  void addMap(const BatchSetting& setting, std::size_t n, bool chain) {
    const auto& names = setting.mapSessions;
    BatchTask task;
    task.id = mapId(setting, names[n - 1]);
    task.kind = "map";
    Command command = program("pole-map");
    append(command,
           {"--config", "../../settings/" + setting.name + ".ini", "--output", "map.polemap"});
    const std::size_t first = chain ? n - 1 : 0;
    if (chain && n > 1) {
      const std::string before = mapId(setting, names[n - 2]);
      append(command, {"--update", "../" + before + "/map.polemap"});
      task.needs.push_back(before);
    }
    Command inputs{"--input"}, truths{"--truth"}, dates{"--date"};
    for (std::size_t i = first; i < n; ++i) {
      inputs.push_back(rawlogOf(setting, names[i], true));
      truths.push_back(truthOf(names[i]));
      dates.push_back(m_spec.session(names[i]).date);
      task.needs.push_back("poles." + names[i]);
    }
    append(command, inputs);
    append(command, truths);
    if (allDated(setting)) append(command, dates);
    task.commands = {command};
    task.outputs = {"map.polemap"};
    m_plan.tasks.push_back(std::move(task));
  }

  void addCells(const BatchSetting& setting) {
    for (const auto& session : m_spec.sessions) {
      const auto has = [&](const std::vector<std::string>& names) {
        return std::find(names.begin(), names.end(), session.name) != names.end();
      };
      if (!has(setting.sessions) && !has(setting.mapSessions)) continue;
      BatchCell cell;
      cell.setting = setting.name;
      cell.session = session.name;
      cell.poles = rawlogOf(setting, session.name).substr(3);
      if (has(setting.mapSessions)) cell.ownMap = lastMapOf(setting, session.name);
      if (has(setting.sessions)) addRuns(setting, cell);
      m_plan.cells.push_back(std::move(cell));
    }
  }

  /// A map that the session went into: the first there is.
  std::string lastMapOf(const BatchSetting& setting, const std::string& session) const {
    const auto& names = setting.mapSessions;
    const auto at = std::find(names.begin(), names.end(), session);
    for (auto name = at; name != names.end(); ++name)
      for (const auto& task : m_plan.tasks)
        if (task.id == mapId(setting, *name)) return task.id;
    return {};
  }

  void addRuns(const BatchSetting& setting, BatchCell& cell) {
    cell.map = mapId(setting, setting.mapSessions[mapFor(setting, cell.session) - 1]);
    for (int run = 0; run < m_spec.runs; ++run) {
      BatchTask task;
      const std::string number = std::to_string(run);
      task.id = "run." + setting.name + "." + cell.session + "." +
                std::string(number.size() < 2 ? 1 : 0, '0') + number;
      task.kind = "run";
      task.needs = {"poles." + cell.session, cell.map};
      const auto seed = seedOf(m_spec.seed, cell.session + "/run " + number);
      Command command = program("pole-localize");
      append(command, {"--config", "../../settings/" + setting.name + ".ini", "--input",
                       rawlogOf(setting, cell.session), "--truth", truthOf(cell.session), "--map",
                       "../" + cell.map + "/map.polemap", "--output", "out", "--runs", "1",
                       "--seed", std::to_string(seed)});
      task.commands = {command};
      task.outputs = {"out/run_00.tum", "out/run_00_health.csv", "out/summary.json"};
      cell.runs.push_back(task.id);
      cell.seeds.push_back(seed);
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

  void setKeys() {
    std::map<std::string, std::string> keys;
    for (auto& task : m_plan.tasks) {
      std::string text = std::string("polemcl ") + version() + "\n" + m_plan.build + "\n";
      for (const auto& command : task.commands)
        for (const auto& argument : command) {
          text += argument + "\n" + stamp(argument);
          const std::string prefix = "../../";
          if (argument.rfind(prefix, 0) == 0) text += m_plan.files.at(argument.substr(6));
        }
      // Files that frozen settings name belong to all that is simulated.
      if (task.commands.front().front() == "pole-simulate")
        for (const auto& [name, content] : m_plan.files)
          if (name.rfind("files/", 0) == 0) text += content;
      for (const auto& need : task.needs) text += keys.at(need) + "\n";
      task.key = keys[task.id] = mrpt::system::md5(text);
    }
  }

  const BatchSpec& m_spec;
  BatchPlan m_plan;
  /// Settings that share their poles.
  struct Group {
    std::string name;           ///< of the first of them
    std::string mapConfidence;  ///< of poles for maps; empty: that of all
  };
  static constexpr const char* mapFolder = ".map";

  std::map<std::string, std::string> m_groupOf;  ///< text of the extraction -> name of the group
  std::map<std::string, std::string> m_group;    ///< setting -> group
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
