#include "localize/RunFiles.h"
#include "support/IoFiles.h"

namespace polemcl::test_growing_file {

using namespace polemcl::io::test;
using polemcl::apps::GrowingFile;

using GrowingFileTest = FolderTest;

TEST_F(GrowingFileTest, HoldsAllThatWasAdded) {
  write("f", "what was there before");
  GrowingFile file(path("f"));
  EXPECT_EQ(read(path("f")), "");
  std::string all;
  for (int i = 0; i < 3000; ++i) {
    const std::string row = std::to_string(i * 7919) + "\n";
    file.add(row);
    all += row;
    // Only the last piece may wait.
    ASSERT_GE(fs::file_size(path("f")) + GrowingFile::kPiece, all.size());
  }
  file.flush();
  file.flush();
  EXPECT_EQ(read(path("f")), all);
}

TEST_F(GrowingFileTest, AnyNumberGrowAtATime) {
  std::vector<GrowingFile> files;
  for (int i = 0; i < 3000; ++i) files.emplace_back(path(std::to_string(i)));
  for (auto& file : files) file.add("row\n"), file.flush();
  EXPECT_EQ(read(path("2999")), "row\n");
}

TEST_F(GrowingFileTest, RefusesWhatCannotBeWritten) {
  EXPECT_REFUSED(GrowingFile(path("none/f")), path("none/f").string());
  GrowingFile file(path("f"));
  fs::remove(path("f"));
  fs::create_directory(path("f"));
  file.add("row\n");
  EXPECT_REFUSED(file.flush(), "cannot write " + path("f").string());
}

TEST_F(GrowingFileTest, RefusesWhenTheDiskIsFull) {
  GrowingFile file(path("f"));
  const FileSizeLimit limit(GrowingFile::kPiece / 2);
  EXPECT_REFUSED(file.add(std::string(GrowingFile::kPiece, 'a')), "cannot write");
}

}  // namespace polemcl::test_growing_file
