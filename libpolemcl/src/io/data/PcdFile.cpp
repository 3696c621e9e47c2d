#include "io/data/PcdFile.h"

#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "io/file/Bytes.h"
#include "io/file/ReadLimits.h"
#include "io/file/TextFile.h"

namespace polemcl::io {
namespace {

/// One field of the points.
struct Field {
  std::string name;
  char type = 'F';         ///< F float, I signed, U unsigned
  std::size_t size = 4;    ///< bytes per value
  std::size_t count = 1;   ///< values per point
  std::size_t offset = 0;  ///< byte offset of the first value in a binary point
  std::size_t column = 0;  ///< column of the first value in an ascii point
};

struct Header {
  std::vector<Field> fields;
  std::size_t pointBytes = 0, columns = 0, points = 0;
  std::size_t lines = 0, bytes = 0;  ///< size of the header
  enum class Data { ascii, binary, compressed } data = Data::ascii;
};

std::size_t pcdCountOf(const std::string& word, const std::string& where) {
  const auto value = parseNumber(word);
  if (!value || !(*value >= 0 && *value <= 1e12) || *value != std::floor(*value))
    throw Error(where + "'" + word + "' is not a count");
  return static_cast<std::size_t>(*value);
}

/// Collects the lines of the header, in any order.
class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& file, std::string_view bytes)
      : m_file(file), m_bytes(bytes) {}

  Header read() {
    while (!m_ended) takeLine();
    if (m_header.fields.empty()) throw Error(m_file.string() + ": no FIELDS in its header");
    const std::size_t width = m_width.value_or(0), height = m_height.value_or(1);
    if (height > 0 && width > std::numeric_limits<std::size_t>::max() / height)
      throw Error(m_file.string() + ": WIDTH times HEIGHT is too large");
    m_header.points = m_points.value_or(width * height);
    layOut();
    return m_header;
  }

 private:
  void takeLine() {
    const std::size_t end = m_bytes.find('\n', m_header.bytes);
    if (end == std::string_view::npos)
      throw Error(m_file.string() + ": not a PCD file: its header has no line DATA");
    const auto words = wordsOf(m_bytes.substr(m_header.bytes, end - m_header.bytes));
    m_header.bytes = end + 1;
    const std::string where = at(m_file, ++m_header.lines);
    if (words.empty() || words[0][0] == '#') return;
    const std::string& key = words[0];
    if (key == "FIELDS" || key == "COLUMNS") {
      m_header.fields.resize(words.size() - 1);
      for (std::size_t i = 1; i < words.size(); ++i) m_header.fields[i - 1].name = words[i];
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      describe(words, where);
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
      if (words.size() != 2) throw Error(where + key + " must have one number");
      const std::size_t value = pcdCountOf(words[1], where);
      (key == "POINTS" ? m_points : key == "WIDTH" ? m_width : m_height) = value;
    } else if (key == "DATA") {
      startData(words, where);
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      throw Error(where + "not a PCD file: '" + key.substr(0, 20) +
                  "' is not a PCD header keyword");
    }
  }

  void describe(const std::vector<std::string>& words, const std::string& where) {
    if (words.size() != m_header.fields.size() + 1)
      throw Error(where + words[0] + " for " + std::to_string(words.size() - 1) +
                  " fields, FIELDS has " + std::to_string(m_header.fields.size()));
    for (std::size_t i = 1; i < words.size(); ++i) {
      Field& field = m_header.fields[i - 1];
      if (words[0] == "TYPE") {
        field.type = words[i][0];
      } else {
        (words[0] == "SIZE" ? field.size : field.count) = pcdCountOf(words[i], where);
      }
    }
  }

  void startData(const std::vector<std::string>& words, const std::string& where) {
    const std::string kind = words.size() == 2 ? words[1] : "";
    if (kind != "ascii" && kind != "binary" && kind != "binary_compressed")
      throw Error(where + "DATA must be ascii, binary or binary_compressed, not '" + kind + "'");
    m_header.data = kind == "ascii"    ? Header::Data::ascii
                    : kind == "binary" ? Header::Data::binary
                                       : Header::Data::compressed;
    m_ended = true;
  }

