#pragma once
/// \file Bytes.h
/// \brief Whole files as bytes, and the numbers in them, on any machine.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace polemcl::io {

/// \brief Reads a whole file. \throws Error with the system's reason when the file cannot be read;
/// for what is no input (InputFile.h), and a pipe that gives more than allowed (ReadLimits.h).
std::string readBytes(const std::filesystem::path& file);

/// \brief The unsigned integer of the size of T.
template <class T>
using BitsOf = std::conditional_t<
    sizeof(T) == 8, std::uint64_t,
    std::conditional_t<sizeof(T) == 4, std::uint32_t,
                       std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;

/// \brief The little-endian value of type T (integer or float) at `bytes`; no alignment needed.
template <class T>
T loadLittleEndian(const char* bytes) {
  BitsOf<T> bits = 0;
  static_assert(sizeof(T) == sizeof(bits));
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const auto byte = static_cast<BitsOf<T>>(static_cast<unsigned char>(bytes[i]));
    bits |= static_cast<BitsOf<T>>(byte << (8 * i));
  }
  T value;
  std::memcpy(&value, &bits, sizeof(T));
  return value;
}

/// \brief The same, big-endian.
template <class T>
T loadBigEndian(const char* bytes) {
  char reversed[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i) reversed[i] = bytes[sizeof(T) - 1 - i];
  return loadLittleEndian<T>(reversed);
}

/// \brief Appends values, little-endian, to a string of bytes.
class ByteWriter {
 public:
  template <class T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    BitsOf<T> bits;
    std::memcpy(&bits, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      m_bytes.push_back(static_cast<char>(bits >> (8 * i) & 0xff));
    }
  }
  void putRaw(std::string_view bytes) { m_bytes.append(bytes); }
  /// \brief Writes a uint32 length, then the bytes.
  void putText(std::string_view text);
  const std::string& bytes() const { return m_bytes; }

 private:
  std::string m_bytes;
};

/// \brief Reads little-endian values one after the other; never reads beyond the end.
class ByteReader {
 public:
  /// \param bytes Must outlive the reader. \param where Prefix of error messages.
  ByteReader(std::string_view bytes, std::string where)
      : m_bytes(bytes), m_where(std::move(where)) {}
  /// \throws Error at the end of the bytes, as do the other functions.
  template <class T>
  T get() {
    return loadLittleEndian<T>(getRaw(sizeof(T)).data());
  }
  std::string_view getRaw(std::uint64_t size);
  std::string_view getText();
  std::size_t remaining() const { return m_bytes.size(); }

 private:
  std::string_view m_bytes;  ///< bytes not yet read
  std::string m_where;
};

}  // namespace polemcl::io
