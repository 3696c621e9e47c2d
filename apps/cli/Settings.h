#pragma once
/// \file Settings.h
/// \brief One INI serves all programs: the union of all option structs.

#include <string>
#include <vector>

#include "core/common/Binder.h"
#include "localizer/SettingsValues.h"
#include "report/scene/ViewOptions.h"
#include "sim/common/SimulationOptions.h"

namespace polemcl {
class ConfigFile;
}

namespace polemcl::apps {

/// \brief All settings of all programs. Sections that a file leaves out keep their defaults.
struct AllSettings : SettingsValues {
  report::ViewOptions view;           ///< `[view]`
  sim::SimulationOptions simulation;  ///< `[simulation]`, `[world]`; sensor as in `[sensor]`
};

/// \brief Binds all sections, in the order of the reference page.
void bind(Binder& binder, AllSettings& settings);

/// \brief Reads an INI file.
/// \param path A file, or the name of an installed one such as `hdl32e.ini`. The same holds for the
/// model of detections that the file names (io::installedFile()).
/// \param assignments Values that take the place of the file's, each `section.key=value`: what
/// `--set` of the programs gives.
/// \throws Error naming file, section, key, value and what is allowed: unknown sections or keys,
///         wrong types, values out of range.
AllSettings loadSettings(const std::string& path, const std::vector<std::string>& assignments = {});
/// \brief The same from an INI file in memory.
AllSettings settingsFrom(ConfigFile file, const std::vector<std::string>& assignments);

/// \brief Settings as an INI file, every key with unit, allowed values and meaning. Reading it
/// with all tiers gives the same settings, bit for bit.
/// \param most Keys of later tiers are left out.
std::string settingsText(const AllSettings& settings, Tier most = Tier::expert);
/// \brief Writes settingsText(), atomically. \throws Error when it cannot be written.
void saveSettings(const AllSettings& settings, const std::string& path);

}  // namespace polemcl::apps
