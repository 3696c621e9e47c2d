// What pole-localize does: rawlog DRIVE.rawlog MAP.polemap SETTINGS.ini. The rawlog holds scans or
// poles, with odometry; [start] of the settings says where it begins. Prints time, x, y, yaw, sigma
// and health of each scan. With the config.ini of a pole-localize the poses are the same.
#include <cmath>
#include <cstdio>

#include <polemcl/polemcl.h>

int main(int count, char** arguments) try {
  if (count != 4) throw polemcl::Error("usage: rawlog DRIVE.rawlog MAP.polemap SETTINGS.ini");
  polemcl::Localizer localizer(polemcl::Settings(arguments[3]), arguments[2]);
  localizer.play(arguments[1], [](const polemcl::LocalizationUpdate& update) {
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
