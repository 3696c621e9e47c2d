#include "io/rosbag/Bag.h"
#include "support/IoFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_bag {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

class BagTest : public FolderTest {
 protected:
  /// A file with messages of one topic.
  void writeFile(const std::string& name, const std::vector<std::string>& messages,
                 const std::string& type = "T") const {
    TestBag bag(path(name));
    const int other = bag.topic("/other", "O"), topic = bag.topic("/points", type);
    std::int64_t time = 0;
    for (const std::string& message : messages) bag.add(topic, ++time, message);
    bag.add(other, 1, "other");
  }
  void makeDatabase(const std::string& name, const std::string& sql) const {
    sqlite3* database = nullptr;
    sqlite3_open(path(name).c_str(), &database);
    ASSERT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }
  static std::vector<std::string> contents(const Bag& bag, std::size_t topic) {
    std::vector<std::string> result;
    for (const auto& message : bag.messages(topic)) result.push_back(bag.read(message));
    return result;
  }
};

TEST_F(BagTest, ReadsOneFileInTheOrderOfRecording) {
  {
    TestBag bag(path("a.db3"));
    const int topic = bag.topic("/b", "B");
    bag.topic("/a", "sensor_msgs/Imu", "");  // as the first versions of ROS 2 name types
    bag.add(topic, 30, "third");
    bag.add(topic, 10, "first");
    bag.add(topic, 20, std::string("sec\0nd", 6));
  }
  const Bag bag(path("a.db3"));
  ASSERT_EQ(bag.topics().size(), 2u);
  EXPECT_EQ(bag.topics()[0].name, "/a");
  EXPECT_EQ(bag.topics()[0].type, "sensor_msgs/msg/Imu");
  EXPECT_EQ(bag.topics()[0].messages, 0u);
  EXPECT_EQ(bag.topics()[1].type, "B");
  EXPECT_EQ(bag.topics()[1].messages, 3u);
  EXPECT_EQ(contents(bag, 1), (std::vector<std::string>{"first", {"sec\0nd", 6}, "third"}));
  const BagMessage first = bag.messages(1).front();
  EXPECT_EQ(bag.read(first, 3), "fir");
  EXPECT_EQ(bag.place(first), path("a.db3").string() + ": /b, message 2: ");
  EXPECT_EQ(bag.read(bag.message(1, path("a.db3"), 1)), "third");
  EXPECT_THROW(bag.message(1, path("b.db3"), 1), Error);
  EXPECT_REFUSED(bag.read(bag.message(1, path("a.db3"), 99)), "/b, message 99: ");
}

TEST_F(BagTest, ReadsFilesInTheOrderOfTheMetadata) {
  writeFile("in/x.db3", {"3", "4"});
  writeFile("in/y.db3", {"1", "2"});
  write("in/metadata.yaml", bagMetadata({"\"in/y.db3\"", "x.db3"}));
  const Bag bag(path("in"));
  EXPECT_EQ(bag.topics()[1].messages, 4u);
  EXPECT_EQ(contents(bag, 1), (std::vector<std::string>{"1", "2", "3", "4"}));
}

TEST_F(BagTest, ReadsFilesInTheOrderOfTheirNumbersWithoutMetadata) {
  for (const char* number : {"0", "2", "10"})
    writeFile(std::string("in/drive_") + number + ".db3", {number});
  EXPECT_EQ(contents(Bag(path("in")), 1), (std::vector<std::string>{"0", "2", "10"}));
}

TEST_F(BagTest, TopicsAreTheSameWhateverTheirIds) {
  writeFile("in/a_0.db3", {"1"});
  {
    TestBag second(path("in/a_1.db3"));
    second.add(second.topic("/points", "T"), 5, "2");
  }
  const Bag bag(path("in"));
  ASSERT_EQ(bag.topics().size(), 2u);
  EXPECT_EQ(contents(bag, 0), std::vector<std::string>{"other"});
  EXPECT_EQ(contents(bag, 1), (std::vector<std::string>{"1", "2"}));
}

TEST_F(BagTest, NothingIsWrittenBesideTheBag) {
  writeFile("a?b#c%20.db3", {"1"});
  const Bag bag(path("a?b#c%20.db3"));
  EXPECT_EQ(contents(bag, 1).size(), 1u);
  EXPECT_EQ(std::distance(fs::directory_iterator(m_folder), {}), 1);
}

