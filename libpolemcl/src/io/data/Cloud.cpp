#include <cmath>

#include <polemcl/io/data/Cloud.h>
#include "io/file/Bytes.h"

namespace polemcl::io {

namespace {
constexpr std::size_t pointBytes = 16;
}

Cloud readKittiBin(const std::filesystem::path& file) {
  const std::string bytes = readBytes(file);
  if (bytes.size() % pointBytes != 0) {
    throw Error(file.string() + ": cut short: " + std::to_string(bytes.size()) +
                " bytes are not a multiple of 16 (float32 x y z intensity a point)");
  }
  Cloud cloud;
  for (auto* field : {&cloud.x, &cloud.y, &cloud.z, &cloud.intensity}) {
    field->reserve(bytes.size() / pointBytes);
  }
  for (std::size_t i = 0; i < bytes.size(); i += pointBytes) {
    const char* point = bytes.data() + i;
    const float x = loadLittleEndian<float>(point), y = loadLittleEndian<float>(point + 4),
                z = loadLittleEndian<float>(point + 8);
    const bool finite = std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
    if (!finite || (x == 0 && y == 0 && z == 0)) {
      ++cloud.invalid;
      continue;
    }
    cloud.x.push_back(x);
    cloud.y.push_back(y);
    cloud.z.push_back(z);
    cloud.intensity.push_back(loadLittleEndian<float>(point + 12));
  }
  return cloud;
}

}  // namespace polemcl::io
