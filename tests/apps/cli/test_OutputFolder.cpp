#include <polemcl/core/common/Types.h>
#include "cli/OutputFolder.h"
#include "support/DiskCalls.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_output_folder {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class OutputFolderTest : public testing::Test {
 protected:
  OutputFolder open(const std::string& name) {
    return OutputFolder(folder / name, "a drive", {"mark", "data", "scans", "scans/[0-9][0-9].bin"},
                        "mark");
  }
  std::string refusal(const std::string& name) {
    return messageOf([&] { open(name); });
  }
  std::string parent() const { return folder.path().filename(); }
  TempFolder folder;
};
TEST_F(OutputFolderTest, AppearsOnlyWhenCommitted) {
  {
    OutputFolder out = open("out");
    writeText(out.temporary() / "mark", "1");
    EXPECT_FALSE(fs::exists(folder / "out"));
    out.commit();
  }
  EXPECT_EQ(readText(folder / "out" / "mark"), "1");
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{"out"});
}

TEST_F(OutputFolderTest, LeavesNothingWithoutCommit) {
  { writeText(open("out").temporary() / "mark", "1"); }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(OutputFolderTest, RemovesWhatAKilledProcessLeft) {
  const auto killed = [&] {
    const OutputFolder out = open("out");
    writeText(out.temporary() / "data", "half");
    ::_exit(9);
  };
  EXPECT_EXIT(killed(), testing::ExitedWithCode(9), "");
  ASSERT_EQ(names(folder.path()).size(), 1u);
  const OutputFolder other = open("out.2");  // another output, under way
  EXPECT_EQ(names(folder.path()).size(), 2u);
  open("out");
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{other.temporary().filename()});
}

TEST_F(OutputFolderTest, RemovesOnlyLeftoversThatHoldNothingElse) {
  for (const char* name : {"out.1-1.tmp/scans/01.bin", "out.1-1.tmp/data.1-7.tmp",
                           "out.1-2.tmp/thesis.tex", "out.1-3.tmp", "out.2024-01-01.tmp/data"})
    writeText(folder / name, "");
  open("out");
  EXPECT_EQ(names(folder.path()),
            (std::vector<std::string>{"out.1-2.tmp", "out.1-3.tmp", "out.2024-01-01.tmp"}));
}

TEST_F(OutputFolderTest, ReplacesAnEarlierOutputAndAnEmptyFolder) {
  writeText(folder / "out" / "mark", "old");
  writeText(folder / "out" / "data", "old");
  fs::create_directory(folder / "empty");
  for (const char* name : {"out", "empty", "out/"}) {
    OutputFolder out = open(name);
    writeText(out.temporary() / "mark", "new");
    out.commit();
    EXPECT_EQ(names(folder / name), std::vector<std::string>{"mark"});
    EXPECT_EQ(readText(folder / name / "mark"), "new");
  }
  EXPECT_EQ(names(folder.path()), (std::vector<std::string>{"empty", "out"}));
}

TEST_F(OutputFolderTest, KeepsTheEarlierOutputWhenTheNewOneFails) {
  writeText(folder / "out" / "mark", "old");
  { writeText(open("out").temporary() / "mark", "half"); }
  EXPECT_EQ(readText(folder / "out" / "mark"), "old");
}

TEST_F(OutputFolderTest, IsOnTheDiskBeforeItHasItsName) {
  OutputFolder out = open("out");
  const testing_disk::DiskCalls calls;
  out.commit();
  EXPECT_EQ(calls.all(), (std::vector<std::string>{"sync all", "rename out", "sync " + parent()}));
}

TEST_F(OutputFolderTest, TheEarlierOutputHasTheNameUntilTheNewOneHasIt) {
  writeText(folder / "out" / "mark", "old");
  OutputFolder out = open("out");
  writeText(out.temporary() / "mark", "new");
  const testing_disk::DiskCalls calls;
  out.commit();
  EXPECT_EQ(calls.all(),
            (std::vector<std::string>{"sync all", "exchange out", "sync " + parent()}));
  EXPECT_EQ(readText(folder / "out" / "mark"), "new");
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{"out"});
}

TEST_F(OutputFolderTest, ReplacesWhereNamesCannotBeExchanged) {
  writeText(folder / "out" / "mark", "old");
  testing_disk::DiskCalls calls;
  calls.failExchange = true;
  OutputFolder out = open("out");
  writeText(out.temporary() / "mark", "new");
  out.commit();
  EXPECT_EQ(readText(folder / "out" / "mark"), "new");
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{"out"});
}

TEST_F(OutputFolderTest, TakesAnotherNameWhenTheFirstIsTakenForALeftover) {
  testing_disk::DiskCalls calls;
  calls.othersLocks = 1;
  const OutputFolder out = open("out");
  EXPECT_TRUE(io::PathLock(out.temporary()).isOfAnother());
  EXPECT_EQ(names(folder.path()).size(), 2u);
}

TEST_F(OutputFolderTest, RefusesAFolderWithForeignFiles) {
  writeText(folder / "out" / "mark", "old");
  writeText(folder / "out" / "thesis.tex", "years of work");
  EXPECT_NE(refusal("out").find("thesis.tex"), std::string::npos) << refusal("out");
  EXPECT_TRUE(fs::exists(folder / "out" / "thesis.tex"));
}

TEST_F(OutputFolderTest, RefusesFilesThatCameMeanwhile) {
  OutputFolder out = open("out");
  writeText(folder / "out" / "notes.txt", "by hand");
  EXPECT_HAS(messageOf([&] { out.commit(); }), "notes.txt");
  EXPECT_EQ(readText(folder / "out" / "notes.txt"), "by hand");
}

TEST_F(OutputFolderTest, RefusesForeignFilesInASubfolder) {
  writeText(folder / "out" / "mark", "old");
  writeText(folder / "out" / "scans" / "01.bin", "old");
  EXPECT_EQ(refusal("out"), "no error");
  writeText(folder / "out" / "scans" / "01_cleaned.bin", "by hand");
  EXPECT_NE(refusal("out").find("scans/01_cleaned.bin"), std::string::npos) << refusal("out");
  EXPECT_TRUE(fs::exists(folder / "out" / "scans" / "01_cleaned.bin"));
}

TEST_F(OutputFolderTest, RefusesAFolderWithoutTheMarker) {
  writeText(folder / "out" / "data", "of another program");
  EXPECT_NE(refusal("out").find("mark"), std::string::npos) << refusal("out");
}

TEST_F(OutputFolderTest, RefusesAFileInItsPlace) {
  writeText(folder / "out", "a file");
  EXPECT_NE(refusal("out").find("not a folder"), std::string::npos) << refusal("out");
}

TEST_F(OutputFolderTest, RefusesAMissingParent) {
  EXPECT_NE(refusal("missing/out").find("cannot be created"), std::string::npos);
}

}  // namespace
}  // namespace polemcl::test_output_folder
