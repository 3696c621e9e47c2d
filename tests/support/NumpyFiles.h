#pragma once
// `.npy` and `.npz` bytes for the tests, written after their format documents.

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace polemcl::io::test {

inline std::string little(std::uint64_t value, int bytes) {
  std::string result;
  for (int i = 0; i < bytes; ++i, value >>= 8) result += static_cast<char>(value & 0xff);
  return result;
}

/// A `.npy` file of version 1 with this dictionary, padded as in numpy.lib.format.
inline std::string npy(const std::string& dictionary, const std::string& data) {
  std::string header = dictionary;
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  return std::string("\x93NUMPY\x01\0", 8) + little(header.size(), 2) + header + data;
}

inline std::string dictionary(const std::string& type, const std::string& order,
                              const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
}

struct ZipMember {
  std::string name;  ///< with `.npy`
  std::string content;
};

/// A zip archive as NumPy writes it: the local headers have an extra field (zip64 sizes).
inline std::string zip(const std::vector<ZipMember>& members, const std::string& comment = "") {
  std::string archive, directory;
  for (const ZipMember& member : members) {
    const std::string& data = member.content;
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
    const std::string extra =
        little(1, 2) + little(16, 2) + little(data.size(), 8) + little(data.size(), 8);
    const std::string common = little(0, 2 + 4) + little(crc, 4);  // stored, no time
    const std::size_t offset = archive.size();
    archive += "PK\x03\x04" + little(45, 2) + little(0, 2) + common + little(0xffffffff, 4) +
               little(0xffffffff, 4) + little(member.name.size(), 2) + little(extra.size(), 2) +
               member.name + extra + data;
    directory += "PK\x01\x02" + little(45, 2) + little(45, 2) + little(0, 2) + common +
                 little(data.size(), 4) + little(data.size(), 4) + little(member.name.size(), 2) +
                 little(0, 2 + 2 + 2 + 2 + 4) + little(offset, 4) + member.name;
  }
  const std::size_t offset = archive.size();
  return archive + directory + "PK\x05\x06" + little(0, 4) + little(members.size(), 2) +
         little(members.size(), 2) + little(directory.size(), 4) + little(offset, 4) +
         little(comment.size(), 2) + comment;
}

}  // namespace polemcl::io::test
