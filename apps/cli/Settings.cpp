#include "cli/Settings.h"

#include <polemcl/config/Config.h>
#include "cli/Messages.h"
#include "io/file/InstalledFiles.h"

namespace polemcl::apps {
namespace {

/// The simulated LiDAR is the one that the extraction is told of.
void shareSensor(Settings& settings) {
  // What the extraction calls hdl64e are the angles of KITTI's unit, not those of the data sheet.
  settings.simulation.sensor =
      settings.sensor.model == "hdl64e" ? "hdl64e_kitti" : settings.sensor.model;
  settings.simulation.height = settings.sensor.height;
  settings.simulation.upsideDown = settings.sensor.upsideDown;
  settings.simulation.originX = settings.sensor.originX;
  settings.simulation.originY = settings.sensor.originY;
  settings.simulation.originZ = settings.sensor.originZ;
}

ConfigWriter written(const Settings& settings, Tier most) {
  ConfigWriter writer(most);
  Settings copy = settings;
  bind(writer, copy);
  return writer;
}

}  // namespace

SequenceOptions Settings::reading() const {
  SequenceOptions options;
  options.extraction = poleExtraction();
  options.motion = motion;
  options.vehicle = vehicle;
  return options;
}

void bind(Binder& binder, Settings& settings) {
  bind(binder, settings.sensor);
  bind(binder, settings.extraction);
  bind(binder, settings.vehicle, settings.sensor, settings.extraction);
  bind(binder, settings.map);
  bind(binder, settings.upkeep);
  bind(binder, settings.likelihood);
  bind(binder, settings.motion);
  bind(binder, settings.localization.filter);
  bind(binder, settings.start);
  bind(binder, settings.localization.tracking);
  bind(binder, settings.localization.submap);
  bind(binder, settings.global);
  bind(binder, settings.localization.health);
  bind(binder, settings.localization.search);
  bind(binder, settings.localization.odometryMonitor);
  bind(binder, settings.localization.odometryCalibration);
  bind(binder, settings.runs);
  bind(binder, settings.view);
  bind(binder, settings.simulation);
}

Settings loadSettings(const std::string& path, const std::vector<std::string>& assignments) {
  const std::string file = io::installedFile(path, "config").string();
  sayDetail("settings: " + file);
  return settingsFrom(ConfigFile::read(file), assignments);
}

Settings settingsFrom(ConfigFile file, const std::vector<std::string>& assignments) {
  Settings settings;
  for (const auto& assignment : assignments) file.set(assignment);
  ConfigReader reader(file);
  bind(reader, settings);
  reader.finish();
  auto& detections = settings.simulation.detections;
  detections = io::installedFile(detections, "models").string();
  shareSensor(settings);
  return settings;
}

std::string settingsText(const Settings& settings, Tier most) {
  return written(settings, most).text();
}

void saveSettings(const Settings& settings, const std::string& path) {
  written(settings, Tier::expert).save(path);
}

}  // namespace polemcl::apps
