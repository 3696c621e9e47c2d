// Poles of one scan, without MRPT: extract SCAN.bin (float32 x y z intensity, as KITTI has it).
#include <cstdio>
#include <fstream>
#include <vector>

#include <polemcl/core.h>

int main(int count, char** arguments) try {
  if (count != 2) throw polemcl::Error("usage: extract SCAN.bin");
  std::vector<float> x, y, z;  // the frame of the LiDAR: m, origin at its optical centre, z up
  std::ifstream file(arguments[1], std::ios::binary);
  for (float point[4]; file.read(reinterpret_cast<char*>(point), sizeof point);) {
    x.push_back(point[0]);
    y.push_back(point[1]);
    z.push_back(point[2]);
  }
  polemcl::SensorOptions sensor;
  sensor.model = "hdl32e";
  sensor.height = 1.0;  // m above ground
  polemcl::PoleExtractor extractor(sensor, polemcl::ExtractionOptions());
  for (const auto& pole : extractor.extract({x.data(), y.data(), z.data(), x.size()}))
    std::printf("%.2f %.2f %.2f\n", pole.x, pole.y, pole.radius);
  return 0;
} catch (const polemcl::Error& error) {
  std::fprintf(stderr, "extract: %s\n", error.what());
  return 1;
}
