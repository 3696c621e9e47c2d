#include "batch/BatchSpec.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "cli/JsonFile.h"
#include "config/Config.h"
#include "core/common/Binder.h"
#include "io/data/Trajectory.h"
#include "io/dataset/Nclt.h"
#include "io/file/Date.h"
#include "io/file/ErrorPlace.h"
#include "io/file/InstalledFiles.h"
#include "io/file/TextFile.h"
#include "report/batch/PublishedResults.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

const std::vector<std::string> sources{"simulated", "poles", "scans",  "folder", "kitti-odometry",
                                       "kitti-raw", "nclt",  "mulran", "pcd",    "rosbag2"};

/// Names become names of files and jobs, joined by dots.
void requireName(const std::string& name, const std::string& where) {
  const bool good = !name.empty() && name.size() <= 64 &&
                    std::all_of(name.begin(), name.end(), [](unsigned char c) {
                      return std::isalnum(c) || c == '_' || c == '-';
                    });
  if (!good)
    throw Error(where + ": '" + name +
                "' is no name; allowed are up to 64 letters, digits, _ and -");
}

void requireNames(const std::vector<std::string>& names, const std::string& where) {
  if (names.empty()) throw Error(where + ": at least one name is needed");
  std::set<std::string> seen;
  for (const auto& name : names) {
    requireName(name, where);
    if (!seen.insert(name).second) throw Error(where + ": '" + name + "' is given twice");
  }
}

/// What the values of a session or configuration may refer to.
class Placeholders {
 public:
  Placeholders(const fs::path& file, const fs::path& data)
      : m_file(file.string()),
        m_folder(fs::absolute(file).parent_path()),
        m_data(data.empty() ? data : fs::absolute(data)) {}

  std::string filled(std::string text, const std::string& session) const {
    if (text.find("{data}") != std::string::npos && m_data.empty())
      throw Error(m_file + ": '" + text +
                  "' needs the folder of the dataset: give --data DIR (see share/doc/batch.md)");
    replace(text, "{data}", m_data.string());
    replace(text, "{here}", m_folder.string());
    replace(text, "{session}", session);
    return text;
  }
  std::string path(const std::string& text, const std::string& session) const {
    const std::string full = filled(text, session);
    return full.empty() ? full : (m_folder / full).lexically_normal().string();
  }
  /// The same, or an installed file where that is not there. The batch itself is not meant: a batch
  /// nclt.ini may have config = nclt.ini.
  std::string installed(const std::string& text, const std::string& session,
                        const std::string& folder) const {
    std::string beside = path(text, session);
    std::error_code none;
    if (fs::exists(beside, none) && !fs::equivalent(beside, m_file, none)) return beside;
    const fs::path found = io::fileOfDataFolder(filled(text, session), folder);
    return found.empty() ? beside : fs::absolute(found).lexically_normal().string();
  }

 private:
  static void replace(std::string& text, const std::string& what, const std::string& with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
      text.replace(at, what.size(), with);
  }
  std::string m_file;
  fs::path m_folder, m_data;
};

/// Texts of a session as they stand in the file.
struct SessionText {
  BatchSession session;
  std::string set;
};

void bindSession(Binder& b, SessionText& text) {
  BatchSession& s = text.session;
  b.choice("source", s.source, sources, "where the sessions come from");
  b.text("input", s.input, "folder, rawlog or INI, relative to this file");
  b.text("date", s.date, "YYYY-MM-DD, where the times of the scans do not tell");
  b.text("set", text.set, "settings of a simulated session, section.key=value …");
  b.integer("every", s.every, Range::atLeast(1), "", "take every N-th scan");
  b.integer("offset", s.offset, Range::atLeast(0), "", "first scan taken");
  b.number("odometry_noise", s.odometryNoise, Range::between(0, 1), "",
           "share of the true motion; 0: the dataset's own odometry");
  b.text("sensor_pose", s.sensorPose, "of pole-import");
  b.text("poses", s.poses, "TUM file of true poses instead of the dataset's");
  b.choice("poses_of", s.posesOf, {"robot", "sensor"}, "what has these poses");
  b.text("calib", s.calib, "folder of KITTI's calibration");
  b.text("truth_map", s.truthMap, "true poles: a file, or labels (SemanticKITTI's)");
}

