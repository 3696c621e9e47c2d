// From points to poses: localize FOLDER MAP.polemap X Y YAW. FOLDER is what pole-simulate writes;
// the last three are the pose at the first scan, roughly (m, rad). Prints time, x, y, yaw.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include <polemcl/polemcl.h>

int main(int count, char** arguments) try {
  if (count != 6) throw polemcl::Error("usage: localize FOLDER MAP.polemap X Y YAW");
  const std::string folder = arguments[1];
  polemcl::SensorOptions sensor;
  sensor.model = "hdl32e";
  sensor.height = 1.0;
  polemcl::PoleExtractor extractor(sensor, polemcl::ExtractionOptions());
  auto map = std::make_shared<polemcl::CPoleMap>();
  map->loadFromPoleMapFile(arguments[2]);
  const polemcl::LocalizationOptions options;
  polemcl::LocalizationPipeline pipeline({map, polemcl::GlobalOptions()}, options, 1);
  polemcl::StartOptions start;
  start.pose =
      polemcl::Pose2D{std::atof(arguments[3]), std::atof(arguments[4]), std::atof(arguments[5])};
  pipeline.start(start);

  std::ifstream times(folder + "/times.txt"), odometry(folder + "/odometry.txt");
  std::string heading;
  std::getline(odometry, heading);
  polemcl::PoleFrame frame;
  frame.motion = polemcl::io::PlanarMotion();  // none before the first scan
  for (int i = 0; times >> frame.time; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "/velodyne/%06d.bin", i);
    frame.poles_robot = extractor.extract(polemcl::io::readKittiBin(folder + name).view());
    const auto update = pipeline.step(frame);
    if (update.estimate) {
      const polemcl::Pose2D& pose = update.estimate->mean;
      std::printf("%.3f %.3f %.3f %.4f\n", frame.time, pose.x, pose.y, pose.yaw);
    }
    polemcl::Pose2D moved, sigma;  // from this scan to the next: the row of the next one
    odometry >> moved.x >> moved.y >> moved.yaw >> sigma.x >> sigma.y >> sigma.yaw;
    frame.motion->mean = moved;
    frame.motion->covariance.diagonal() << sigma.x * sigma.x, sigma.y * sigma.y,
        sigma.yaw * sigma.yaw;
  }
  return 0;
} catch (const polemcl::Error& error) {
  std::fprintf(stderr, "localize: %s\n", error.what());
  return 1;
}
