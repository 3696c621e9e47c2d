#include <cmath>

#include <polemcl/io/data/Cloud.h>
#include "io/file/Bytes.h"

namespace polemcl::io {

namespace {
constexpr std::size_t kPointBytes = 16;
}

bool Cloud::add(double px, double py, double pz, double pointIntensity) {
  if (!std::isfinite(px + py + pz) || (px == 0 && py == 0 && pz == 0)) {
    ++invalid;
    return false;
  }
  x.push_back(static_cast<float>(px));
  y.push_back(static_cast<float>(py));
  z.push_back(static_cast<float>(pz));
  intensity.push_back(static_cast<float>(pointIntensity));
  return true;
}

Cloud readKittiBin(const std::filesystem::path& file) {
  const std::string bytes = readBytes(file);
  if (bytes.size() % kPointBytes != 0) {
    throw Error(file.string() + ": cut short: " + std::to_string(bytes.size()) +
                " bytes are not a multiple of 16 (float32 x y z intensity a point)");
  }
  Cloud cloud;
  for (auto* field : {&cloud.x, &cloud.y, &cloud.z, &cloud.intensity}) {
    field->reserve(bytes.size() / kPointBytes);
  }
  for (std::size_t i = 0; i < bytes.size(); i += kPointBytes) {
    const char* point = bytes.data() + i;
    cloud.add(loadLittleEndian<float>(point), loadLittleEndian<float>(point + 4),
              loadLittleEndian<float>(point + 8), loadLittleEndian<float>(point + 12));
  }
  return cloud;
}

}  // namespace polemcl::io
