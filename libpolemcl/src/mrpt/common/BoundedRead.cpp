#include "mrpt/common/BoundedRead.h"

#include <algorithm>

#include <polemcl/core/common/Types.h>

namespace polemcl {

using mrpt::serialization::CArchive;

namespace {

constexpr std::size_t kBlockBytes = 1 << 16;

void requireAtMost(std::uint32_t count, std::uint32_t most, const char* what) {
  if (count > most)
    throw Error(std::to_string(count) + " " + what + "; at most " + std::to_string(most) +
                " are allowed, the file is damaged");
}

/// Appends `count` elements, block by block.
template <class Container>
void append(CArchive& in, std::size_t count, const char* what, Container& to) {
  using Element = typename Container::value_type;
  while (count > 0) {
    const std::size_t block = std::min(count, kBlockBytes / sizeof(Element));
    const std::size_t begin = to.size();
    to.resize(begin + block);
    // Some MRPT streams return less than requested at their end.
    if (in.ReadBufferFixEndianness(&to[begin], block) != block * sizeof(Element))
      throw Error(std::string("the data ends inside its ") + what);
    count -= block;
  }
}

}  // namespace

std::uint32_t readCount(CArchive& in, std::uint32_t most, const char* what) {
  const auto count = in.ReadAs<std::uint32_t>();
  requireAtMost(count, most, what);
  return count;
}

std::string readText(CArchive& in, std::uint32_t most, const char* what) {
  const auto size = in.ReadAs<std::uint32_t>();
  requireAtMost(size, most, (std::string("bytes of ") + what).c_str());
  std::string text;
  append(in, size, what, text);
  return text;
}

std::vector<float> readFloats(CArchive& in, std::uint32_t most, const char* what) {
  const std::uint32_t count = readCount(in, most, what);
  std::vector<float> values;
  append(in, count, what, values);
  return values;
}

std::map<std::string, std::string> readTexts(CArchive& in, std::uint32_t most,
                                             std::uint32_t longest, const char* what) {
  constexpr std::uint32_t kLongestName = 64;
  for (const char* expected : {"std::map", "std::string", "std::string"}) {
    const std::string found = readText(in, kLongestName, what);
    if (found != expected)
      throw Error(std::string(what) + ": '" + found + "' where '" + expected + "' is expected");
  }
  std::map<std::string, std::string> texts;
  for (std::uint32_t left = readCount(in, most, what); left > 0; --left) {
    const std::string key = readText(in, longest, what);
    texts[key] = readText(in, longest, what);
  }
  return texts;
}

}  // namespace polemcl
