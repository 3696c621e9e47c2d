#include "io/dataset/LabelledScans.h"

#include <cmath>
#include <string>

#include "io/file/Bytes.h"
#include "io/file/CsvTable.h"

namespace polemcl::io {

LabelledCloud readLabelledCloud(const std::filesystem::path& bin,
                                const std::filesystem::path& label) {
  const std::string points = readBytes(bin), labels = readBytes(label);
  if (points.size() % 16 != 0 || labels.size() % 4 != 0 || points.size() / 16 != labels.size() / 4)
    throw Error(label.string() + ": " + std::to_string(labels.size()) +
                " bytes are not one label (4 bytes) for each point (16 bytes) of " + bin.string() +
                ", which has " + std::to_string(points.size()) + " bytes");
  LabelledCloud result;
  for (std::size_t i = 0; i < points.size() / 16; ++i) {
    float value[4];
    for (std::size_t k = 0; k < 4; ++k)
      value[k] = loadLittleEndian<float>(points.data() + 16 * i + 4 * k);
    const auto [x, y, z, intensity] = value;
    if (!std::isfinite(x + y + z) || (x == 0 && y == 0 && z == 0)) {
      ++result.cloud.invalid;
      continue;
    }
    result.cloud.x.push_back(x);
    result.cloud.y.push_back(y);
    result.cloud.z.push_back(z);
    result.cloud.intensity.push_back(intensity);
    result.labels.push_back(loadLittleEndian<std::uint32_t>(labels.data() + 4 * i));
  }
  return result;
}

std::filesystem::path labelFile(const std::filesystem::path& bin) {
  const auto folder = std::filesystem::absolute(bin).parent_path().parent_path();
  return (folder / "labels" / bin.filename()).replace_extension(".label");
}

std::vector<WorldPole> readWorldPoles(const std::filesystem::path& file) {
  const CsvTable table(file);
  const auto id = table.column("id"), x = table.column("x"), y = table.column("y"),
             radius = table.column("radius"), top = table.column("top");
  std::vector<WorldPole> poles;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double number = table.number(row, id);
    if (!(number >= 0 && number <= 4294967295.0 && number == std::floor(number)))
      throw Error(table.at(row) + "the id must be a whole number from 0 to 4294967295");
    poles.push_back({static_cast<std::uint32_t>(number), table.number(row, x), table.number(row, y),
                     table.number(row, radius), table.number(row, top)});
  }
  return poles;
}

}  // namespace polemcl::io
