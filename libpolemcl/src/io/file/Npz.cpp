#include "io/file/Npz.h"

#include <zlib.h>

#include <charconv>
#include <limits>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace {

// Records of a zip archive (APPNOTE.TXT 6.3, sections 4.3.7, 4.3.12, 4.3.16): first bytes, sizes.
constexpr std::uint32_t kLocalSignature = 0x04034b50, kEntrySignature = 0x02014b50,
                        kEndSignature = 0x06054b50;
constexpr std::size_t kLocalBytes = 30, kEntryBytes = 46, kEndBytes = 22, kLongestComment = 65535;

constexpr std::string_view kNpyStart("\x93NUMPY\x01\x00", 8);  ///< name and version
constexpr std::string_view kLayout = "{'descr': '<f8', 'fortran_order': False, 'shape': (";

std::uint64_t at16(std::string_view record, std::size_t offset) {
  return loadLittleEndian<std::uint16_t>(record.data() + offset);
}
std::uint64_t at32(std::string_view record, std::size_t offset) {
  return loadLittleEndian<std::uint32_t>(record.data() + offset);
}

/// A part of the archive. Throws if it does not lie inside.
std::string_view part(std::string_view bytes, std::uint64_t offset, std::uint64_t size,
                      const std::string& where) {
  if (offset > bytes.size() || size > bytes.size() - offset)
    throw Error(where + "damaged: a part of the archive lies beyond its end");
  return bytes.substr(offset, size);
}

/// The end record of the archive; it must reach exactly to the end of the file.
std::string_view findEnd(std::string_view bytes, const std::string& where) {
  for (std::size_t tail = kEndBytes; tail <= bytes.size() && tail <= kEndBytes + kLongestComment;
       ++tail) {
    const std::string_view record = bytes.substr(bytes.size() - tail);
    if (at32(record, 0) == kEndSignature && at16(record, 20) == tail - kEndBytes) return record;
  }
  throw Error(where +
              "not a .npz file (zip archive), or cut short: it has no directory at its end");
}

/// The numbers before the bracket that closes the shape.
std::vector<std::size_t> parseShape(std::string_view text, const std::string& where) {
  const Error error(where + "damaged: the .npy header has no valid shape");
  const auto close = text.find(')');
  if (close == std::string_view::npos) throw error;
  text = text.substr(0, close);
  std::vector<std::size_t> shape;
  while (!trimmed(text).empty()) {
    const auto comma = text.find(',');
    const std::string_view word = trimmed(text.substr(0, comma));
    std::size_t size = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), size);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size()) throw error;
    shape.push_back(size);
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return shape;
}

/// Number of elements; throws unless they fill the data exactly.
std::size_t countElements(const std::vector<std::size_t>& shape, std::size_t bytes,
                          const std::string& where) {
  std::size_t count = 1;
  bool fits = bytes % sizeof(double) == 0;
  for (const std::size_t size : shape) {
    fits = fits && (size == 0 || count <= std::numeric_limits<std::size_t>::max() / size);
    count *= size;
  }
  if (!fits || count != bytes / sizeof(double))
    throw Error(where + "cut short or damaged: " + std::to_string(bytes) +
                " bytes of data do not fit its shape");
  return count;
}

NumberArray parseNpy(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where + "cut short: ");
  if (reader.getRaw(kNpyStart.size()) != kNpyStart)
    throw Error(where + "not .npy data of version 1.0");
  const std::string_view header = reader.getRaw(reader.get<std::uint16_t>());
  if (header.substr(0, kLayout.size()) != kLayout)
    throw Error(where +
                "not an array of float64 in C order, which alone is read; convert it in "
                "Python: numpy.savez(file, name=numpy.array(values, float))");
  NumberArray array{parseShape(header.substr(kLayout.size()), where), {}};
  const std::string_view data = reader.getRaw(reader.remaining());
  array.values.resize(countElements(array.shape, data.size(), where));
  for (std::size_t i = 0; i < array.values.size(); ++i)
    array.values[i] = loadLittleEndian<double>(data.data() + sizeof(double) * i);
  return array;
}

}  // namespace

NpzFile::NpzFile(const std::filesystem::path& file) : m_file(file), m_bytes(readBytes(file)) {
  const std::string where = file.string() + ": ";
  const std::string_view end = findEnd(m_bytes, where);
  const std::uint64_t count = at16(end, 10), size = at32(end, 12), offset = at32(end, 16);
  if (count == 0xffff || size == 0xffffffff || offset == 0xffffffff)
    throw Error(where + "zip archives of more than 4 GB are not read");
  std::string_view directory = part(m_bytes, offset, size, where);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string_view entry = part(directory, 0, kEntryBytes, where);
    if (at32(entry, 0) != kEntrySignature)
      throw Error(where + "damaged: entry " + std::to_string(i) + " of its directory is invalid");
    std::string name(part(directory, kEntryBytes, at16(entry, 28), where));
    const std::uint64_t whole = kEntryBytes + name.size() + at16(entry, 30) + at16(entry, 32);
    directory.remove_prefix(part(directory, 0, whole, where).size());
    if (name.size() > 4 && name.substr(name.size() - 4) == ".npy") name.resize(name.size() - 4);
    m_members[name] = {at16(entry, 10), at32(entry, 16), at32(entry, 24), at32(entry, 42)};
  }
  if (!directory.empty()) throw Error(where + "damaged: its directory is longer than its entries");
}

std::vector<std::string> NpzFile::names() const {
  std::vector<std::string> result;
  for (const auto& [name, member] : m_members) result.push_back(name);
  return result;
}

std::string_view NpzFile::content(const Member& member, const std::string& where) const {
  if (member.method != 0)
    throw Error(where + "compressed; only what numpy.savez writes is read, not savez_compressed");
  const std::string_view header = part(m_bytes, member.header, kLocalBytes, where);
  if (at32(header, 0) != kLocalSignature)
    throw Error(where + "damaged: its local header is invalid");
  const std::uint64_t begin = member.header + kLocalBytes + at16(header, 26) + at16(header, 28);
  const std::string_view data = part(m_bytes, begin, member.size, where);
  if (crc32_z(0, reinterpret_cast<const Bytef*>(data.data()), data.size()) != member.crc)
    throw Error(where + "damaged: the checksum (CRC-32) is wrong");
  return data;
}

NumberArray NpzFile::array(const std::string& name) const {
  const auto found = m_members.find(name);
  if (found == m_members.end()) throw Error(m_file.string() + ": no array " + name + " in it");
  const std::string where = m_file.string() + ": array " + name + ": ";
  return parseNpy(content(found->second, where), where);
}

}  // namespace polemcl::io
