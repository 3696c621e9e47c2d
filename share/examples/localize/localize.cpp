// From points to poses: localize FOLDER MAP.polemap X Y YAW. FOLDER is what pole-simulate writes;
// the last three are the pose at the first scan, roughly (m, rad). Prints time, x, y, yaw.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include <polemcl/polemcl.h>

int main(int count, char** arguments) try {
  if (count != 6) throw polemcl::Error("usage: localize FOLDER MAP.polemap X Y YAW");
  const std::string folder = arguments[1];
  polemcl::Localizer localizer(polemcl::Settings("hdl32e.ini"), arguments[2]);
  localizer.start({std::atof(arguments[3]), std::atof(arguments[4]), std::atof(arguments[5])});

  std::ifstream times(folder + "/times.txt"), motions(folder + "/odometry.txt");
  std::string line;
  std::getline(motions, line);  // heading
  polemcl::Pose2D odometry;     // the way of the robot, as its wheels tell it
  double time = 0;
  for (int i = 0; times >> time; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "/velodyne/%06d.bin", i);
    const polemcl::io::Cloud cloud = polemcl::io::readKittiBin(folder + name);
    const auto update = localizer.step(time, cloud.view(), odometry);
    if (update.estimate) {
      const polemcl::Pose2D& pose = update.estimate->mean;
      std::printf("%.3f %.3f %.3f %.4f\n", time, pose.x, pose.y, pose.yaw);
    }
    polemcl::Pose2D moved;  // from this scan to the next
    motions >> moved.x >> moved.y >> moved.yaw;
    std::getline(motions, line);  // how exact that is
    odometry = compose(odometry, moved);
  }
  return 0;
} catch (const polemcl::Error& error) {
  std::fprintf(stderr, "localize: %s\n", error.what());
  return 1;
}
