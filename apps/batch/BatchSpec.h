#pragma once
/// \file BatchSpec.h
/// \brief What a batch is: sessions, configurations and runs, from an INI file.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/Settings.h"

namespace polemcl::apps {

/// \brief One drive: where it comes from. `[sessions]` holds what all have in common, a section
/// `[session NAME]` what is different. In all values `{session}` stands for the name, `{data}` for
/// what `--data` gives, `{here}` for the folder of the batch file; paths are relative to that. INI
/// files and published figures that are not there are looked for among the installed ones.
struct BatchSession {
  std::string name;
  /// `simulated` (input: its INI), `poles` or `scans` (input: a rawlog, the truth beside it), or a
  /// dataset of `pole-import` (input: its folder).
  std::string source;
  std::string input;
  std::string date;  ///< YYYY-MM-DD; "": as the times of its scans say
  /// Settings of `simulated`: `section.key=value`, see loadSettings(); common ones first.
  std::vector<std::string> set;
  std::size_t every = 1, offset = 0;  ///< scans taken, as `pole-import` has it
  double odometryNoise = 0;           ///< share of the true motion; 0: odometry of the dataset
  std::string sensorPose, poses, posesOf = "robot", calib;  ///< as `pole-import` has them
  /// True poles, in the frame of the map that this session completes: a file for `pole-eval map`,
  /// or `labels`: made from the session's labels by `pole-labels`; empty: that map gets no score.
  std::string truthMap;
};

/// \brief The truthMap that stands for SemanticKITTI's labels.
inline constexpr const char* truthFromLabels = "labels";

/// \brief How maps come about.
enum class MapProtocol {
  together,  ///< all sessions driven so far make one map, as `[map]` says (`unvisited_m`)
  upkeep,    ///< the first makes the map, each later one keeps it true (`pole-map update`)
  each       ///< each session makes a map of its own: they show different places
};

/// \brief Where the poses come from that maps are kept up with.
enum class MapPoses {
  truth,    ///< the true poses
  estimate  ///< what the first run of the session estimated in the map before it
};

/// \brief Which map a session is localized in.
enum class MapTime {
  before,   ///< the one that earlier map sessions left: the session's own data is not in it
  finished  ///< the one that all map sessions left, its own data among them, as the paper does
};

/// \brief One way to map and to localize. `[setting NAME]`.
struct BatchConfiguration {
  std::string name;
  std::string title;                     ///< a sentence for the report
  std::string config;                    ///< INI of all programs
  std::vector<std::string> set;          ///< values in place of its own
  std::vector<std::string> mapSessions;  ///< names, in the order of the sessions
  std::vector<std::string> sessions;     ///< names of those that are localized; may be empty
  MapProtocol protocol = MapProtocol::together;
  MapTime map = MapTime::before;
  MapPoses poses = MapPoses::truth;  ///< of updates; the first map is made with true poses
};

struct BatchSpec {
  std::filesystem::path file;  ///< where it was read
  std::string name;            ///< of the batch: letters, digits, `_` and `-`
  std::string title;           ///< for the report
  /// Published figures to show beside: `none`, or a key of PublishedResults.h.
  std::string published = "none";
  std::string publishedSessions;  ///< CSV of published figures by session; empty: none
  int runs = 10;                  ///< of each session under each configuration
  std::uint32_t seed = 1;
  bool perMetre = false;  ///< errors at each metre of the way, not at each scan (`errors = metre`)
  std::vector<BatchSession> sessions;  ///< in the order they were driven
  std::vector<BatchConfiguration> configurations;

  const BatchSession& session(const std::string& name) const;  ///< \throws Error
};

/// \brief Whether a session completes a map of the configuration, and its true poles are known: the
/// last map session, with maps = each any of them.
bool isScored(const BatchConfiguration& configuration, const BatchSession& session);

/// \brief Whether a list has this name.
bool has(const std::vector<std::string>& names, const std::string& name);

/// \brief Reads a batch file.
/// \param data What stands for `{data}`; empty: not given.
/// \param file The batch, or the name of an installed one such as `batches/year.ini`.
/// \param set Values in place of the file's, `section.key=value`, as ConfigFile::set() takes them.
///        They may choose among the file's own sessions and configurations: sections of those that
///        are not chosen are left out, and only their keys are checked.
/// \throws Error naming file, section and key: what ConfigReader refuses, names that are given
///         twice or have other characters, unknown sessions and configurations, `{data}` without
///         `--data`, a session localized in the map before it when no map comes before it, a
///         configuration that neither localizes nor scores, keys of an import without an import.
BatchSpec readBatchSpec(const std::filesystem::path& file, const std::filesystem::path& data = {},
                        const std::vector<std::string>& set = {});

/// \brief A seed from names: the same whatever else is in the batch, and in whatever order.
/// \param name Name of what draws the random numbers, such as "month_03/run 4".
std::uint32_t seedOf(std::uint32_t seed, const std::string& name);

/// \brief What is wrong with a session's input; empty when nothing is.
/// \param scored Whether its true poles (truthMap) are needed as well.
std::string inputObstacle(const BatchSession& session, bool scored);

/// \brief The settings of a session with `source = simulated`. Its model of detections and track
/// are beside the batch if they are there, else as the programs find them. Both are read: what they
/// name is copied into the folder of the batch, and a batch of others may name any file.
/// \throws Error as loadSettings(); naming batch and session when a file is no model or no track.
AllSettings simulationFor(const BatchSpec& spec, const BatchSession& session);

/// \brief The settings of a configuration. \throws Error as loadSettings(), naming batch and
/// configuration, and when its config is not there.
AllSettings settingsFor(const BatchSpec& spec, const BatchConfiguration& configuration);

/// \brief Reads the published figures of a batch, if it has any. \throws Error as
/// report::readPublishedSessions(), naming batch and key.
void requirePublished(const BatchSpec& spec);

}  // namespace polemcl::apps
