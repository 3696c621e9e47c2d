#include "io/file/WholeFile.h"

#include <fstream>
#include <iterator>

#include <polemcl/core/common/Types.h>
#include "io/file/AtomicFile.h"

namespace polemcl::io {
namespace {

bool continues(std::string_view text, std::size_t at) {
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
}

}  // namespace

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw Error(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeContent(const std::filesystem::path& file, std::string_view content) {
  AtomicFile output(file);
  output.stream() << content;
  output.commit();
}

std::size_t characterLength(std::string_view text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4 || !continues(text, at + 1)) return 0;
  if (first < 0xE0) return 2;
  const auto second = static_cast<unsigned char>(text[at + 1]);
  if (first < 0xF0) {
    // Neither too long a form nor half of a pair (UTF-16).
    const bool allowed = (first != 0xE0 || second >= 0xA0) && (first != 0xED || second < 0xA0);
    return allowed && continues(text, at + 2) ? 3 : 0;
  }
  const bool allowed = (first != 0xF0 || second >= 0x90) && (first != 0xF4 || second < 0x90);
  return allowed && continues(text, at + 2) && continues(text, at + 3) ? 4 : 0;
}

}  // namespace polemcl::io
