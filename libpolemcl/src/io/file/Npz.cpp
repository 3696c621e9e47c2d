#include "io/file/Npz.h"

#include <zlib.h>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"
#include "io/file/Inflate.h"

namespace polemcl::io {

namespace {

constexpr std::size_t localBytes = 30, entryBytes = 46, endBytes = 22, longestComment = 65535;
constexpr std::uint32_t encrypted = 1;
constexpr std::uint32_t stored = 0, deflate = 8;

std::uint64_t at16(std::string_view record, std::size_t offset) {
  return loadLittleEndian<std::uint16_t>(record.data() + offset);
}
std::uint64_t at32(std::string_view record, std::size_t offset) {
  return loadLittleEndian<std::uint32_t>(record.data() + offset);
}

/// A part of the archive. Throws if it does not lie inside.
std::string_view part(std::string_view bytes, std::uint64_t offset, std::uint64_t size,
                      const std::string& where) {
  if (offset > bytes.size() || size > bytes.size() - offset) {
    throw Error(where + "damaged: a part of the archive lies beyond its end");
  }
  return bytes.substr(offset, size);
}

/// The end record of the archive; it must reach exactly to the end of the file.
std::string_view findEnd(std::string_view bytes, const std::string& where) {
  for (std::size_t tail = endBytes; tail <= bytes.size() && tail <= endBytes + longestComment;
       ++tail) {
    const std::string_view record = bytes.substr(bytes.size() - tail);
    if (at32(record, 0) == zip_records::endSignature && at16(record, 20) == tail - endBytes)
      return record;
  }
  throw Error(where +
              "not a .npz file (zip archive), or cut short: it has no directory at its end");
}

}  // namespace

NpzFile::NpzFile(const std::filesystem::path& file) : m_file(file), m_bytes(readBytes(file)) {
  const std::string where = file.string() + ": ";
  const std::string_view end = findEnd(m_bytes, where);
  const std::uint64_t count = at16(end, 10), size = at32(end, 12), offset = at32(end, 16);
  if (count == 0xffff || size == 0xffffffff || offset == 0xffffffff) {
    throw Error(where + "zip archives of more than 4 GB are not read");
  }
  std::string_view directory = part(m_bytes, offset, size, where);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string_view entry = part(directory, 0, entryBytes, where);
    if (at32(entry, 0) != zip_records::entrySignature) {
      throw Error(where + "damaged: entry " + std::to_string(i) + " of its directory is invalid");
    }
    Member member;
    member.flags = static_cast<std::uint32_t>(at16(entry, 8));
    member.method = static_cast<std::uint32_t>(at16(entry, 10));
    member.crc = static_cast<std::uint32_t>(at32(entry, 16));
    member.compressed = at32(entry, 20);
    member.size = at32(entry, 24);
    member.header = at32(entry, 42);
    std::string name(part(directory, entryBytes, at16(entry, 28), where));
    const std::uint64_t whole = entryBytes + name.size() + at16(entry, 30) + at16(entry, 32);
    directory.remove_prefix(part(directory, 0, whole, where).size());
    if (name.size() > 4 && name.substr(name.size() - 4) == ".npy") name.resize(name.size() - 4);
    m_members[name] = member;
  }
  if (!directory.empty()) throw Error(where + "damaged: its directory is longer than its entries");
}

std::vector<std::string> NpzFile::names() const {
  std::vector<std::string> result;
  for (const auto& [name, member] : m_members) result.push_back(name);
  return result;
}

std::string NpzFile::extract(const Member& member, const std::string& where) const {
  if ((member.flags & encrypted) != 0) throw Error(where + "it is encrypted");
  if (member.method != stored && member.method != deflate) {
    throw Error(where + "compressed by method " + std::to_string(member.method) +
                "; stored (0) and deflated (8) are read");
  }
  const std::string_view header = part(m_bytes, member.header, localBytes, where);
  if (at32(header, 0) != zip_records::localSignature)
    throw Error(where + "damaged: its local header is invalid");
  const std::uint64_t begin = member.header + localBytes + at16(header, 26) + at16(header, 28);
  const std::string_view data = part(m_bytes, begin, member.compressed, where);
  if (member.method == stored && member.compressed != member.size) {
    throw Error(where + "damaged: stored uncompressed, but with two different sizes");
  }
  std::string content = member.method == stored
                            ? std::string(data)
                            : inflated(data, member.size, Deflated::bare, where);
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size());
  if (crc != member.crc) throw Error(where + "damaged: the checksum (CRC-32) is wrong");
  return content;
}

NumberArray NpzFile::array(const std::string& name) const {
  const auto found = m_members.find(name);
  if (found == m_members.end()) {
    throw Error(m_file.string() + ": no array " + name + " in it");
  }
  const std::string where = m_file.string() + ": array " + name + ": ";
  return parseNpy(extract(found->second, where), where);
}

}  // namespace polemcl::io