/// Keys that only an import reads would have no effect on scans or poles that are there.
void requireImport(const BatchSession& s, const std::string& where) {
  const bool imports = s.source != "simulated" && s.source != "poles" && s.source != "scans";
  const std::pair<const char*, bool> given[] = {{"every", s.every > 1},
                                                {"offset", s.offset > 0},
                                                {"odometry_noise", s.odometryNoise > 0},
                                                {"sensor_pose", !s.sensorPose.empty()},
                                                {"poses", !s.poses.empty()},
                                                {"calib", !s.calib.empty()}};
  for (const auto& [key, isGiven] : given)
    if (isGiven && !imports)
      throw Error(where + key + " has no effect with source = " + s.source + "; leave it out, or " +
                  "name a dataset of pole-import as the source");
}

BatchSession finished(const SessionText& text, const std::string& name, const Placeholders& fill,
                      const std::string& where) {
  BatchSession s = text.session;
  s.name = name;
  s.input =
      s.source == "simulated" ? fill.installed(s.input, name, "config") : fill.path(s.input, name);
  s.poses = fill.path(s.poses, name);
  s.calib = fill.path(s.calib, name);
  if (s.truthMap != truthFromLabels) s.truthMap = fill.path(s.truthMap, name);
  s.date = fill.filled(s.date, name);
  for (const std::string& word : io::wordsOf(text.set)) s.set.push_back(fill.filled(word, name));
  requireImport(text.session, where + "session " + name + ": ");
  if (s.input.empty()) throw Error(where + "session " + name + ": input is missing");
  if (!s.date.empty())
    io::located(where + "session " + name + ": date: ", [&] { io::secondsOfDate(s.date); });
  if (s.source != "simulated" && !s.set.empty())
    throw Error(where + "session " + name + ": set is for simulated sessions only");
  if (s.source != "kitti-odometry" && s.truthMap == truthFromLabels)
    throw Error(where + "session " + name +
                ": truth_map = labels needs source = kitti-odometry; name a file of poles instead");
  return s;
}

/// Names as the file itself has them; --set may choose among these.
std::vector<std::string> namesIn(const ConfigFile& file, const std::string& section,
                                 const std::string& key) {
  ConfigReader reader(file);
  std::string text;
  reader.section(section, "");
  reader.text(key, text, "");
  return io::wordsOf(text);
}

std::vector<BatchSession> readSessions(ConfigReader& reader, const Placeholders& fill,
                                       const std::vector<std::string>& inFile,
                                       const std::string& where) {
  SessionText common;
  common.session.source = "folder";
  std::string text;
  reader.section("sessions", "What all sessions have in common");
  reader.text("names", text, "in the order they were driven");
  bindSession(reader, common);
  const auto names = io::wordsOf(text);
  requireNames(names, where + "[sessions] names");
  for (const char* taken : {"all", "first", "later", "none"})
    if (has(names, taken))
      throw Error(where + "[sessions] names: '" + taken + "' stands for several sessions in " +
                  "map_sessions and sessions; choose another name");
  std::vector<BatchSession> sessions;
  for (const auto& name : names) {
    SessionText own = common;
    own.set.clear();
    reader.section("session " + name, "What is different");
    bindSession(reader, own);
    own.set = common.set + " " + own.set;
    sessions.push_back(finished(own, name, fill, where));
  }
  for (const auto& name : inFile) {  // those left out have keys as well
    SessionText unused = common;
    reader.section("session " + name, "What is different");
    bindSession(reader, unused);
  }
  return sessions;
}

