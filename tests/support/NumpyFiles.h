#pragma once
/// \file NumpyFiles.h
/// \brief `.npy` and `.npz` bytes for the tests, written after their format documents.

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

/// A `.npy` file of version 1 or 2 with this dictionary, padded as in numpy.lib.format.
inline std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
  const std::size_t lengthBytes = version == 1 ? 2 : 4;
  std::string header = dictionary;
  while ((8 + lengthBytes + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  return std::string("\x93NUMPY") + static_cast<char>(version) + '\0' +
         little(header.size(), static_cast<int>(lengthBytes)) + header + data;
}

inline std::string dictionary(const std::string& type, const std::string& order,
                              const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
}

struct ZipMember {
  std::string name;  ///< with `.npy`
  std::string content;
  bool deflate = false;
};

inline std::string deflated(const std::string& content) {
  std::string result(compressBound(content.size()) + 16, '\0');
  z_stream stream = {};
  deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

/// A zip archive as NumPy writes it: the local headers have an extra field (zip64 sizes).
inline std::string zip(const std::vector<ZipMember>& members, const std::string& comment = "") {
  std::string archive, directory;
  for (const ZipMember& member : members) {
    const std::string data = member.deflate ? deflated(member.content) : member.content;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(member.content.data()),
                           static_cast<uInt>(member.content.size()));
    const std::string method = little(member.deflate ? 8 : 0, 2);
    const std::string extra =
        little(1, 2) + little(16, 2) + little(member.content.size(), 8) + little(data.size(), 8);
    const std::string common = method + little(0, 4) + little(crc, 4);
    const std::size_t offset = archive.size();
    archive += "PK\x03\x04" + little(45, 2) + little(0, 2) + common + little(0xffffffff, 4) +
               little(0xffffffff, 4) + little(member.name.size(), 2) + little(extra.size(), 2) +
               member.name + extra + data;
    directory += "PK\x01\x02" + little(45, 2) + little(45, 2) + little(0, 2) + common +
                 little(data.size(), 4) + little(member.content.size(), 4) +
                 little(member.name.size(), 2) + little(0, 2 + 2 + 2 + 2 + 4) + little(offset, 4) +
                 member.name;
  }
  const std::size_t offset = archive.size();
  return archive + directory + "PK\x05\x06" + little(0, 4) + little(members.size(), 2) +
         little(members.size(), 2) + little(directory.size(), 4) + little(offset, 4) +
         little(comment.size(), 2) + comment;
}

}  // namespace polemcl::io::test
