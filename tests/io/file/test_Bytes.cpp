#include <sys/stat.h>

#include <cstdio>

#include "io/file/Bytes.h"
#include "io/file/TextFile.h"
#include "support/IoFiles.h"

namespace polemcl::test_bytes {

using namespace polemcl::io;
using namespace polemcl::io::test;

using BytesTest = FolderTest;

TEST_F(BytesTest, LoadsLittleEndianByHand) {
  EXPECT_EQ(loadLittleEndian<std::uint16_t>("\x02\x01"), 0x0102);
  EXPECT_EQ(loadLittleEndian<std::uint32_t>("\x04\x03\x02\xf1"), 0xf1020304u);
  EXPECT_EQ(loadLittleEndian<std::uint64_t>("\x08\x07\x06\x05\x04\x03\x02\x81"),
            0x8102030405060708u);
  // IEEE 754: 1.5 is 3fc00000 and 3ff8000000000000.
  EXPECT_EQ(loadLittleEndian<float>(std::string("\0\0\xc0\x3f", 4).data()), 1.5f);
  EXPECT_EQ(loadLittleEndian<double>(std::string("\0\0\0\0\0\0\xf8\xbf", 8).data()), -1.5);
}

TEST_F(BytesTest, WritesLittleEndianByHand) {
  ByteWriter writer;
  writer.put(std::uint32_t{0x01020304});
  writer.put(1.5);
  writer.putText("ab");
  EXPECT_EQ(writer.bytes(), std::string("\x04\x03\x02\x01\0\0\0\0\0\0\xf8\x3f\x02\0\0\0ab", 18));
}

TEST_F(BytesTest, ReadsInOrderAndCountsWhatIsLeft) {
  ByteWriter writer;
  writer.put(std::uint64_t{7});
  writer.putText("pole");
  ByteReader reader(writer.bytes(), "");
  EXPECT_EQ(reader.get<std::uint64_t>(), 7u);
  EXPECT_EQ(reader.remaining(), 8u);
  EXPECT_EQ(reader.getText(), "pole");
  EXPECT_EQ(reader.remaining(), 0u);
}

TEST_F(BytesTest, RefusesToReadBeyondTheEnd) {
  ByteReader reader("abc", "file: ");
  EXPECT_REFUSED(reader.get<std::uint32_t>(), "file: ", "4 bytes expected", "3 left");
}

TEST_F(BytesTest, RefusesATextLongerThanWhatIsLeft) {
  ByteWriter writer;
  writer.put(std::uint32_t{0xffffffff});
  writer.putRaw("abc");
  ByteReader reader(writer.bytes(), "");
  EXPECT_REFUSED(reader.getText(), "4294967295");
}

TEST_F(BytesTest, ReadsWholeFiles) {
  const std::string content("\0a\r\n\xff", 5);
  EXPECT_EQ(readBytes(write("f", content)), content);
  EXPECT_EQ(readBytes(write("empty", "")), "");
  // Files that do not state their size.
  EXPECT_HAS(readBytes("/proc/self/status"), "Name:");
}

TEST_F(BytesTest, RefusesBadInput) {
  EXPECT_REFUSED(readBytes(path("no")), path("no").string(), "No such file or directory");
  EXPECT_REFUSED(readBytes(path(std::string(300, 'x'))), "File name too long");
  EXPECT_REFUSED(readBytes(m_folder), "folder");
  EXPECT_REFUSED(readBytes("/dev/zero"), "/dev/zero: it is a device or a named pipe");
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);  // without a writer
  EXPECT_REFUSED(readBytes(path("pipe")), "pipe: it is a device or a named pipe");
}

/// What a command gives, as a shell hands it over: /dev/fd/63.
class Given {
 public:
  explicit Given(const std::string& command) : m_pipe(::popen(command.c_str(), "r")) {}
  ~Given() { ::pclose(m_pipe); }
  Given(const Given&) = delete;
  Given& operator=(const Given&) = delete;
  std::string path() const { return "/dev/fd/" + std::to_string(::fileno(m_pipe)); }

 private:
  std::FILE* m_pipe;
};

TEST_F(BytesTest, ReadsThePipesOfAShell) {
  EXPECT_EQ(readBytes(Given("seq 3").path()), "1\n2\n3\n");
  EXPECT_EQ(readBytes(Given("seq 100000").path()).size(), 588895u);
  EXPECT_EQ(readLines(Given("seq 3").path()), (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_REFUSED(readBytes(Given("head -c 257M /dev/zero").path()), "more than 256 MB");
}

}  // namespace polemcl::test_bytes
