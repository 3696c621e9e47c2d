#include "io/file/Bytes.h"

#include <cerrno>
#include <cstdio>
#include <memory>

#include <polemcl/core/common/Types.h>
#include "io/file/InputFile.h"
#include "io/file/ReadLimits.h"

namespace polemcl::io {

std::string readBytes(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& why) {
    return Error("cannot read " + file.string() + ": " + why);
  };
  if (const char* why = whyNoInput(file)) throw fail(why);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               &std::fclose);
  if (!stream) throw fail(std::strerror(errno));
  std::error_code isPipe;
  const auto size = std::filesystem::file_size(file, isPipe);
  std::string bytes;
  // One byte more than the file size, so that the first read reaches the end.
  bytes.resize(isPipe ? 65536 : size + 1);
  std::size_t used = 0;
  while (true) {
    used += std::fread(bytes.data() + used, 1, bytes.size() - used, stream.get());
    if (isPipe && used > kMostPipedBytes)
      throw fail("the pipe gives more than " + std::to_string(kMostPipedBytes >> 20) +
                 " MB; write it to a file");
    if (used < bytes.size()) break;
    bytes.resize(2 * bytes.size());
  }
  if (std::ferror(stream.get())) throw fail(std::strerror(errno));
  bytes.resize(used);
  return bytes;
}

void ByteWriter::putText(std::string_view text) {
  put(static_cast<std::uint32_t>(text.size()));
  putRaw(text);
}

std::string_view ByteReader::getRaw(std::uint64_t size) {
  if (size > m_bytes.size()) {
    throw Error(m_where + "ends in mid-value: " + std::to_string(size) + " bytes expected, " +
                std::to_string(m_bytes.size()) + " left");
  }
  const std::string_view result = m_bytes.substr(0, size);
  m_bytes.remove_prefix(size);
  return result;
}

std::string_view ByteReader::getText() {
  return getRaw(get<std::uint32_t>());
}

}  // namespace polemcl::io