/// `all`, `first`, `later` or names; always in the order of the sessions.
std::vector<std::string> chosen(const std::string& text, const std::vector<BatchSession>& sessions,
                                const std::string& where) {
  if (text == "first") return {sessions.front().name};
  if (text == "later" && sessions.size() == 1)
    throw Error(where + " = later: two sessions or more are needed, [sessions] names has only " +
                sessions.front().name +
                "; add one, or choose settings without this one (--set batch.settings=NAMES)");
  std::vector<std::string> names = io::wordsOf(text);
  if (text == "all" || text == "later") {
    names.clear();
    for (const auto& session : sessions) names.push_back(session.name);
    if (text == "later") names.erase(names.begin());
  }
  requireNames(names, where);
  const auto placeOf = [&](const std::string& name) {
    const auto found = std::find_if(sessions.begin(), sessions.end(),
                                    [&](const BatchSession& s) { return s.name == name; });
    if (found == sessions.end())
      throw Error(where + ": no session '" + name + "' in [sessions] names; allowed are these, " +
                  "all, first, later");
    return found;
  };
  std::sort(names.begin(), names.end(),
            [&](const std::string& a, const std::string& b) { return placeOf(a) < placeOf(b); });
  if (names.size() == 1) placeOf(names.front());
  return names;
}

/// Each session that is localized in the map before it needs a map session before it.
void requireMaps(const BatchConfiguration& configuration, const std::vector<BatchSession>& sessions,
                 const std::string& where) {
  if (configuration.map == MapTime::finished) return;
  for (const auto& session : sessions) {
    if (has(configuration.sessions, session.name))
      throw Error(where + ": session " + session.name +
                  " has no map session before it; leave it out of sessions, or set map = finished");
    if (session.name == configuration.mapSessions.front()) return;
  }
}

/// Texts of a configuration as they stand in the file.
struct ConfigurationText {
  BatchConfiguration configuration;
  std::string set, mapSessions = "first", localized = "all";
};

void bindConfiguration(Binder& b, ConfigurationText& text) {
  BatchConfiguration& configuration = text.configuration;
  b.section("setting " + configuration.name, "One way to map and to localize");
  b.text("title", configuration.title, "a sentence for the report");
  b.text("config", configuration.config, "INI file: relative to this file, or an installed one");
  b.text("set", text.set, "settings in place of those of config, section.key=value …");
  b.text("map_sessions", text.mapSessions, "names, all, first, or later (all but the first)");
  b.text("sessions", text.localized, "those localized: names, all, later, or none");
  b.choice<MapProtocol>("maps", configuration.protocol,
                        {{MapProtocol::together, "together"},
                         {MapProtocol::upkeep, "upkeep"},
                         {MapProtocol::each, "each"}},
                        "how they come about");
  b.choice<MapTime>("map", configuration.map,
                    {{MapTime::before, "before"}, {MapTime::finished, "finished"}},
                    "the one that sessions are localized in");
  b.choice<MapPoses>("poses", configuration.poses,
                     {{MapPoses::truth, "truth"}, {MapPoses::estimate, "estimate"}},
                     "maps = upkeep: poses of updates; estimate: those of the first run");
}

BatchConfiguration finished(const ConfigurationText& text, const Placeholders& fill,
                            const std::vector<BatchSession>& sessions, const std::string& here) {
  BatchConfiguration configuration = text.configuration;
  if (configuration.config.empty())
    throw Error(here + "config is missing (each of [batch] settings has a section of its own)");
  configuration.config = fill.installed(configuration.config, "", "config");
  configuration.set = io::wordsOf(text.set);
  configuration.mapSessions = chosen(text.mapSessions, sessions, here + "map_sessions");
  if (text.localized != "none")
    configuration.sessions = chosen(text.localized, sessions, here + "sessions");
  return configuration;
}

