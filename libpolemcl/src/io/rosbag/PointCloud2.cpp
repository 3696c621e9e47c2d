#include "io/rosbag/PointCloud2.h"

#include <array>
#include <cmath>

namespace polemcl::io {
namespace {

/// Types of fields, as sensor_msgs/msg/PointField numbers them.
enum class FieldType : std::uint8_t {
  int8 = 1,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  float32,
  float64
};

constexpr std::array<std::size_t, 9> kFieldBytes{0, 1, 1, 2, 2, 4, 4, 4, 8};

struct CloudField {
  std::string name;
  std::size_t offset = 0;  ///< in its point, bytes
  FieldType type = FieldType::float32;
};

/// A cloud as the message states it.
struct CloudLayout {
  std::size_t rows = 0, columns = 0;         ///< height and width
  std::size_t pointBytes = 0, rowBytes = 0;  ///< from one point, one row to the next
  bool bigEndian = false;
  std::vector<CloudField> fields;
  std::string_view data;
};

template <class T>
double loadNumber(const char* bytes, bool bigEndian) {
  return static_cast<double>(bigEndian ? loadBigEndian<T>(bytes) : loadLittleEndian<T>(bytes));
}

double fieldValue(const char* point, const CloudField& field, bool bigEndian) {
  const char* bytes = point + field.offset;
  switch (field.type) {
    case FieldType::int8:
      return loadNumber<std::int8_t>(bytes, bigEndian);
    case FieldType::uint8:
      return loadNumber<std::uint8_t>(bytes, bigEndian);
    case FieldType::int16:
      return loadNumber<std::int16_t>(bytes, bigEndian);
    case FieldType::uint16:
      return loadNumber<std::uint16_t>(bytes, bigEndian);
    case FieldType::int32:
      return loadNumber<std::int32_t>(bytes, bigEndian);
    case FieldType::uint32:
      return loadNumber<std::uint32_t>(bytes, bigEndian);
    case FieldType::float32:
      return loadNumber<float>(bytes, bigEndian);
    case FieldType::float64:
      break;
  }
  return loadNumber<double>(bytes, bigEndian);
}

std::vector<CloudField> readFields(CdrReader& reader) {
  constexpr std::size_t kLeast = 4 + 4 + 1 + 4;  // an empty name, offset, type, count
  std::vector<CloudField> fields(reader.getCount(kLeast));
  for (CloudField& field : fields) {
    field.name = reader.getText();
    field.offset = reader.get<std::uint32_t>();
    const auto type = reader.get<std::uint8_t>();
    if (type < 1 || type >= kFieldBytes.size())
      reader.fail("the field " + field.name + " has the type " + std::to_string(type) +
                  "; 1 to 8 are allowed");
    field.type = static_cast<FieldType>(type);
    reader.get<std::uint32_t>();  // values in a field of several; the first one is read
  }
  return fields;
}

CloudLayout readLayout(CdrReader& reader) {
  CloudLayout layout;
  layout.rows = reader.get<std::uint32_t>();
  layout.columns = reader.get<std::uint32_t>();
  layout.fields = readFields(reader);
  layout.bigEndian = reader.get<std::uint8_t>() != 0;
  layout.pointBytes = reader.get<std::uint32_t>();
  layout.rowBytes = reader.get<std::uint32_t>();
  layout.data = reader.getBytes();
  reader.get<std::uint8_t>();  // whether all points are valid
  // Some drivers write no size of the row where there is one only.
  if (layout.rows <= 1) layout.rowBytes = layout.columns * layout.pointBytes;
  if (layout.rows * layout.columns > 0 &&
      (layout.pointBytes == 0 || layout.rowBytes < layout.columns * layout.pointBytes ||
       layout.data.size() / layout.rows < layout.rowBytes))
    reader.fail("cut short: " + std::to_string(layout.data.size()) + " bytes of points; " +
                std::to_string(layout.rows) + " rows of " + std::to_string(layout.columns) +
                " points of " + std::to_string(layout.pointBytes) + " bytes, " +
                std::to_string(layout.rowBytes) + " bytes a row, expected");
  return layout;
}

/// The field of this name; null if no field has it.
const CloudField* findField(const CdrReader& reader, const CloudLayout& layout,
                            const std::string& name) {
  for (const CloudField& field : layout.fields) {
    if (field.name != name) continue;
    if (field.offset + kFieldBytes[static_cast<std::size_t>(field.type)] > layout.pointBytes)
      reader.fail("the field " + name + " lies outside its point of " +
                  std::to_string(layout.pointBytes) + " bytes");
    return &field;
  }
  return nullptr;
}

const CloudField* findCoordinate(const CdrReader& reader, const CloudLayout& layout,
                                 const std::string& name) {
  const CloudField* field = findField(reader, layout, name);
  if (!field || field->type != FieldType::float32)
    reader.fail("no field " + name + " of float32 in the points");
  return field;
}

const CloudField* findTime(const CdrReader& reader, const CloudLayout& layout) {
  for (const char* name : {"t", "time", "timestamp", "time_stamp", "offset_time"}) {
    const CloudField* field = findField(reader, layout, name);
    if (!field) continue;
    if (field->type != FieldType::uint32 && field->type != FieldType::float32 &&
        field->type != FieldType::float64)
      reader.fail("the times of the points, " + field->name +
                  ", are not of uint32, float32 or float64");
    return field;
  }
  return nullptr;
}

/// Time since the stamp, s, from what the field holds.
double timeSince(double stamp, double fieldTime, FieldType type) {
  constexpr double kSince1970 = 1e8, kNanosecondsSince1970 = 1e17;
  if (type == FieldType::uint32) return fieldTime * 1e-9;
  if (type == FieldType::float32 || std::abs(fieldTime) < kSince1970) return fieldTime;
  return (std::abs(fieldTime) < kNanosecondsSince1970 ? fieldTime : fieldTime * 1e-9) - stamp;
}

}  // namespace

RosCloud decodeCloud(std::string_view message, const std::string& where, bool withTimes) {
  CdrReader reader(message, where);
  RosCloud result;
  result.header = readHeader(reader);
  const CloudLayout layout = readLayout(reader);
  const std::size_t points = layout.rows * layout.columns;
  if (points == 0) return result;
  const CloudField *x = findCoordinate(reader, layout, "x"),
                   *y = findCoordinate(reader, layout, "y"),
                   *z = findCoordinate(reader, layout, "z"),
                   *intensity = findField(reader, layout, "intensity"),
                   *time = withTimes ? findTime(reader, layout) : nullptr;
  for (auto* values : {&result.cloud.x, &result.cloud.y, &result.cloud.z, &result.cloud.intensity})
    values->reserve(points);
  for (std::size_t row = 0; row < layout.rows; ++row) {
    const char* point = layout.data.data() + row * layout.rowBytes;
    for (std::size_t i = 0; i < layout.columns; ++i, point += layout.pointBytes) {
      const auto of = [&](const CloudField* field) {
        return fieldValue(point, *field, layout.bigEndian);
      };
      if (!result.cloud.add(of(x), of(y), of(z), intensity ? of(intensity) : 0) || !time) continue;
      const double offset = timeSince(result.header.time, of(time), time->type);
      if (!std::isfinite(offset)) reader.fail("the time of a point is not finite");
      result.offsets.push_back(offset);
    }
  }
  return result;
}

}  // namespace polemcl::io
