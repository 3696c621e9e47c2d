#include "io/dataset/ScanFiles.h"
#include "support/IoFiles.h"

namespace polemcl::test_scan_files {

using namespace polemcl::io;
using namespace polemcl::io::test;

using ScanFilesTest = FolderTest;

TEST_F(ScanFilesTest, ListsInOrderOfNames) {
  for (const char* name : {"d/b.bin", "d/a.bin", "d/c.txt", "d/.a.bin", "d/B.bin", "d/e.bin/f"}) {
    write(name, "");
  }
  const auto files = listFiles(path("d"), ".bin");
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[0].filename(), "B.bin");
  EXPECT_EQ(files[1].filename(), "a.bin");
  EXPECT_EQ(files[2].filename(), "b.bin");
  EXPECT_TRUE(files[0].is_absolute());
}

TEST_F(ScanFilesTest, RefusesAMissingOrUselessFolder) {
  EXPECT_REFUSED(listFiles(path("no"), ".bin"), path("no").string(), "No such file or directory");
  EXPECT_REFUSED(listFiles(write("f", ""), ".bin"), "Not a directory");
  EXPECT_REFUSED(listFiles(m_folder, ".bin"), m_folder.string(), "no *.bin");
}

TEST_F(ScanFilesTest, NamesFolders) {
  write("a/b/0.bin", "");
  for (const char* name : {"a/b", "a/b/", "a/b/.", "a/b/./", "a/../a/b//", "a/b/c/.."})
    EXPECT_EQ(folderNamed(path(name)), path("a/b")) << name;
  EXPECT_EQ(folderNamed("."), fs::current_path());
  EXPECT_EQ(folderNamed(path("no/./folder/")), path("no/folder"));
  fs::create_directory_symlink(path("a/b"), path("link"));
  EXPECT_EQ(folderNamed(path("link/.")), path("link"));
  EXPECT_TRUE(fs::equivalent(folderNamed(path("link/..")), path("a")));
  EXPECT_EQ(listFiles(path("link/../b/."), ".bin").at(0).filename(), "0.bin");
  EXPECT_EQ(listFiles(path("a/./b"), ".bin").at(0), path("a/b/0.bin"));
}

TEST_F(ScanFilesTest, TablesMayBeCompressed) {
  EXPECT_EQ(existing(path("a.csv")), "");
  write("a.csv.gz", "");
  write("a.bin.gz", "");
  EXPECT_EQ(existing(path("a.csv")), path("a.csv.gz"));
  EXPECT_EQ(existing(path("a.bin")), "");
  write("a.csv", "");
  EXPECT_EQ(existing(path("a.csv")), path("a.csv"));
}

TEST_F(ScanFilesTest, ALinkToNothingIsThere) {
  EXPECT_FALSE(isThere(path("f")));
  EXPECT_FALSE(isThere(path("no/f")));
  EXPECT_TRUE(isThere(write("f", "")));
  fs::create_symlink(path("gone"), path("link"));
  EXPECT_TRUE(isThere(path("link")));
}

TEST_F(ScanFilesTest, FileNumber) {
  EXPECT_EQ(fileNumber("x/000012.bin"), 12u);
  EXPECT_EQ(fileNumber("1326652795280148.bin"), 1326652795280148u);
  EXPECT_EQ(fileNumber("1561000444390857630.bin"), 1561000444390857630u);
  for (const char* name : {"a.bin", "12a.bin", "-1.bin", ".bin", "12345678901234567890.bin"}) {
    EXPECT_FALSE(fileNumber(name)) << name;
  }
}