  /// Computes offset and column of every field. Needs the complete header.
  void layOut() {
    for (Field& field : m_header.fields) {
      const bool real = field.type == 'F' && (field.size == 4 || field.size == 8);
      const bool whole = (field.type == 'I' || field.type == 'U') &&
                         (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8);
      if (!real && !whole)
        throw Error(m_file.string() + ": field " + field.name + " of TYPE " + field.type +
                    " and SIZE " + std::to_string(field.size) +
                    "; F of 4 or 8 bytes, I or U of 1, 2, 4 or 8 are allowed");
      if (field.count > 4096)
        throw Error(m_file.string() + ": field " + field.name + " has COUNT " +
                    std::to_string(field.count) + "; at most 4096 are allowed");
      field.offset = m_header.pointBytes;
      field.column = m_header.columns;
      m_header.pointBytes += field.size * field.count;
      m_header.columns += field.count;
    }
  }

  std::filesystem::path m_file;
  std::string_view m_bytes;
  Header m_header;
  std::optional<std::size_t> m_width, m_height, m_points;
  bool m_ended = false;
};

/// The fields x, y, z and intensity; intensity is null if the file has none.
std::array<const Field*, 4> wantedFields(const Header& header, const std::filesystem::path& file) {
  std::array<const Field*, 4> wanted{};
  const std::array<const char*, 4> names{"x", "y", "z", "intensity"};
  for (std::size_t i = 0; i < 4; ++i)
    for (const Field& field : header.fields)
      if (field.name == names[i] && field.count == 1) wanted[i] = &field;
  for (std::size_t i = 0; i < 3; ++i)
    if (!wanted[i]) throw Error(file.string() + ": no field " + names[i] + " in it");
  return wanted;
}

template <class Signed, class Unsigned>
double wholeNumber(const char* bytes, bool isSigned) {
  return isSigned ? static_cast<double>(static_cast<Signed>(loadLittleEndian<Unsigned>(bytes)))
                  : static_cast<double>(loadLittleEndian<Unsigned>(bytes));
}

double binaryValue(const char* bytes, const Field& field) {
  if (field.type == 'F')
    return field.size == 4 ? loadLittleEndian<float>(bytes) : loadLittleEndian<double>(bytes);
  const bool isSigned = field.type == 'I';
  switch (field.size) {
    case 1:
      return wholeNumber<std::int8_t, std::uint8_t>(bytes, isSigned);
    case 2:
      return wholeNumber<std::int16_t, std::uint16_t>(bytes, isSigned);
    case 4:
      return wholeNumber<std::int32_t, std::uint32_t>(bytes, isSigned);
    default:
      return wholeNumber<std::int64_t, std::uint64_t>(bytes, isSigned);
  }
}

/// Position of a field's values in binary data.
struct Column {
  const Field* field = nullptr;  ///< null: the file has no such field
  std::size_t begin = 0;         ///< offset of the first point's value, bytes
  std::size_t step = 0;          ///< distance between the values of two points, bytes
};

Cloud readColumns(const std::array<Column, 4>& columns, std::size_t points, const char* data) {
  Cloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    std::array<double, 4> point{};
    for (std::size_t k = 0; k < 4; ++k)
      if (columns[k].field)
        point[k] = binaryValue(data + columns[k].begin + i * columns[k].step, *columns[k].field);
    cloud.add(point[0], point[1], point[2], point[3]);
  }
  return cloud;
}

/// Binary data are stored point by point.
Cloud readBinary(const Header& header, std::string_view data, const std::filesystem::path& file) {
  const auto fields = wantedFields(header, file);
  if (data.size() / header.pointBytes < header.points)
    throw Error(file.string() + ": cut short: " + std::to_string(data.size()) +
                " bytes of points, " + std::to_string(header.points) + " points of " +
                std::to_string(header.pointBytes) + " bytes expected");
  std::array<Column, 4> columns;
  for (std::size_t k = 0; k < 4; ++k)
    if (fields[k]) columns[k] = {fields[k], fields[k]->offset, header.pointBytes};
  return readColumns(columns, header.points, data.data());
}

