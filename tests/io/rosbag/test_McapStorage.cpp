#include "io/rosbag/Bag.h"
#include "support/IoFiles.h"
#include "support/McapFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_mcap_storage {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

const std::string about = mcapSchema(1, "T") + mcapChannel(7, 1, "/points");
const std::string first = mcapMessage(7, 10, "first"), second = mcapMessage(7, 20, "second"),
                  third = mcapMessage(7, 30, "third");

class McapTest : public FolderTest {
 protected:
  std::vector<std::string> contents(const std::string& file, std::size_t topic = 0) const {
    const Bag bag(path(file));
    std::vector<std::string> result;
    for (const auto& message : bag.messages(topic)) result.push_back(bag.read(message));
    return result;
  }
  std::vector<std::string> contentsOf(const std::string& bytes) const {
    write("a.mcap", bytes);
    return contents("a.mcap");
  }
  std::string refusalOf(const std::string& bytes) const {
    write("a.mcap", bytes);
    return messageOf([&] { contents("a.mcap"); });
  }
  std::string noteOf(const std::string& bytes) const {
    write("a.mcap", bytes);
    const auto notes = Bag(path("a.mcap")).notes();
    return notes.empty() ? "" : notes.front();
  }
};

const std::vector<std::string> all{"first", "second", "third"};

TEST_F(McapTest, ReadsMessagesWithoutChunksInTheOrderOfRecording) {
  EXPECT_EQ(contentsOf(mcapFile(about + third + first + second)), all);
  const Bag bag(path("a.mcap"));
  ASSERT_EQ(bag.topics().size(), 1u);
  EXPECT_EQ(bag.topics()[0].name, "/points");
  EXPECT_EQ(bag.topics()[0].type, "T");
  EXPECT_EQ(bag.topics()[0].messages, 3u);
  const BagMessage earliest = bag.messages(0).front();
  EXPECT_EQ(bag.read(earliest, 3), "fir");
  EXPECT_EQ(bag.place(earliest), path("a.mcap").string() + ": /points, message 2: ");
  EXPECT_REFUSED(bag.read(bag.message(0, path("a.mcap"), 9)), "message 9: there is no such");
  EXPECT_TRUE(bag.notes().empty());
}

TEST_F(McapTest, ReadsChunksWithoutIndex) {
  for (const char* compression : {"", "lz4", "zstd"})
    EXPECT_EQ(contentsOf(mcapFile(mcapChunk(about + first + third, compression) +
                                  mcapChunk(second, compression))),
              all)
        << compression;
}

TEST_F(McapTest, ReadsContentLongerThanTheFirstBlock) {
  const std::string data(300000, 'n'), message = mcapMessage(7, 1, data);
  for (const char* compression : {"lz4", "zstd"})
    EXPECT_EQ(contentsOf(mcapFile(mcapChunk(about + message, compression))),
              std::vector<std::string>{data});
}

TEST_F(McapTest, OpensIndexedChunksWithoutDecompressingThem) {
  const std::string index = mcapIndex(7, {{10, 0}, {20, first.size()}});
  EXPECT_EQ(contentsOf(mcapFile(mcapChunk(first + second, "zstd") + index, about)),
            (std::vector<std::string>{"first", "second"}));
  // The chunk is damaged: only reading a message shows it.
  write("b.mcap", mcapFile(mcapRawChunk("damaged", "zstd", 100, 0) + index, about));
  const Bag bag(path("b.mcap"));
  EXPECT_EQ(bag.topics()[0].messages, 2u);
  EXPECT_REFUSED(bag.read(bag.messages(0).front()), "chunk at byte", "cannot be decompressed");
}

TEST_F(McapTest, DecompressesAnIndexedChunkForItsChannels) {
  const std::string index = mcapIndex(7, {{10, about.size()}});
  EXPECT_EQ(contentsOf(mcapFile(mcapChunk(about + first, "lz4") + index)),
            std::vector<std::string>{"first"});
}

