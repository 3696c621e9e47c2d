#include <algorithm>
#include <array>
#include <cmath>

#include <polemcl/io/rosbag/PackedCloud.h>
#include "io/file/Bytes.h"

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

template <class T>
double loadNumber(const char* bytes, bool bigEndian) {
  return static_cast<double>(bigEndian ? loadBigEndian<T>(bytes) : loadLittleEndian<T>(bytes));
}

double fieldValue(const char* point, const PackedField& field, bool bigEndian) {
  const char* bytes = point + field.offset;
  switch (static_cast<FieldType>(field.type)) {
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

/// Bytes from one row to the next. Some drivers write none where there is one row only.
std::size_t rowBytesOf(const PackedCloud& packed, const std::string& where) {
  const std::size_t least = packed.columns * packed.pointBytes;
  const std::size_t row = packed.rows == 1 ? least : packed.rowBytes;
  if (packed.pointBytes == 0 || row < least || packed.data.size() / packed.rows < row)
    throw Error(where + "cut short: " + std::to_string(packed.data.size()) + " bytes of points; " +
                std::to_string(packed.rows) + " rows of " + std::to_string(packed.columns) +
                " points of " + std::to_string(packed.pointBytes) + " bytes, " +
                std::to_string(row) + " bytes a row, expected");
  return row;
}

bool is(const PackedField& field, FieldType type) {
  return field.type == static_cast<std::uint8_t>(type);
}

/// The field of this name; null if no field has it.
const PackedField* findField(const PackedCloud& packed, const std::string& where,
                             const std::string& name) {
  for (const PackedField& field : packed.fields) {
    if (field.name != name) continue;
    if (field.type < 1 || field.type >= kFieldBytes.size())
      throw Error(where + "the field " + name + " has the type " + std::to_string(field.type) +
                  "; 1 to 8 are allowed");
    if (field.offset + kFieldBytes[field.type] > packed.pointBytes)
      throw Error(where + "the field " + name + " lies outside its point of " +
                  std::to_string(packed.pointBytes) + " bytes");
    return &field;
  }
  return nullptr;
}

const PackedField* findCoordinate(const PackedCloud& packed, const std::string& where,
                                  const std::string& name) {
  const PackedField* field = findField(packed, where, name);
  if (!field || !(is(*field, FieldType::float32) || is(*field, FieldType::float64)))
    throw Error(where + "no field " + name + " of float32 or float64 in the points");
  return field;
}

const PackedField* findTime(const PackedCloud& packed, const std::string& where) {
  for (const char* name : {"t", "time", "timestamp", "time_stamp", "offset_time"}) {
    const PackedField* field = findField(packed, where, name);
    if (field && (is(*field, FieldType::uint32) || is(*field, FieldType::float32) ||
                  is(*field, FieldType::float64)))
      return field;
  }
  return nullptr;
}

/// Time since the stamp, s, from what the field holds.
double timeSince(double stamp, double fieldTime, FieldType type) {
  constexpr double kSince1970 = 1e8, kMostSeconds = 1e11, kLongTurn = 1;
  if (type == FieldType::uint32) return fieldTime * 1e-9;
  const bool isNearStamp = fieldTime > kLongTurn && std::abs(fieldTime - stamp) < kLongTurn;
  if (type == FieldType::float32 || (std::abs(fieldTime) < kSince1970 && !isNearStamp))
    return fieldTime;
  double seconds = fieldTime;
  while (std::abs(seconds) > kMostSeconds && std::isfinite(seconds)) seconds *= 1e-3;
  return seconds - stamp;
}

}  // namespace

TimedCloud unpack(const PackedCloud& packed, const std::string& where, bool withTimes) {
  TimedCloud result;
  const std::size_t points = packed.rows * packed.columns;
  if (points == 0) return result;
  const std::size_t rowBytes = rowBytesOf(packed, where);
  const PackedField *x = findCoordinate(packed, where, "x"),
                    *y = findCoordinate(packed, where, "y"),
                    *z = findCoordinate(packed, where, "z"),
                    *intensity = findField(packed, where, "intensity"),
                    *time = withTimes ? findTime(packed, where) : nullptr;
  for (auto* values : {&result.cloud.x, &result.cloud.y, &result.cloud.z, &result.cloud.intensity})
    values->reserve(points);
  for (std::size_t row = 0; row < packed.rows; ++row) {
    const char* point = packed.data.data() + row * rowBytes;
    for (std::size_t i = 0; i < packed.columns; ++i, point += packed.pointBytes) {
      const auto of = [&](const PackedField* field) {
        return fieldValue(point, *field, packed.bigEndian);
      };
      if (!result.cloud.add(of(x), of(y), of(z), intensity ? of(intensity) : 0) || !time) continue;
      const double offset = timeSince(packed.stamp, of(time), static_cast<FieldType>(time->type));
      result.offsets.push_back(offset);
    }
  }
  const auto isFinite = [](double offset) { return std::isfinite(offset); };
  if (!std::all_of(result.offsets.begin(), result.offsets.end(), isFinite)) result.offsets.clear();
  return result;
}

}  // namespace polemcl::io
