#pragma once
/// \file Npz.h
/// \brief Arrays in the files of `numpy.savez`: float64, C order, not compressed.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace polemcl::io {

/// \brief A dense array of numbers, last index fastest.
struct NumberArray {
  std::vector<std::size_t> shape;  ///< empty for a single number
  std::vector<double> values;
};

/// \brief The arrays of one `.npz` file (a zip archive of `.npy` files). Each is parsed on request.
class NpzFile {
 public:
  /// \throws Error when the file cannot be read, is not a zip archive, or is damaged.
  explicit NpzFile(const std::filesystem::path& file);
  /// \brief Names without `.npy`, sorted.
  std::vector<std::string> names() const;
  bool contains(const std::string& name) const { return m_members.count(name) != 0; }
  /// \throws Error when the array does not exist, is damaged (CRC-32), or is not what
  ///         `numpy.savez` makes of an array of float64 in C order.
  NumberArray array(const std::string& name) const;

 private:
  /// An entry in the directory of the archive.
  struct Member {
    std::uint64_t method = 0, crc = 0, size = 0;  ///< size: bytes
    std::uint64_t header = 0;                     ///< offset of the local header, bytes
  };
  std::string_view content(const Member& member, const std::string& where) const;

  std::filesystem::path m_file;
  std::string m_bytes;
  std::map<std::string, Member> m_members;
};

}  // namespace polemcl::io
