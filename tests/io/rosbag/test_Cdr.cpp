#include <functional>

#include "io/rosbag/Cdr.h"
#include "support/IoFiles.h"

namespace polemcl::test_cdr {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace std::string_literals;

std::string refusal(
    const std::string& message,
    const std::function<void(CdrReader&)>& reading = [](CdrReader&) {}) {
  return messageOf([&] {
    CdrReader reader(message, "a.db3: /t, message 1: ");
    reading(reader);
  });
}

TEST(Cdr, AlignsFromTheByteAfterTheHeader) {
  // uint8 5, uint32 at 4, text "ab" at 8, uint16 at 16 (after 4 + 3 bytes of text), double at 24.
  const std::string little =
      "\0\1\0\0"
      "\5\0\0\0\1\2\0\0\3\0\0\0ab\0\0\7\0\0\0\0\0\0\0\0\0\0\0\0\0\xf8\x3f"s;
  const std::string big =
      "\0\0\0\0"
      "\5\0\0\0\0\0\2\1\0\0\0\3ab\0\0\0\7\0\0\0\0\0\0\x3f\xf8\0\0\0\0\0\0"s;
  for (const std::string& message : {little, big}) {
    CdrReader reader(message, "");
    EXPECT_EQ(reader.get<std::uint8_t>(), 5);
    EXPECT_EQ(reader.get<std::uint32_t>(), 513u);
    EXPECT_EQ(reader.getText(), "ab");
    EXPECT_EQ(reader.get<std::uint16_t>(), 7);
    EXPECT_EQ(reader.get<double>(), 1.5);
    EXPECT_THROW(reader.get<std::uint8_t>(), Error);
  }
}

TEST(Cdr, RefusesOtherFormats) {
  expectIn(refusal("\0\1"s), "a.db3: /t, message 1: cut short: 2 bytes");
  expectIn(refusal("\0\3\0\0abc"s), "not CDR: it begins with the bytes 0 3; 0 0 (big-endian)");
  expectIn(refusal("\x28\xb5\x2f\xfd\4\0"s), "compressed (zstd)", "ros2 bag convert");
}

TEST(Cdr, ForgedSizesAreRefusedBeforeAnythingIsRead) {
  const auto text = [](CdrReader& reader) { reader.getText(); };
  expectIn(refusal("\0\1\0\0\xff\xff\xff\xff"
                   "ab"s,
                   text),
           "cut short: 4294967295 bytes expected, 2 left");
  const auto count = [](CdrReader& reader) { reader.getCount(13); };
  expectIn(refusal("\0\1\0\0\2\0\0\0abcdefghijklmnopqrstuvwxy"s, count),
           "cut short: 2 elements of at least 13 bytes expected, 25 bytes left");
  const auto number = [](CdrReader& reader) { reader.get<double>(); };
  expectIn(refusal("\0\1\0\0\2\0\0\0"s, number), "cut short: 8 bytes expected, 4 left");
}

}  // namespace
}  // namespace polemcl::test_cdr