void readConfigurations(ConfigReader& reader, const std::vector<std::string>& names,
                        const Placeholders& fill, const std::vector<std::string>& inFile,
                        BatchSpec& spec) {
  const auto textOf = [&](const std::string& name) {
    ConfigurationText text;
    text.configuration.name = name;
    bindConfiguration(reader, text);
    return text;
  };
  for (const auto& name : names)
    spec.configurations.push_back(finished(textOf(name), fill, spec.sessions,
                                           spec.file.string() + ": [setting " + name + "] "));
  for (const auto& name : inFile) textOf(name);  // those left out have keys as well
}

/// Sessions with maps of their own are localized in these.
void requireOwnMaps(const BatchConfiguration& configuration, const std::string& where) {
  if (configuration.protocol != MapProtocol::each) return;
  if (!configuration.sessions.empty() && configuration.map == MapTime::before)
    throw Error(where + "maps = each has no map before a session; set map = finished");
  for (const auto& name : configuration.sessions)
    if (!has(configuration.mapSessions, name))
      throw Error(where + "session " + name + " has no map; with maps = each, it must be one of " +
                  "map_sessions");
}

/// Updates by estimates need these estimates.
void requireEstimates(const BatchConfiguration& configuration, const std::string& where) {
  if (configuration.poses == MapPoses::truth) return;
  if (configuration.protocol != MapProtocol::upkeep || configuration.map != MapTime::before)
    throw Error(where + "poses = estimate needs maps = upkeep and map = before");
  for (std::size_t i = 1; i < configuration.mapSessions.size(); ++i)
    if (!has(configuration.sessions, configuration.mapSessions[i]))
      throw Error(where + "poses = estimate: session " + configuration.mapSessions[i] +
                  " updates the map but is not localized; add it to sessions");
}

/// Maps alone are of use if they get a score.
void requireUse(const BatchConfiguration& configuration, const BatchSpec& spec,
                const std::string& where) {
  if (configuration.sessions.empty() &&
      std::none_of(spec.sessions.begin(), spec.sessions.end(),
                   [&](const BatchSession& session) { return isScored(configuration, session); }))
    throw Error(where + "sessions = none leaves nothing to report; name sessions, or give " +
                configuration.mapSessions.back() + ", which completes the map, a truth_map");
}

/// A map is kept up from day to day, not back.
void requireOrder(const BatchConfiguration& configuration, const BatchSpec& spec,
                  const std::string& where) {
  if (configuration.protocol != MapProtocol::upkeep) return;
  std::string last;
  for (const auto& name : configuration.mapSessions) {
    const std::string& date = spec.session(name).date;
    if (!date.empty() && date < last)
      throw Error(where + ": session " + name + " of " + date + " comes after one of " + last +
                  "; maps = upkeep takes sessions in the order of their dates");
    last = std::max(last, date);
  }
}

std::string sessionObstacle(const BatchSession& session) {
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

std::string truthObstacle(const BatchSession& session) {
  if (session.truthMap != truthFromLabels)
    return fs::is_regular_file(session.truthMap)
               ? ""
               : session.truthMap + ", its truth_map, is not there";
  const fs::path labels = fs::path(session.input) / "labels";
  return fs::is_directory(labels) ? "" : labels.string() + " is not there";
}

/// pole-simulate reads it whole.
void requireDetectionModel(const std::string& file) {
  const auto json = readJson(file);
  const bool isModel = json.is_object() && json.contains("format") && json["format"].is_string() &&
                       json["format"].get<std::string>().rfind("polemcl detection model", 0) == 0;
  if (!isModel) throw Error(file + ": is no model of detections");
}

}  // namespace

const BatchSession& BatchSpec::session(const std::string& wanted) const {
  for (const auto& session : sessions)
    if (session.name == wanted) return session;
  throw Error("no session '" + wanted + "' in batch " + name);
}