TEST_F(BagTest, PathsMayBeginWithTwoSlashes) {
  writeFile("a.db3", {"1"});
  EXPECT_EQ(contents(Bag("/" + path("a.db3").string()), 1), std::vector<std::string>{"1"});
}

TEST_F(BagTest, ReadsChangesThatWereNotMerged) {
  TestBag open(path("a.db3"));
  open.run("PRAGMA journal_mode = WAL");
  const std::string message(50000, 'n');  // longer than the file without its changes
  open.add(open.topic("/points", "T"), 1, message);
  ASSERT_TRUE(fs::exists(path("a.db3-wal")));
  EXPECT_EQ(contents(Bag(path("a.db3")), 0), std::vector<std::string>{message});
}

TEST_F(BagTest, NamesTheCommandThatUnpacksFiles) {
  for (const char* name : {"a.db3.zstd", "a.mcap.zst"}) {
    const std::string packed = path(name).string();
    const std::string plain = packed.substr(0, packed.rfind('.'));
    write(name, "");
    EXPECT_REFUSED(Bag(path(name)), packed + ": the file is compressed as a whole (zstd)",
                   "unpack it: zstd -d " + packed + " -o " + plain);
  }
  write("in/a.db3.zstd", "");
  EXPECT_REFUSED(Bag(path("in")), "a.db3.zstd: the file is compressed as a whole");
  write("in/metadata.yaml", bagMetadata({"a.db3.zstd"}, "zstd", "FILE"));
  EXPECT_REFUSED(Bag(path("in")), "a.db3.zstd: the file is compressed as a whole");
}

TEST_F(BagTest, ReadsUnpackedFilesBesideCompressedOnes) {
  write("in/a.db3.zstd", "");
  writeFile("in/a.db3", {"1"});
  EXPECT_EQ(contents(Bag(path("in")), 1), std::vector<std::string>{"1"});
  write("in/metadata.yaml", bagMetadata({"a.db3.zstd"}, "zstd", "FILE"));
  EXPECT_EQ(contents(Bag(path("in")), 1), std::vector<std::string>{"1"});
}

TEST_F(BagTest, RefusesOtherCompressions) {
  writeFile("in/a.db3", {"1"});
  write("in/metadata.yaml", bagMetadata({"a.db3"}, "lz4", "FILE"));
  EXPECT_REFUSED(Bag(path("in")), "metadata.yaml: the bag is compressed (lz4, FILE)",
                 "ros2 bag convert");
  write("in/metadata.yaml", bagMetadata({"a.db3"}, "\"\"", "NONE"));
  EXPECT_EQ(Bag(path("in")).topics().size(), 2u);
}

