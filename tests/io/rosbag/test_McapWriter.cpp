#include "io/rosbag/Bag.h"
#include "io/rosbag/McapWriter.h"
#include "io/rosbag/RosResults.h"
#include "support/IoFiles.h"
#include "support/McapFiles.h"

namespace polemcl::test_mcap_writer {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

class McapWriterTest : public FolderTest {
 protected:
  /// Two topics; messages of a kilobyte each, so that there are several chunks.
  void writeBag(const std::string& file) const {
    McapWriter bag(path(file));
    const auto a = bag.addTopic({"/a", "nav_msgs/msg/Path", rosSchema("nav_msgs/msg/Path")});
    const auto b = bag.addTopic({"/b", "T", "float64 x\n", true});
    bag.add(b, 1, "once");
    for (std::uint64_t i = 0; i < messages; ++i) bag.add(a, 1000 + i, contentOf(i));
    bag.commit();
  }
  static std::string contentOf(std::uint64_t i) {
    return std::to_string(i) + std::string(1000, 'x');
  }
  static constexpr std::uint64_t messages = 2500;
};

TEST_F(McapWriterTest, OurReaderFindsTheSameMessages) {
  writeBag("a.mcap");
  const Bag bag(path("a.mcap"));
  ASSERT_EQ(bag.topics().size(), 2u);
  EXPECT_EQ(bag.topics()[0].name, "/a");
  EXPECT_EQ(bag.topics()[0].type, "nav_msgs/msg/Path");
  EXPECT_EQ(bag.read(bag.messages(1).front()), "once");
  const auto found = bag.messages(0);
  ASSERT_EQ(found.size(), messages);
  for (std::uint64_t i = 0; i < messages; ++i) EXPECT_EQ(bag.read(found[i]), contentOf(i));
  EXPECT_TRUE(bag.notes().empty());
  EXPECT_LT(fs::file_size(path("a.mcap")), 1000 * messages / 4) << "chunks are compressed";
}

TEST_F(McapWriterTest, TheSameMessagesGiveTheSameBytes) {
  writeBag("a.mcap");
  writeBag("b.mcap");
  EXPECT_EQ(readBytes(path("a.mcap")), readBytes(path("b.mcap")));
}

/// The checksums as the format defines them, over the bytes of the file.
TEST_F(McapWriterTest, ChecksumsCoverTheDataAndTheSummary) {
  writeBag("a.mcap");
  const std::string bytes = readBytes(path("a.mcap"));
  const std::size_t footer = bytes.size() - 8 - 20 - 9;  // magic bytes, content, prefix
  const auto summary = loadLittleEndian<std::uint64_t>(bytes.data() + footer + 9);
  const auto ofSummary = loadLittleEndian<std::uint32_t>(bytes.data() + bytes.size() - 12);
  EXPECT_EQ(ofSummary, mcapChecksum(bytes.substr(summary, bytes.size() - 12 - summary)));
  const std::size_t dataEnd = summary - 4 - 9;
  EXPECT_EQ(bytes[dataEnd], 15);
  EXPECT_EQ(loadLittleEndian<std::uint32_t>(bytes.data() + dataEnd + 9),
            mcapChecksum(bytes.substr(0, dataEnd)));
}

TEST_F(McapWriterTest, NothingAppearsBeforeItIsComplete) {
  {
    McapWriter bag(path("a.mcap"));
    bag.add(bag.addTopic({"/b", "T", "float64 x\n"}), 1, "once");
    EXPECT_FALSE(fs::exists(path("a.mcap")));
  }
  EXPECT_TRUE(fs::is_empty(m_folder));
}

TEST_F(McapWriterTest, SchemasStateEachTypeOnce) {
  const std::string line = std::string(80, '=') + '\n';
  EXPECT_EQ(rosSchema("nav_msgs/msg/Path"),
            "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n" + line +
                "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + line +
                "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" + line +
                "MSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\n"
                "geometry_msgs/Pose pose\n" +
                line +
                "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\n"
                "geometry_msgs/Quaternion orientation\n" +
                line + "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + line +
                "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\n"
                "float64 w 1\n");
  EXPECT_REFUSED(rosSchema("my_msgs/msg/Mine"), "my_msgs/msg/Mine: no message that is written");
}

}  // namespace
}  // namespace polemcl::test_mcap_writer