bool isScored(const BatchConfiguration& configuration, const BatchSession& session) {
  const auto& names = configuration.mapSessions;
  return !session.truthMap.empty() &&
         (configuration.protocol == MapProtocol::each ? has(names, session.name)
                                                      : names.back() == session.name);
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

BatchSpec readBatchSpec(const fs::path& wanted, const fs::path& data,
                        const std::vector<std::string>& set) {
  const fs::path file = io::installedFile(wanted, "config");
  ConfigFile source = ConfigFile::read(file.string());
  const auto allSessions = namesIn(source, "sessions", "names");
  const auto allConfigurations = namesIn(source, "batch", "settings");
  for (const auto& assignment : set) source.set(assignment);
  const std::string where = file.string() + ": ";
  const Placeholders fill(file, data);
  ConfigReader reader(source);
  BatchSpec spec;
  spec.file = file;
  spec.name = file.stem().string();
  std::string names;
  reader.section("batch", "What is done");
  reader.text("name", spec.name, "of the batch; the file's unless given");
  reader.text("title", spec.title, "for the report");
  std::vector<std::string> published{"none"};
  for (const auto& dataset : report::publishedDatasets()) published.push_back(dataset);
  reader.choice("published", spec.published, published, "published figures shown beside");
  reader.text("published_sessions", spec.publishedSessions,
              "CSV of such figures by session: relative to this file, or an installed one");
  reader.integer("runs", spec.runs, Range::between(1, 10000), "", "of each session and setting");
  reader.integer("seed", spec.seed, Range::atLeast(0), "", "of all random numbers");
  reader.choice<bool>("errors", spec.perMetre, {{false, "scan"}, {true, "metre"}},
                      "where they are taken");
  reader.text("settings", names, "names; each has a section of its own");
  requireName(spec.name, where + "[batch] name (the file's unless given)");
  requireNames(io::wordsOf(names), where + "[batch] settings");
  if (!spec.publishedSessions.empty())
    spec.publishedSessions = fill.installed(spec.publishedSessions, "", "published");
  spec.sessions = readSessions(reader, fill, allSessions, where);
  readConfigurations(reader, io::wordsOf(names), fill, allConfigurations, spec);
  reader.finish();
  for (const auto& configuration : spec.configurations) {
    const std::string here = where + "[setting " + configuration.name + "] ";
    requireUse(configuration, spec, here);
    requireOwnMaps(configuration, here);
    requireEstimates(configuration, here);
    requireMaps(configuration, spec.sessions, here + "sessions");
    requireOrder(configuration, spec, here + "map_sessions");
  }
  return spec;
}

std::uint32_t seedOf(std::uint32_t seed, const std::string& name) {
  const std::string text = std::to_string(seed) + "/" + name;
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size())));
}

std::string inputObstacle(const BatchSession& session, bool scored) {
  const std::string what = sessionObstacle(session);
  return what.empty() && scored ? truthObstacle(session) : what;
}

AllSettings simulationFor(const BatchSpec& spec, const BatchSession& session) {
  AllSettings settings = loadSettings(session.input, session.set);
  std::string& model = settings.simulation.detections;
  std::string& track = settings.simulation.world.track;
  for (std::string* file : {&model, &track}) {
    if (file->empty()) continue;
    const fs::path beside = fs::absolute(spec.file.parent_path() / *file);
    if (fs::is_regular_file(beside)) *file = beside.string();
  }
  io::located("batch " + spec.name + ": session " + session.name + ": ", [&] {
    if (!model.empty()) requireDetectionModel(model);
    if (!track.empty()) io::readKittiPoses(track);
  });
  return settings;
}

AllSettings settingsFor(const BatchSpec& spec, const BatchConfiguration& configuration) {
  const std::string where = "batch " + spec.name + ": [setting " + configuration.name + "] ";
  if (!fs::is_regular_file(configuration.config))
    throw Error(
        where + "config: " + configuration.config +
        " is not there; name a file beside the batch, or an installed one such as nclt.ini");
  return io::located(where, [&] { return loadSettings(configuration.config, configuration.set); });
}

void requirePublished(const BatchSpec& spec) {
  if (spec.publishedSessions.empty()) return;
  io::located("batch " + spec.name + ": [batch] published_sessions: ",
              [&] { report::readPublishedSessions(spec.publishedSessions); });
}

}  // namespace polemcl::apps