TEST_F(BagTest, RefusesWhatIsNoBag) {
  EXPECT_REFUSED(Bag(path("nothing")), "nothing: there is no such bag");
  write("text.db3", std::string(3000, 'x'));
  EXPECT_REFUSED(Bag(path("text.db3")),
                 "text.db3: cannot be read as a ROS 2 bag: file is not a database");
  write("empty.db3", "");
  EXPECT_REFUSED(Bag(path("empty.db3")), "empty.db3: cannot be read as a ROS 2 bag: no such table");
  write("a.bag", "");
  EXPECT_REFUSED(Bag(path("a.bag")), "a.bag: not a .db3 or .mcap file of a ROS 2 bag",
                 "ros2 bag convert");
  write("a.bag", "#ROSBAG V2.0\n");
  EXPECT_REFUSED(Bag(path("a.bag")), "a.bag: a bag of ROS 1; rosbag2rawlog");
  write("pointer.mcap", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
  EXPECT_REFUSED(Bag(path("pointer.mcap")), "pointer.mcap: a pointer of Git LFS", "git lfs pull");
  write("bag/metadata.yaml", bagMetadata({"a.db3"}));
  EXPECT_REFUSED(Bag(path("bag/metadata.yaml")), "metadata.yaml: name the folder of the bag");
  fs::create_directories(path("folder"));
  EXPECT_REFUSED(Bag(path("folder")), "folder: no .db3 or .mcap file in it");
  write("lost/metadata.yaml", bagMetadata({"a.db3"}));
  EXPECT_REFUSED(Bag(path("lost")), "a.db3: missing, although metadata.yaml of the bag names it");
  write("other/metadata.yaml", bagMetadata({"a.db3"}, "\"\"", "\"\"", "other"));
  EXPECT_REFUSED(Bag(path("other")), "metadata.yaml: the storage of the bag is other",
                 "ros2 bag convert");
}

TEST_F(BagTest, RefusesTopicsThatContradictEachOther) {
  writeFile("in/a_0.db3", {"1"});
  writeFile("in/a_1.db3", {"2"}, "U");
  EXPECT_REFUSED(Bag(path("in")), "a_1.db3: /points has two types, T and U");
}

TEST_F(BagTest, LeavesTopicsInOtherFormatsOut) {
  {
    TestBag bag(path("a.db3"));
    bag.topic("/points", "T", "protobuf");
  }
  EXPECT_REFUSED(Bag(path("a.db3")),
                 "a.db3: no messages in the format cdr, only /points (protobuf)");
  {
    TestBag bag(path("b.db3"));
    bag.topic("/state", "S", "json");
    bag.add(bag.topic("/points", "T"), 1, "first");
  }
  const Bag bag(path("b.db3"));
  ASSERT_EQ(bag.topics().size(), 1u);
  EXPECT_EQ(contents(bag, 0), std::vector<std::string>{"first"});
  ASSERT_EQ(bag.notes().size(), 1u);
  expectIn(bag.notes()[0], "topics in other formats than cdr are left out: /state (json)");
}

/// What a file of a few kilobytes may ask of SQLite: queries without end, and gigabytes.
TEST_F(BagTest, ViewsAndComputedColumnsAreNotRun) {
  const std::string topics =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format "
      "TEXT); INSERT INTO topics VALUES(1, '/points', 'T', 'cdr');";
  const std::string columns = " AS id, 1 AS topic_id, 1 AS timestamp, x'00' AS data FROM n";
  makeDatabase("view.db3", topics +
                               "CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 "
                               "UNION ALL SELECT i + 1 FROM n) SELECT i" +
                               columns);
  EXPECT_REFUSED(Bag(path("view.db3")), "view.db3", "messages must be a table, no view");
  makeDatabase("virtual.db3", topics +
                                  "CREATE VIRTUAL TABLE messages USING rtree(id, topic_id, "
                                  "timestamp)");
  EXPECT_REFUSED(Bag(path("virtual.db3")), "messages must be a table, no virtual");
  makeDatabase("column.db3",
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, type TEXT, serialization_format TEXT, "
               "name TEXT AS (hex(zeroblob(400000000)))); "
               "INSERT INTO topics VALUES(1, 'T', 'cdr'); "
               "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data)");
  EXPECT_REFUSED(Bag(path("column.db3")), "column.db3", "too big");
}

/// Pages of a table that lead to the same next page from each of their entries.
TEST_F(BagTest, PagesThatAreVisitedWithoutEndAreRefused) {
  {
    TestBag bag(path("a.db3"));
    const int topic = bag.topic("/points", "T");
    for (int i = 0; i < 2000; ++i) bag.add(topic, i, std::string(100, 'x'));
  }
  std::string bytes = read(path("a.db3"));
  const auto number = [&](std::size_t at, int size) {
    std::size_t value = 0;
    for (int i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  const auto setNumber = [&](std::size_t at, std::size_t value) {
    for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
  };
  const std::size_t size = number(16, 2), pages = bytes.size() / size;
  std::size_t root = 0;
  for (std::size_t page = 1; page < pages; ++page)
    if (bytes[page * size] == 5 && number(page * size + 3, 2) > 20) root = page * size;
  ASSERT_GT(root, 0u) << "no table with pages below it";
  constexpr std::size_t kLevels = 8;
  for (std::size_t level = 0; level < kLevels; ++level) {
    const std::size_t at = bytes.size(), next = pages + level + 2;
    bytes += bytes.substr(root, size);
    if (level + 1 == kLevels) continue;
    setNumber(at + 8, next);
    for (std::size_t i = 0; i < number(at + 3, 2); ++i)
      setNumber(at + number(at + 12 + 2 * i, 2), next);
  }
  bytes.replace(root, size, bytes, pages * size, size);
  setNumber(28, pages + kLevels);
  write("b.db3", bytes);
  EXPECT_REFUSED(Bag(path("b.db3")), "b.db3: damaged: it has more rows than");
}

TEST_F(BagTest, RefusesADamagedFile) {
  writeFile("a.db3", {std::string(20000, 'x')});
  fs::resize_file(path("a.db3"), 12288);  // three pages of four thousand bytes
  EXPECT_REFUSED(contents(Bag(path("a.db3")), 1), "a.db3", "malformed");
}

}  // namespace
}  // namespace polemcl::test_bag