/// The data start with two uint32 sizes (compressed, uncompressed); LZF data follow.
std::string decompress(const Header& header, std::string_view data,
                       const std::filesystem::path& file) {
  constexpr std::size_t kSizes = 8;
  const std::size_t packed =
      data.size() < kSizes ? 0 : loadLittleEndian<std::uint32_t>(data.data());
  if (data.size() < kSizes || data.size() - kSizes < packed)
    throw Error(file.string() + ": cut short: " + std::to_string(data.size()) +
                " bytes of compressed points, " + std::to_string(kSizes + packed) + " expected");
  const std::size_t size = loadLittleEndian<std::uint32_t>(data.data() + 4);
  if (size > kGreatestLzfRatio * packed)
    throw Error(file.string() + ": damaged: " + std::to_string(packed) +
                " bytes of compressed points cannot hold " + std::to_string(size));
  // Divide instead of multiply: the sizes in the header may be forged and overflow.
  if (size / header.pointBytes != header.points || size % header.pointBytes != 0)
    throw Error(file.string() + ": " + std::to_string(size) + " bytes of points, " +
                std::to_string(header.points) + " points of " + std::to_string(header.pointBytes) +
                " bytes expected");
  std::string points(size, '\0');
  if (size > 0 && lzf_decompress(data.data() + kSizes, static_cast<unsigned>(packed), points.data(),
                                 static_cast<unsigned>(size)) != size)
    throw Error(file.string() + ": its compressed points are damaged (LZF)");
  return points;
}

/// Compressed data are stored field by field.
Cloud readCompressed(const Header& header, std::string_view data,
                     const std::filesystem::path& file) {
  const auto fields = wantedFields(header, file);
  const std::string points = decompress(header, data, file);
  std::array<Column, 4> columns;
  for (std::size_t k = 0; k < 4; ++k)
    if (fields[k])
      columns[k] = {fields[k], fields[k]->offset * header.points,
                    fields[k]->size * fields[k]->count};
  return readColumns(columns, header.points, points.data());
}

Cloud readAscii(const Header& header, std::string_view data, const std::filesystem::path& file) {
  const auto fields = wantedFields(header, file);
  Cloud cloud;
  std::size_t line = header.lines, points = 0;
  for (std::size_t begin = 0; begin < data.size() && points < header.points;) {
    const std::size_t end = std::min(data.find('\n', begin), data.size());
    const auto words = wordsOf(data.substr(begin, end - begin));
    begin = end + 1;
    ++line;
    if (words.empty()) continue;
    if (words.size() != header.columns)
      throw Error(at(file, line) + std::to_string(words.size()) + " values, " +
                  std::to_string(header.columns) + " expected as in the header");
    std::array<double, 4> point{};
    for (std::size_t k = 0; k < 4; ++k) {
      if (!fields[k]) continue;
      const auto value = parseNumber(words[fields[k]->column]);
      if (!value)
        throw Error(at(file, line) + "'" + words[fields[k]->column] + "' is not a number");
      point[k] = *value;
    }
    cloud.add(point[0], point[1], point[2], point[3]);
    ++points;
  }
  if (points < header.points)
    throw Error(file.string() + ": cut short: " + std::to_string(points) + " points, " +
                std::to_string(header.points) + " expected");
  return cloud;
}

}  // namespace

Cloud readPcd(const std::filesystem::path& file) {
  const std::string bytes = readBytes(file);
  if (bytes.empty()) return {};
  const Header header = HeaderReader(file, bytes).read();
  const std::string_view data = std::string_view(bytes).substr(header.bytes);
  switch (header.data) {
    case Header::Data::ascii:
      return readAscii(header, data, file);
    case Header::Data::binary:
      return readBinary(header, data, file);
    default:
      return readCompressed(header, data, file);
  }
}

}  // namespace polemcl::io
