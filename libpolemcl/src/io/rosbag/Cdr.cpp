#include "io/rosbag/Cdr.h"

#include <cmath>
#include <utility>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {
namespace {

constexpr std::size_t kEncapsulationBytes = 4;
/// First bytes of data compressed by zstd.
constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";

}  // namespace

CdrReader::CdrReader(std::string_view message, std::string where) : m_where(std::move(where)) {
  if (message.substr(0, kZstdMagic.size()) == kZstdMagic)
    fail("the message is compressed (zstd); write the bag uncompressed with ros2 bag convert");
  if (message.size() < kEncapsulationBytes)
    fail("cut short: " + std::to_string(message.size()) + " bytes, at least 4 expected");
  if (message[0] != 0 || (message[1] != 0 && message[1] != 1))
    fail("not CDR: it begins with the bytes " +
         std::to_string(static_cast<unsigned char>(message[0])) + " " +
         std::to_string(static_cast<unsigned char>(message[1])) +
         "; 0 0 (big-endian) and 0 1 (little-endian) are allowed");
  m_bigEndian = message[1] == 0;
  m_content = message.substr(kEncapsulationBytes);
}

std::string CdrReader::getText() {
  std::string_view text = getBytes();
  if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  return std::string(text);
}

std::string_view CdrReader::getBytes() {
  return take(get<std::uint32_t>());
}

std::size_t CdrReader::getCount(std::size_t least) {
  const std::size_t count = get<std::uint32_t>(), left = m_content.size() - m_at;
  if (count > left / least)
    fail("cut short: " + std::to_string(count) + " elements of at least " + std::to_string(least) +
         " bytes expected, " + std::to_string(left) + " bytes left");
  return count;
}

void CdrReader::fail(const std::string& what) const {
  throw Error(m_where + what);
}

void CdrReader::align(std::size_t size) {
  const std::size_t over = m_at % size;
  if (over > 0) take(size - over);
}

std::string_view CdrReader::take(std::size_t size) {
  const std::size_t left = m_content.size() - m_at;
  if (size > left)
    fail("cut short: " + std::to_string(size) + " bytes expected, " + std::to_string(left) +
         " left");
  const std::string_view bytes = m_content.substr(m_at, size);
  m_at += size;
  return bytes;
}

void CdrReader::requireFinite(double value) const {
  if (!std::isfinite(value)) fail("it holds a number that is not finite");
}

CdrEncoder::CdrEncoder() {
  m_message.putRaw(std::string_view("\0\1\0\0", kEncapsulationBytes));
}

void CdrEncoder::putText(std::string_view text) {
  putCount(text.size() + 1);
  m_message.putRaw(text);
  m_message.put(char{0});
}

void CdrEncoder::putCount(std::size_t count) {
  put(static_cast<std::uint32_t>(count));
}

void CdrEncoder::align(std::size_t size) {
  while ((m_message.bytes().size() - kEncapsulationBytes) % size > 0) m_message.put(char{0});
}

}  // namespace polemcl::io
