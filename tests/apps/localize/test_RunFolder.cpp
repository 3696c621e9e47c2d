#include <polemcl/core/common/Types.h>
#include "localize/RunFolder.h"
#include "support/DiskCalls.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_run_folder {

using polemcl::apps::RunFolder;
using namespace testing_apps;

namespace {

using Names = std::vector<std::string>;

struct RunFolderTest : testing::Test {
  const TempFolder folder;
};

TEST_F(RunFolderTest, SwapsOldRunsForNewOnesAndKeepsTheRest) {
  for (const char* name : {"run_00.tum", "run_07_errors.csv", "summary.json", "config.ini", "mine"})
    writeText(folder / name, "old");
  {
    RunFolder results(folder.path());
    for (const char* name : {"run_00.tum", "config.ini", "summary.json"})
      writeText(results.staged(name), "new");
    EXPECT_EQ(readText(folder / "run_00.tum"), "old");
    EXPECT_EQ(readText(folder / "run_07_errors.csv"), "old");
    results.commit();
  }
  EXPECT_EQ(names(folder.path()), Names({"config.ini", "mine", "run_00.tum", "summary.json"}));
  EXPECT_EQ(readText(folder / "run_00.tum"), "new");
  EXPECT_EQ(readText(folder / "config.ini"), "new");
  EXPECT_EQ(readText(folder / "summary.json"), "new");
  EXPECT_EQ(readText(folder / "mine"), "old");
}

TEST_F(RunFolderTest, WhatHasASummaryIsOnTheDisk) {
  writeText(folder / "summary.json", "old");
  RunFolder results(folder.path());
  writeText(results.staged("summary.json"), "new");
  writeText(results.staged("run_00.tum"), "new");
  const std::string sync = "sync " + folder.path().filename().string();
  const testing_disk::DiskCalls calls;
  results.commit();
  EXPECT_EQ(calls.all(), Names({"sync all", sync, "rename run_00.tum, locked", sync,
                                "rename summary.json, locked", sync}))
      << "after the old summary is gone, before the new one comes, and at the end";
}

TEST_F(RunFolderTest, ScenesOfOldRunsGoAndOtherFoldersStay) {
  for (const char* name : {"run_00_scenes/000007.3Dscene", "run_03_scenes/a", "run_mine/a"})
    writeText(folder / name, "old");
  {
    RunFolder results(folder.path());
    writeText(results.staged("run_00_scenes") / "000001.3Dscene", "new");
    results.commit();
  }
  EXPECT_EQ(names(folder.path()), Names({"run_00_scenes", "run_mine"}));
  EXPECT_EQ(names(folder / "run_00_scenes"), Names({"000001.3Dscene"}));
}

TEST_F(RunFolderTest, KnowsWhatAKilledRunLeft) {
  const auto killed = [&] {
    const RunFolder results(folder.path());
    writeText(results.staged("run_00.tum"), "half");
    ::_exit(9);
  };
  EXPECT_EXIT(killed(), testing::ExitedWithCode(9), "");
  const RunFolder underWay(folder.path());
  const RunFolder results(folder.path());
  ASSERT_EQ(results.leftovers().size(), 1u);
  EXPECT_EQ(readText(results.leftovers()[0] / "run_00.tum"), "half");
}

TEST_F(RunFolderTest, WithoutCommitTheOldStays) {
  writeText(folder / "run_00.tum", "old");
  {
    RunFolder results(folder.path());
    writeText(results.staged("run_00.tum"), "half");
  }
  EXPECT_EQ(names(folder.path()), Names({"run_00.tum"}));
  EXPECT_EQ(readText(folder / "run_00.tum"), "old");
}

TEST_F(RunFolderTest, ANewFolderIsGoneAgainWithoutCommit) {
  {
    RunFolder results(folder / "new");
    writeText(results.staged("run_00.tum"), "half");
  }
  EXPECT_EQ(names(folder.path()), Names());
}

TEST_F(RunFolderTest, CreatesFoldersAbove) {
  {
    RunFolder results(folder / "a/b");
    writeText(results.staged("summary.json"), "new");
    results.commit();
  }
  EXPECT_EQ(names(folder / "a/b"), Names({"summary.json"}));
}

TEST_F(RunFolderTest, KeepsFoldersThatOnlySoundLikeRuns) {
  fs::create_directory(folder / "run_scripts");
  {
    RunFolder results(folder.path());
    writeText(results.staged("summary.json"), "new");
    results.commit();
  }
  EXPECT_EQ(names(folder.path()), Names({"run_scripts", "summary.json"}));
}

TEST_F(RunFolderTest, RefusesAFileInItsPlace) {
  writeText(folder / "file", "");
  EXPECT_THROW(RunFolder(folder / "file"), polemcl::Error);
  EXPECT_THROW(RunFolder(folder / "file/below"), polemcl::Error);
}

TEST_F(RunFolderTest, WhatOthersCalledLikeARunStays) {
  for (const char* name : {"run_00.rawlog", "run_map.polemap", "run_1_notes.txt", "run_00.png"})
    writeText(folder / name, "mine");
  RunFolder(folder.path()).commit();
  EXPECT_EQ(names(folder.path()),
            Names({"run_00.png", "run_00.rawlog", "run_1_notes.txt", "run_map.polemap"}));
}

TEST_F(RunFolderTest, RefusesToReplaceAnInput) {
  const TempFolder other;
  const RunFolder results(folder.path());
  for (const char* name : {"run_00.tum", "config.ini", "summary.json", "timings.json"}) {
    EXPECT_REFUSED(results.protect(folder / name), name);
    EXPECT_NO_THROW(results.protect(other / name));
  }
  EXPECT_NO_THROW(results.protect(folder / "run_00.rawlog"));
  EXPECT_NO_THROW(results.protect(""));
}

TEST_F(RunFolderTest, FoldersInThePlaceOfResultsAreRefusedBeforeAnythingGoes) {
  for (const char* name : {"run_00.tum", "summary.json", "run_01.tum/mine"})
    writeText(folder / name, "old");
  {
    RunFolder results(folder.path());
    for (const char* name : {"run_00.tum", "run_01.tum", "summary.json"})
      writeText(results.staged(name), "new");
    EXPECT_REFUSED(results.commit(), "run_01.tum: is a folder");
  }
  EXPECT_EQ(names(folder.path()), Names({"run_00.tum", "run_01.tum", "summary.json"}));
  EXPECT_EQ(readText(folder / "run_00.tum"), "old");
  EXPECT_EQ(readText(folder / "summary.json"), "old");
}

TEST_F(RunFolderTest, LinksAndFilesInThePlaceOfFoldersAreRefusedBeforeAnythingGoes) {
  const TempFolder elsewhere;
  writeText(folder / "summary.json", "old");
  RunFolder results(folder.path());
  writeText(results.staged("run_00_scenes") / "000001.3Dscene", "new");
  fs::create_directory_symlink(elsewhere.path(), folder / "run_00_scenes");
  EXPECT_REFUSED(results.commit(),
                 "run_00_scenes: is a link, and a folder of results has to go there");
  fs::remove(folder / "run_00_scenes");
  writeText(folder / "run_00_scenes", "mine");
  EXPECT_REFUSED(results.commit(),
                 "run_00_scenes: is a file, and a folder of results has to go there");
  EXPECT_EQ(readText(folder / "run_00_scenes"), "mine");
  EXPECT_EQ(readText(folder / "summary.json"), "old");
}

}  // namespace
}  // namespace polemcl::test_run_folder
