#pragma once
/// \file Cdr.h
/// \brief Common Data Representation (CDR), in which ROS 2 writes messages.

#include <cstdint>
#include <string>
#include <string_view>

#include "io/file/Bytes.h"

namespace polemcl::io {

/// \brief Reads the values of one message one after the other; never reads beyond its end.
///
/// A message starts with four bytes that state the byte order (0 0: big-endian, 0 1:
/// little-endian). Each number is aligned to its own size, counted from the byte after these four.
class CdrReader {
 public:
  /// \param message Must outlive the reader. \param where Prefix of error messages.
  /// \throws Error when it does not start with one of the two byte orders.
  CdrReader(std::string_view message, std::string where);

  /// \throws Error at the end of the message, as do the other functions.
  template <class T>
  T get() {
    align(sizeof(T));
    const char* bytes = take(sizeof(T)).data();
    return m_bigEndian ? loadBigEndian<T>(bytes) : loadLittleEndian<T>(bytes);
  }
  template <class T>
  T getFinite() {
    const T value = get<T>();
    requireFinite(static_cast<double>(value));
    return value;
  }
  /// \brief A text without the zero byte at its end.
  std::string getText();
  /// \brief A sequence of bytes.
  std::string_view getBytes();
  /// \brief Number of elements of a sequence.
  /// \param least Bytes that an element takes at least.
  /// \throws Error when the rest of the message cannot hold that number.
  std::size_t getCount(std::size_t least);
  /// \throws Error with the place of the message.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void align(std::size_t size);
  std::string_view take(std::size_t size);
  void requireFinite(double value) const;

  std::string_view m_content;  ///< without the first four bytes
  std::string m_where;
  std::size_t m_at = 0;  ///< next byte of the content
  bool m_bigEndian = false;
};

/// \brief Writes one message, little-endian.
class CdrEncoder {
 public:
  CdrEncoder();
  template <class T>
  void put(T value) {
    align(sizeof(T));
    m_message.put(value);
  }
  /// \brief A text; the zero byte at its end is added.
  void putText(std::string_view text);
  /// \brief Number of elements of a sequence.
  void putCount(std::size_t count);
  const std::string& message() const { return m_message.bytes(); }

 private:
  void align(std::size_t size);

  ByteWriter m_message;
};

}  // namespace polemcl::io
