// A map from scans at known poses: map FOLDER OUT.polemap. FOLDER is what pole-simulate writes:
// velodyne/000000.bin, …, and the poses of the LiDAR in poses.txt (12 numbers a line, as KITTI).
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <polemcl/polemcl.h>

int main(int count, char** arguments) try {
  if (count != 3) throw polemcl::Error("usage: map FOLDER OUT.polemap");
  const std::string folder = arguments[1];
  polemcl::SensorOptions sensor;
  sensor.model = "hdl32e";
  sensor.height = 1.0;
  polemcl::PoleExtractor extractor(sensor, polemcl::ExtractionOptions());
  std::vector<polemcl::MappingScan> scans;
  std::ifstream poses(folder + "/poses.txt");
  const auto next = [&](double& number) { return static_cast<bool>(poses >> number); };
  for (double T[12]; next(T[0]);) {
    for (int i = 1; i < 12; ++i) next(T[i]);
    char name[32];
    std::snprintf(name, sizeof name, "/velodyne/%06zu.bin", scans.size());
    polemcl::MappingScan scan;
    scan.pose_map_robot = {T[3], T[7], std::atan2(T[4], T[0])};
    scan.poles_robot = extractor.extract(polemcl::io::readKittiBin(folder + name).view());
    scans.push_back(scan);
  }
  polemcl::CPoleMap map;
  map.setPoles(polemcl::buildPoleMap(scans, polemcl::PoleMapOptions()).poles);
  map.saveToPoleMapFile(arguments[2]);
  std::printf("%zu scans, %zu poles\n", scans.size(), map.poles().size());
  return 0;
} catch (const polemcl::Error& error) {
  std::fprintf(stderr, "map: %s\n", error.what());
  return 1;
}
