#include "io/dataset/LabelledScans.h"

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
    const char* point = points.data() + 16 * i;
    if (result.cloud.add(loadLittleEndian<float>(point), loadLittleEndian<float>(point + 4),
                         loadLittleEndian<float>(point + 8), loadLittleEndian<float>(point + 12)))
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
    poles.push_back({table.count(row, id), table.number(row, x), table.number(row, y),
                     table.number(row, radius), table.number(row, top)});
  }
  return poles;
}

}  // namespace polemcl::io
