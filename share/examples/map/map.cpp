// A map from scans at known poses: map FOLDER OUT.polemap. FOLDER is what pole-simulate writes:
// velodyne/000000.bin, …, and the poses of the LiDAR in poses.txt (12 numbers a line, as KITTI).
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include <polemcl/polemcl.h>

int main(int count, char** arguments) try {
  if (count != 3) throw polemcl::Error("usage: map FOLDER OUT.polemap");
  const std::string folder = arguments[1];
  polemcl::MapBuilder builder(polemcl::Settings("hdl32e.ini"));
  std::ifstream times(folder + "/times.txt"), poses(folder + "/poses.txt");
  double time = 0;
  int scans = 0;
  for (double T[12]; times >> time; ++scans) {
    for (double& number : T) poses >> number;
    char name[32];
    std::snprintf(name, sizeof name, "/velodyne/%06d.bin", scans);
    builder.add(time, polemcl::io::readKittiBin(folder + name).view(),
                {T[3], T[7], std::atan2(T[4], T[0])});
  }
  builder.save(arguments[2]);
  std::printf("%d scans, %zu poles\n", scans, builder.poles().size());
  return 0;
} catch (const polemcl::Error& error) {
  std::fprintf(stderr, "map: %s\n", error.what());
  return 1;
}
