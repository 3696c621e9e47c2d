#include "io/rosbag/PointCloud2.h"

namespace polemcl::io {
namespace {

std::vector<PackedField> readFields(CdrReader& reader) {
  constexpr std::size_t kLeast = 4 + 4 + 1 + 4;  // an empty name, offset, type, count
  std::vector<PackedField> fields(reader.getCount(kLeast));
  for (PackedField& field : fields) {
    field.name = reader.getText();
    field.offset = reader.get<std::uint32_t>();
    field.type = reader.get<std::uint8_t>();
    reader.get<std::uint32_t>();  // values in a field of several; the first one is read
  }
  return fields;
}

PackedCloud readPacked(CdrReader& reader, double stamp) {
  PackedCloud packed;
  packed.stamp = stamp;
  packed.rows = reader.get<std::uint32_t>();
  packed.columns = reader.get<std::uint32_t>();
  packed.fields = readFields(reader);
  packed.bigEndian = reader.get<std::uint8_t>() != 0;
  packed.pointBytes = reader.get<std::uint32_t>();
  packed.rowBytes = reader.get<std::uint32_t>();
  packed.data = reader.getBytes();
  reader.get<std::uint8_t>();  // whether all points are valid
  return packed;
}

}  // namespace

RosCloud decodeCloud(std::string_view message, const std::string& where, bool withTimes) {
  CdrReader reader(message, where);
  RosCloud result;
  result.header = readHeader(reader);
  static_cast<TimedCloud&>(result) =
      unpack(readPacked(reader, result.header.time), where, withTimes);
  return result;
}

}  // namespace polemcl::io