TEST_F(McapTest, ReadsWhatIsWholeOfARecordingThatWasCutShort) {
  const std::string data = about + first + second, whole = mcapBegin(data);
  EXPECT_EQ(contentsOf(whole.substr(0, whole.size() - 1)), std::vector<std::string>{"first"});
  EXPECT_HAS(noteOf(whole.substr(0, whole.size() - 1)), "cut short; 1 messages before it are read");
  EXPECT_EQ(contentsOf(whole + std::string(4096, '\0')).size(), 2u);
  // The recorder was killed after it wrote the index of another channel.
  const std::string chunk =
      mcapChunk(about + mcapChannel(8, 1, "/other") + first + mcapMessage(8, 1, "other"), "zstd");
  const std::string half = mcapIndex(8, {{1, about.size() + 1}});
  write("c.mcap", mcapBegin(chunk + half));
  EXPECT_EQ(contents("c.mcap", 1), std::vector<std::string>{"first"});
}

TEST_F(McapTest, RefusesWhatIsNoMcap) {
  expectIn(refusalOf(""), "a.mcap: cannot be read as a ROS 2 bag: it does not begin as MCAP");
  expectIn(refusalOf(std::string(100, 'x')), "does not begin as MCAP");
}

TEST_F(McapTest, RefusesWrongChecksums) {
  const std::string records = about + first;
  expectIn(refusalOf(mcapFile(mcapRawChunk(records, "", records.size(), 77))), "chunk at byte",
           "its checksum is wrong");
  EXPECT_EQ(contentsOf(mcapFile(mcapRawChunk(records, "", records.size(), 0))).size(), 1u);
  expectIn(refusalOf(mcapFile(first, about, 1)), "summary damaged: its checksum is wrong");
}

TEST_F(McapTest, RefusesRecordsThatDoNotFit) {
  io::ByteWriter tooLong;
  tooLong.put(std::uint8_t{5});
  tooLong.put(std::uint64_t{1} << 60);
  expectIn(refusalOf(mcapFile(about + tooLong.bytes())), "there is no whole record at byte");
  expectIn(refusalOf(mcapFile(mcapChunk(about + tooLong.bytes()))), "chunk at byte",
           "there is no whole record at byte");
  expectIn(refusalOf(mcapFile(mcapRecord(0, "x"))), "there is no whole record at byte");
  expectIn(refusalOf(mcapFile(about + mcapRecord(5, "short"))), "ends in mid-value");
  expectIn(refusalOf(mcapFile(mcapRecord(4, "ab"))), "channel ends in mid-value");
  expectIn(refusalOf(mcapFile(mcapIndex(7, {}))), "an index before the first chunk");
  expectIn(refusalOf(mcapFile(first)), "a message of the unknown channel 7");
}

TEST_F(McapTest, RefusesAnIndexThatPointsElsewhere) {
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{3}, std::uint64_t{1} << 62})
    expectIn(
        refusalOf(mcapFile(
            mcapChunk(mcapRecord(99, "private") + first) + mcapIndex(7, {{10, offset}}), about)),
        "/points, message 1: damaged");
}

TEST_F(McapTest, StopsDecompressingWhereTheClaimEnds) {
  const std::string zeros(10000000, '\0');
  for (const char* compression : {"lz4", "zstd"}) {
    const std::string bomb = mcapCompressed(zeros, compression);
    expectIn(refusalOf(mcapFile(mcapRawChunk(bomb, compression, 1000, 0))),
             "it decompresses to more than 1000 bytes");
    expectIn(refusalOf(mcapFile(mcapRawChunk(bomb, compression, std::uint64_t{1} << 40, 0))),
             "are allowed");
    expectIn(refusalOf(mcapFile(mcapRawChunk(bomb, compression, 1 << 26, 0))),
             "67108864 bytes; up to " + std::to_string((16 << 20) + 50 * bomb.size()));
    expectIn(refusalOf(mcapFile(
                 mcapRawChunk(bomb.substr(0, bomb.size() / 2), compression, zeros.size(), 0))),
             "it cannot be decompressed");
    expectIn(refusalOf(mcapFile(mcapRawChunk(mcapCompressed(about, compression), compression,
                                             about.size() + 1, 0))),
             "bytes instead of");
  }
  expectIn(refusalOf(mcapFile(mcapRawChunk("x", "brotli", 1, 0))), "compressed with brotli; lz4");
}

