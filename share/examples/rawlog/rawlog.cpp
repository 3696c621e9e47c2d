// What pole-localize does: rawlog DRIVE.rawlog MAP.polemap SETTINGS.ini. The rawlog holds scans or
// poles, with odometry; [start] of the settings says where it begins. Prints time, x, y, yaw, sigma
// and health of each scan. With the config.ini of a pole-localize the poses are the same.
#include <cmath>
#include <cstdio>
#include <memory>

#include <polemcl/polemcl.h>

int main(int count, char** arguments) try {
  if (count != 4) throw polemcl::Error("usage: rawlog DRIVE.rawlog MAP.polemap SETTINGS.ini");
  polemcl::SequenceOptions reading;
  auto map = std::make_shared<polemcl::CPoleMap>();
  polemcl::LocalizationOptions options;
  polemcl::GlobalOptions global;
  polemcl::StartOptions start;
  polemcl::RunOptions runs;
  polemcl::ConfigReader reader(polemcl::ConfigFile::readInstalled(arguments[3]));
  bind(reader, reading.extraction.sensor);
  bind(reader, reading.extraction.extraction);
  bind(reader, reading.vehicle, reading.extraction.sensor, reading.extraction.extraction);
  bind(reader, reading.motion);
  bind(reader, map->likelihoodOptions);  // before the map is loaded: its index is made for them
  bind(reader, options);
  bind(reader, global);
  bind(reader, start);
  bind(reader, runs);
  reader.finish();

  map->loadFromPoleMapFile(arguments[2]);
  polemcl::LocalizationPipeline pipeline({map, global}, options, runs.seed);
  if (start.anywhere)
    pipeline.initializeGlobally();
  else
    pipeline.start(start);
  polemcl::streamPoles(arguments[1], reading, [&](const polemcl::PoleScan& scan) {
    const auto update = pipeline.step(polemcl::frameOf(scan));
    if (!update.estimate) return;  // not found yet
    const auto& [pose, covariance] = *update.estimate;
    const double sigma = std::sqrt((covariance(0, 0) + covariance(1, 1)) / 2);
    std::printf("%.9f %.9f %.9f %.9f %.3f %s\n", update.time, pose.x, pose.y, pose.yaw, sigma,
                polemcl::name(update.health.state));
  });
  return 0;
} catch (const polemcl::Error& error) {
  std::fprintf(stderr, "rawlog: %s\n", error.what());
  return 1;
}
