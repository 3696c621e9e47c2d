#include "cli/Settings.h"

#include "cli/Messages.h"
#include "config/Config.h"
#include "core/common/Binder.h"
#include "io/file/InstalledFiles.h"

namespace polemcl::apps {
namespace {

/// The simulated LiDAR is the one that the extraction is told of.
void shareSensor(AllSettings& settings) {
  // What the extraction calls hdl64e are the angles of KITTI's unit, not those of the data sheet.
  settings.simulation.sensor =
      settings.sensor.model == "hdl64e" ? "hdl64e_kitti" : settings.sensor.model;
  settings.simulation.height = settings.sensor.height;
  settings.simulation.upsideDown = settings.sensor.upsideDown;
  settings.simulation.originX = settings.sensor.originX;
  settings.simulation.originY = settings.sensor.originY;
  settings.simulation.originZ = settings.sensor.originZ;
}

ConfigWriter written(const AllSettings& settings, Tier most) {
  ConfigWriter writer(most);
  AllSettings copy = settings;
  bind(writer, copy);
  return writer;
}

}  // namespace

void bind(Binder& binder, AllSettings& settings) {
  bind(binder, static_cast<SettingsValues&>(settings));
  bind(binder, settings.view);
  bind(binder, settings.simulation);
}

AllSettings loadSettings(const std::string& path, const std::vector<std::string>& assignments) {
  sayDetail("settings: " + io::installedFile(path, "config").string());
  return settingsFrom(ConfigFile::readInstalled(path), assignments);
}

AllSettings settingsFrom(ConfigFile file, const std::vector<std::string>& assignments) {
  AllSettings settings;
  for (const auto& assignment : assignments) file.set(assignment);
  ConfigReader reader(file);
  bind(reader, settings);
  reader.finish();
  auto& detections = settings.simulation.detections;
  detections = io::installedFile(detections, "models").string();
  shareSensor(settings);
  return settings;
}

std::string settingsText(const AllSettings& settings, Tier most) {
  return written(settings, most).text();
}

void saveSettings(const AllSettings& settings, const std::string& path) {
  written(settings, Tier::expert).save(path);
}

}  // namespace polemcl::apps