TEST_F(McapTest, RefusesMoreThanAFileOfItsSizeCanHold) {
  expectIn(refusalOf(mcapFile(mcapChunk(first) + mcapIndex(7, {{10, 0}, {20, 0}}), about)),
           "its index names a message twice");
  std::string records = about;
  while (records.size() < 9000000) records += first;
  const std::string chunk =
      mcapRawChunk(mcapCompressed(records, "zstd"), "zstd", records.size(), 0);
  expectIn(refusalOf(mcapFile(chunk + chunk + chunk)), "the chunks hold more than a file of");
  std::string channels = mcapSchema(1, "T");
  for (std::uint16_t i = 0; i < 10001; ++i) channels += mcapChannel(i, 1, "/" + std::to_string(i));
  expectIn(refusalOf(mcapFile(channels)), "10001 topics; up to 10000 are allowed");
}

TEST_F(McapTest, RefusesOtherFormatsAndSchemas) {
  expectIn(refusalOf(mcapFile(mcapSchema(1, "T") + mcapChannel(7, 1, "/points", "json"))),
           "no messages in the format cdr, only /points (json)");
  expectIn(refusalOf(mcapFile(mcapSchema(1, "T", "protobuf") + mcapChannel(7, 1, "/points"))),
           "only /points (cdr with a schema in protobuf)");
  expectIn(refusalOf(mcapFile(about + mcapSchema(2, "U") + mcapChannel(8, 2, "/points"))),
           "/points has two types, T and U");
}

TEST_F(McapTest, LeavesChannelsInOtherFormatsOut) {
  const std::string others = mcapSchema(2, "S", "jsonschema") + mcapSchema(3, "U", "protobuf") +
                             mcapChannel(8, 2, "/state", "json") +
                             mcapChannel(9, 3, "/points", "protobuf");
  const std::string file =
      mcapFile(about + others + first + mcapMessage(8, 1, "{}") + mcapMessage(9, 1, "x"));
  EXPECT_EQ(contentsOf(file), std::vector<std::string>{"first"});
  EXPECT_HAS(noteOf(file),
             "left out: /points (protobuf with a schema in protobuf), /state (json with a schema");
}

TEST_F(McapTest, ChannelsOfOneTopicAreReadTogether) {
  EXPECT_EQ(contentsOf(mcapFile(about + mcapChannel(3, 1, "/points") + first +
                                mcapMessage(3, 15, "other") + second)),
            (std::vector<std::string>{"first", "other", "second"}));
}

TEST_F(McapTest, ReadsAFolderOfSeveralFiles) {
  write("in/d_0.mcap", mcapFile(about + first));
  write("in/d_1.mcap", mcapFile(mcapChunk(about + second + third, "lz4")));
  EXPECT_EQ(contents("in"), all);
  write("in/metadata.yaml", bagMetadata({"d_1.mcap"}, "\"\"", "\"\"", "mcap"));
  EXPECT_EQ(contents("in"), (std::vector<std::string>{"second", "third"}));
}

TEST_F(McapTest, ReadsMessagesThatAreCompressedEach) {
  write("in/d.mcap", mcapFile(about + mcapMessage(7, 1, zstdFrame("first"))));
  write("in/metadata.yaml", bagMetadata({"d.mcap"}, "zstd", "MESSAGE", "mcap"));
  EXPECT_EQ(contents("in"), std::vector<std::string>{"first"});
  write("in/d.mcap", mcapFile(about + first));
  EXPECT_REFUSED(contents("in"), "/points, message 1: damaged: it cannot be decompressed");
}

}  // namespace
}  // namespace polemcl::test_mcap_storage
