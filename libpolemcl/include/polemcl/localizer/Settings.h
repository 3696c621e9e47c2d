#pragma once
/// \file Settings.h
/// \brief All settings of extraction, mapping and localization, as the programs read them.

#include <memory>
#include <string>
#include <vector>

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/export.h>

namespace polemcl {

struct SettingsValues;  // private to the library

/// \brief The settings of an INI file. share/doc/settings.md lists the keys; what a file leaves out
/// has its default. Sections of the simulator and of the view are passed over.
class POLEMCL_EXPORT Settings {
 public:
  Settings();  ///< defaults
  /// \param file A path, or the name of an installed file such as `hdl32e.ini`.
  /// \param assignments Values in place of the file's, each `section.key=value`.
  /// \throws Error naming file, section, key, value and what is allowed.
  explicit Settings(const std::string& file, const std::vector<std::string>& assignments = {});
  explicit Settings(SettingsValues values);
  Settings(const Settings& other);
  Settings& operator=(const Settings& other);
  Settings(Settings&&) noexcept;
  Settings& operator=(Settings&&) noexcept;
  ~Settings();

  /// \brief Replaces one value. \param assignment `section.key=value`.
  /// \throws Error as the constructor; the settings are then as they were.
  void set(const std::string& assignment);
  /// \brief All of them as an INI file: each key with unit, allowed values and meaning. Read again,
  /// it gives the same settings, bit for bit.
  std::string text() const;

  SensorOptions sensor() const;          ///< `[sensor]`, as for PoleExtractor
  ExtractionOptions extraction() const;  ///< `[extraction] [range_image] [scan_line]`

  const SettingsValues& values() const { return *m_values; }  ///< private to the library

 private:
  std::unique_ptr<SettingsValues> m_values;
};

}  // namespace polemcl