TEST_F(ScanFilesTest, RefusesBadInput) {
  EXPECT_EQ(fileNumbers({"0.bin", "2.bin"}), (std::vector<std::uint64_t>{0, 2}));
  EXPECT_REFUSED(fileNumbers({"0.bin", "x.bin"}), "x.bin", "000012.bin");
  EXPECT_REFUSED(fileNumbers({"01.bin", "1.bin"}), "1.bin", "twice");
  for (const char* name : {"p/08.bin", "p/09.bin", "p/10.bin", "p/a.bin"}) write(name, "");
  EXPECT_EQ(listFiles(path("p"), ".bin").size(), 4u);
  for (const char* name : {"d/1.bin", "d/10.bin", "d/2.bin"}) write(name, "");
  const auto namesIn = [&](const std::string& folder) {
    std::string names;
    for (const fs::path& file : listFiles(path(folder), ".bin"))
      names += file.stem().string() + ' ';
    return names;
  };
  EXPECT_EQ(namesIn("p"), "08 09 10 a ");
  EXPECT_EQ(namesIn("d"), "1 2 10 ");
  for (const char* name : {"s/scan_9.bin", "s/scan_10.bin", "t/9.9.bin", "t/10.0.bin"})
    write(name, "");
  EXPECT_EQ(namesIn("s"), "scan_9 scan_10 ");
  EXPECT_EQ(namesIn("t"), "9.9 10.0 ");
  for (const char* name : {"u/1700000000.1758.bin", "u/1700000000.2.bin"}) write(name, "");
  EXPECT_EQ(listFiles(path("u"), ".bin").size(), 2u);
}

TEST_F(ScanFilesTest, Ranges) {
  EXPECT_EQ(ranges({}), "");
  EXPECT_EQ(ranges({5}), "5");
  EXPECT_EQ(ranges({177, 178, 179, 180, 200, 202, 203}), "177-180, 200, 202-203");
  EXPECT_EQ(ranges({1, 3, 5, 6}, 2), "1, 3, …");
  EXPECT_EQ(ranges({1, 3, 5, 6}, 3), "1, 3, 5-6");
}

TEST_F(ScanFilesTest, NotesEmptyScans) {
  std::vector<std::string> notes;
  checkScanSizes({write("0.bin", std::string(32, 'x'))}, notes);
  EXPECT_TRUE(notes.empty());
  checkScanSizes({path("0.bin"), write("1.bin", ""), write("2.bin", "")}, notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "2 of 3 scans are empty, the first is 1.bin");
}

TEST_F(ScanFilesTest, RefusesAScanCutShort) {
  std::vector<std::string> notes;
  const fs::path file = write("1.bin", std::string(33, 'x'));
  EXPECT_REFUSED(checkScanSizes({path("no.bin")}, notes), path("no.bin").string(),
                 "No such file or directory");
  EXPECT_REFUSED(checkScanSizes({write("0.bin", ""), file}, notes), file.string(), "cut short",
                 "33 bytes");
}

TEST_F(ScanFilesTest, RefusesFiveNumbersAPoint) {
  std::string five, four;
  for (int i = 0; i < 32; ++i) {
    const auto x = static_cast<float>(0.5 + i), ring = static_cast<float>(i);
    five += floats({x, 2, -1, 50, ring});
    four += floats({x, 2, -1, 50}) + (i % 4 == 3 ? floats({x, 3, -1, 50}) : "");
  }
  std::vector<std::string> notes;
  ASSERT_EQ(four.size(), five.size());
  checkScanSizes({write("0.bin", ""), write("1.bin", four)}, notes);
  EXPECT_REFUSED(checkScanSizes({path("0.bin"), write("2.bin", five)}, notes),
                 path("2.bin").string(), "five numbers a point", "keep the first four");
  checkScanSizes({write("3.bin", four.substr(16)), path("2.bin")}, notes);  // another size
  checkScanSizes({path("2.bin")}, notes, {8, "of NCLT"});
  EXPECT_EQ(notes.size(), 1u);
}

TEST_F(ScanFilesTest, RefusesWhenAllScansAreEmpty) {
  std::vector<std::string> notes;
  EXPECT_REFUSED(checkScanSizes({write("0.bin", "")}, notes), m_folder.string(), "no usable scan");
}

TEST_F(ScanFilesTest, RefusesTimesThatDoNotIncrease) {
  requireIncreasing("t", {{1, {-1}}, {2, {0}}, {5, {0.5}}});
  EXPECT_REFUSED(requireIncreasing("t", {{1, {0}}, {4, {0}}}), "t:4: ", "0 is not after 0");
}

}  // namespace polemcl::test_scan_files
