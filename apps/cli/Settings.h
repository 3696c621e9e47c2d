#pragma once
/// \file Settings.h
/// \brief One INI serves all programs: the union of all option structs.

#include <map>
#include <string>
#include <vector>

#include <polemcl/core/common/Binder.h>
#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/global_localization/GlobalLocalizer.h>
#include <polemcl/core/localization/PoleLikelihood.h>
#include <polemcl/core/mapping/MapUpdater.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/mrpt/filter/FilterOptions.h>
#include <polemcl/mrpt/filter/LocalizationPipeline.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include <polemcl/mrpt/rawlog/MotionOptions.h>
#include <polemcl/mrpt/rawlog/PoleSequence.h>
#include "report/scene/ViewOptions.h"
#include "sim/common/SimulationOptions.h"

namespace polemcl {
class ConfigFile;
}

namespace polemcl::apps {

/// \brief All settings of all programs. Sections that a file leaves out keep their defaults.
struct Settings {
  SensorOptions sensor;          ///< `[sensor]`
  ExtractionOptions extraction;  ///< `[extraction]`, `[range_image]`, `[scan_line]`
  PoleMapOptions map;            ///< `[map]`
  MapUpdateOptions upkeep;       ///< `[map_update]`
  LikelihoodOptions likelihood;  ///< `[likelihood]`
  MotionOptions motion;          ///< `[motion]`
  VehicleOptions vehicle;        ///< `[vehicle]`, and the sections of its LiDARs
  /// `[filter] [tracking] [submap] [health] [search] [odometry_monitor]`
  LocalizationOptions localization;
  GlobalOptions global;               ///< `[global]`
  StartOptions start;                 ///< `[start]`
  RunOptions runs;                    ///< `[runs]`
  report::ViewOptions view;           ///< `[view]`
  sim::SimulationOptions simulation;  ///< `[simulation]`, `[world]`; sensor as in `[sensor]`

  /// \brief What the extraction needs.
  ObservationPoleExtractorOptions poleExtraction() const { return {sensor, extraction}; }
  /// \brief What reading rawlogs and sensors needs.
  SequenceOptions reading() const;
};

/// \brief Binds all sections, in the order of the reference page.
void bind(Binder& binder, Settings& settings);

/// \brief Reads an INI file.
/// \param path A file, or the name of an installed one such as `hdl32e.ini`. The same holds for the
/// model of detections that the file names (io::installedFile()).
/// \param assignments Values that take the place of the file's, each `section.key=value`: what
/// `--set` of the programs gives.
/// \throws Error naming file, section, key, value and what is allowed: unknown sections or keys,
///         wrong types, values out of range.
Settings loadSettings(const std::string& path, const std::vector<std::string>& assignments = {});
/// \brief The same from an INI file in memory.
Settings settingsFrom(ConfigFile file, const std::vector<std::string>& assignments);

/// \brief Settings as an INI file, every key with unit, allowed values and meaning. Reading it
/// with all tiers gives the same settings, bit for bit.
/// \param most Keys of later tiers are left out.
std::string settingsText(const Settings& settings, Tier most = Tier::expert);
/// \brief Writes settingsText(), atomically. \throws Error when it cannot be written.
void saveSettings(const Settings& settings, const std::string& path);

/// \brief The reference pages of all settings: names of files in share/doc and their Markdown.
/// settings.md says what is where; each other page has sections, as tables with key, default,
/// allowed values, tier and meaning.
std::map<std::string, std::string> settingsPages();

}  // namespace polemcl::apps
