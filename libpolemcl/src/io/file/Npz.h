#pragma once
/// \file Npz.h
/// \brief Arrays of NumPy's `.npz` files.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace polemcl::io {

/// \brief First bytes of the records of a zip archive (APPNOTE.TXT 6.3,
/// sections 4.3.7, 4.3.12, 4.3.16).
namespace zip_records {
inline constexpr std::uint32_t localSignature = 0x04034b50, entrySignature = 0x02014b50,
                               endSignature = 0x06054b50;
}  // namespace zip_records

/// \brief A dense array of numbers. The values are in C order (last index fastest), in whatever
/// order the file stored them.
struct NumberArray {
  std::vector<std::size_t> shape;  ///< empty for a single number
  std::vector<double> values;
};

/// \brief Parses one `.npy` file: format 1 to 3, little-endian float32 or float64, C or Fortran
/// order.
/// \param where Prefix of error messages. \throws Error for any other content or a truncated file.
NumberArray parseNpy(std::string_view bytes, const std::string& where);

/// \brief The arrays of one `.npz` file (a zip archive of `.npy` files). Each is parsed on request.
class NpzFile {
 public:
  /// \throws Error when the file cannot be read, is not a zip archive, or is damaged.
  explicit NpzFile(const std::filesystem::path& file);
  /// \brief Names without `.npy`, sorted.
  std::vector<std::string> names() const;
  bool contains(const std::string& name) const { return m_members.count(name) != 0; }
  /// \throws Error when the array does not exist, is damaged (CRC-32), encrypted, compressed other
  ///         than by deflate, or not an array of floats.
  NumberArray array(const std::string& name) const;

 private:
  /// An entry in the directory of the archive.
  struct Member {
    std::uint32_t flags = 0, method = 0, crc = 0;
    std::uint64_t compressed = 0, size = 0,
                  header = 0;  ///< bytes, bytes, offset of the local header
  };
  std::string extract(const Member& member, const std::string& where) const;

  std::filesystem::path m_file;
  std::string m_bytes;
  std::map<std::string, Member> m_members;
};

/// \brief One array as `.npy`, float64, C order; parseNpy() reads it. \throws Error when the number
/// of values does not match the shape.
std::string npyBytes(const NumberArray& array);

/// \brief Writes named arrays uncompressed and atomically; equal arrays give equal bytes. NumPy's
/// `load` reads the file. \throws Error when it cannot be written, or would need more than 4 GB.
void writeNpz(const std::filesystem::path& file, const std::map<std::string, NumberArray>& arrays);

}  // namespace polemcl::io
