#include <zlib.h>

#include <polemcl/core/common/Types.h>
#include "io/file/AtomicFile.h"
#include "io/file/Bytes.h"
#include "io/file/Npz.h"

namespace polemcl::io {
namespace {

constexpr std::uint16_t zipVersion = 20;
constexpr std::uint16_t firstDay = 1 << 5 | 1;  ///< 1980-01-01, as NumPy writes it; no clock
constexpr std::uint64_t mostBytes = 0xffffffff;

void put16(std::string& bytes, std::uint64_t value) {
  for (int shift : {0, 8}) bytes += static_cast<char>(value >> shift & 0xff);
}
void put32(std::string& bytes, std::uint64_t value) {
  for (int shift : {0, 8, 16, 24}) bytes += static_cast<char>(value >> shift & 0xff);
}

/// The common part of local header and directory entry: from the version to the name's length.
std::string description(const std::string& name, const std::string& content) {
  std::string bytes;
  put16(bytes, zipVersion);
  put16(bytes, 0);  // flags
  put16(bytes, 0);  // stored
  put16(bytes, 0);  // midnight
  put16(bytes, firstDay);
  put32(bytes, crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()));
  put32(bytes, content.size());
  put32(bytes, content.size());
  put16(bytes, name.size());
  put16(bytes, 0);  // extra field
  return bytes;
}

std::string localHeader(const std::string& name, const std::string& content) {
  std::string bytes;
  put32(bytes, zip_records::localSignature);
  return bytes + description(name, content) + name;
}

std::string directoryEntry(const std::string& name, const std::string& content,
                           std::uint64_t offset) {
  std::string bytes;
  put32(bytes, zip_records::entrySignature);
  put16(bytes, zipVersion);  // made by
  bytes += description(name, content);
  put16(bytes, 0);  // comment
  put16(bytes, 0);  // disk
  put16(bytes, 0);  // attributes
  put32(bytes, 0);
  put32(bytes, offset);
  return bytes + name;
}

}  // namespace

std::string npyBytes(const NumberArray& array) {
  std::size_t count = 1;
  std::string shape;
  for (const std::size_t size : array.shape) {
    count *= size;
    shape += std::to_string(size) + ", ";
  }
  if (array.shape.size() > 1) shape.resize(shape.size() - 2);
  if (count != array.values.size())
    throw Error("an array of " + std::to_string(array.values.size()) + " values cannot have " +
                std::to_string(count));
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }";
  constexpr std::size_t before = 10, step = 64;  // magic, version and length; NumPy's alignment
  header.append(step - (before + header.size() + 1) % step, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\0", 8);
  put16(bytes, header.size());
  ByteWriter values;
  for (const double value : array.values) values.put(value);
  return bytes + header + values.bytes();
}

void writeNpz(const std::filesystem::path& file, const std::map<std::string, NumberArray>& arrays) {
  std::string archive, directory;
  for (const auto& [array, numbers] : arrays) {
    const std::string name = array + ".npy", content = npyBytes(numbers);
    directory += directoryEntry(name, content, archive.size());
    archive += localHeader(name, content) + content;
    if (archive.size() + directory.size() > mostBytes)
      throw Error("cannot write " + file.string() + ": more than 4 GB");
  }
  std::string end;
  put32(end, zip_records::endSignature);
  put32(end, 0);  // disks
  put16(end, arrays.size());
  put16(end, arrays.size());
  put32(end, directory.size());
  put32(end, archive.size());
  put16(end, 0);  // comment
  writeFile(file, archive + directory + end);
}

}  // namespace polemcl::io
