#include <polemcl/localizer/Settings.h>
#include "config/Config.h"
#include "core/common/Binder.h"
#include "localizer/SettingsValues.h"

namespace polemcl {
namespace {

SettingsValues read(ConfigFile file, const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) file.set(assignment);
  SettingsValues values;
  ConfigReader reader(file);
  bind(reader, values);
  reader.finish({"view", "simulation", "world", "realism"});  // of the programs
  return values;
}

}  // namespace

SequenceOptions SettingsValues::reading() const {
  SequenceOptions options;
  options.extraction = poleExtraction();
  options.motion = motion;
  options.vehicle = vehicle;
  return options;
}

void bind(Binder& binder, SettingsValues& values) {
  bind(binder, values.sensor);
  bind(binder, values.extraction);
  bind(binder, values.vehicle, values.sensor, values.extraction);
  bind(binder, values.map);
  bind(binder, values.upkeep);
  bind(binder, values.likelihood);
  bind(binder, values.motion);
  bind(binder, values.start);
  bind(binder, values.localization);
  bind(binder, values.runs);
}

Settings::Settings() : Settings(SettingsValues()) {}
Settings::Settings(const std::string& file, const std::vector<std::string>& assignments)
    : Settings(read(ConfigFile::readInstalled(file), assignments)) {}
Settings::Settings(SettingsValues values)
    : m_values(std::make_unique<SettingsValues>(std::move(values))) {}
Settings::Settings(const Settings& other) : Settings(other.values()) {}
Settings& Settings::operator=(const Settings& other) {
  m_values = std::make_unique<SettingsValues>(other.values());
  return *this;
}
Settings::Settings(Settings&&) noexcept = default;
Settings& Settings::operator=(Settings&&) noexcept = default;
Settings::~Settings() = default;

SensorOptions Settings::sensor() const {
  return m_values->sensor;
}

ExtractionOptions Settings::extraction() const {
  return m_values->extraction;
}

void Settings::set(const std::string& assignment) {
  *m_values = read(ConfigFile::fromText(text(), "settings"), {assignment});
}

std::string Settings::text() const {
  ConfigWriter writer;
  SettingsValues copy = *m_values;
  bind(writer, copy);
  return writer.text();
}

}  // namespace polemcl
