#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/file/AtomicFile.h"
#include "support/DiskCalls.h"
#include "support/IoFiles.h"

namespace polemcl::test_atomic_file {
namespace {

using namespace polemcl::io::test;
using polemcl::io::AtomicFile;

using AtomicFileTest = FolderTest;
using testing_disk::DiskCalls;
using Names = std::vector<std::string>;

std::size_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST_F(AtomicFileTest, AppearsOnlyWhenCommitted) {
  AtomicFile file(path("out.bin"));
  file.stream() << "new\r\n";
  file.stream().flush();
  EXPECT_FALSE(fs::exists(path("out.bin")));
  EXPECT_EQ(file.temporaryPath().parent_path(), m_folder);
  EXPECT_EQ(file.temporaryPath().extension(), ".tmp");
  file.commit();
  EXPECT_EQ(read(path("out.bin")), "new\r\n");
  EXPECT_EQ(entries(m_folder), 1u);
}

TEST_F(AtomicFileTest, ReplacesWhatWasThere) {
  write("out", "a longer text of before");
  AtomicFile file(path("out"));
  file.stream() << "new";
  EXPECT_EQ(read(path("out")), "a longer text of before");
  file.commit();
  EXPECT_EQ(read(path("out")), "new");
}

TEST_F(AtomicFileTest, LeavesNothingBehindWhenNotCommitted) {
  write("out", "before");
  {
    AtomicFile file(path("out"));
    file.stream() << "half";
  }
  EXPECT_EQ(read(path("out")), "before");
  EXPECT_EQ(entries(m_folder), 1u);
}

TEST_F(AtomicFileTest, TwoWritersOfOneNameDoNotMix) {
  AtomicFile first(path("out")), second(path("out"));
  EXPECT_NE(first.temporaryPath(), second.temporaryPath());
  first.stream() << "first";
  second.stream() << "second";
  second.commit();
  first.commit();
  EXPECT_EQ(read(path("out")), "first");
  EXPECT_EQ(entries(m_folder), 1u);
}

TEST_F(AtomicFileTest, RemovesWhatAKilledProcessLeft) {
  // A process that ends without running destructors, as after SIGKILL.
  const auto killed = [&] {
    AtomicFile file(path("out"));
    file.stream() << "half" << std::flush;
    ::_exit(9);
  };
  EXPECT_EXIT(killed(), testing::ExitedWithCode(9), "");
  ASSERT_EQ(entries(m_folder), 1u);
  write("out.12-3.tmp.kept", "no temporary of ours");
  write("out.note-3.tmp", "nor this");
  AtomicFile other(path("other"));  // in the same folder: not its business
  EXPECT_EQ(entries(m_folder), 4u);
  AtomicFile underWay(path("out"));
  EXPECT_EQ(entries(m_folder), 4u) << "the leftover is gone, the new one is there";
  AtomicFile second(path("out"));
  EXPECT_TRUE(fs::exists(underWay.temporaryPath()));
}

TEST_F(AtomicFileTest, WhatOthersCalledLikeATemporaryStays) {
  write("out.2024-01-01.tmp", "mine");
  write("out.7-.tmp", "mine");
  write("out.8-1.tmp/thesis.txt", "mine");
  ASSERT_EQ(::mkfifo(path("out.9-1.tmp").c_str(), 0600), 0);  // nobody waits for its writer
  AtomicFile(path("out")).commit();
  EXPECT_EQ(testing_apps::names(m_folder),
            (std::vector<std::string>{"out", "out.2024-01-01.tmp", "out.7-.tmp", "out.8-1.tmp",
                                      "out.9-1.tmp"}));
  EXPECT_EQ(read(path("out.8-1.tmp/thesis.txt")), "mine");
}

TEST_F(AtomicFileTest, PassesOverATemporaryOfAnother) {
  // As on a file system of two machines: the next name, that of the last with its number plus one,
  // is there, and its owner is alive.
  fs::path next;
  {
    AtomicFile probe(path("out"));
    const std::string name = probe.temporaryPath().string();
    const auto dash = name.rfind('-');
    const int number = std::stoi(name.substr(dash + 1));
    next = name.substr(0, dash + 1) + std::to_string(number + 1) + ".tmp";
  }
  std::ofstream(next) << "of another";
  const int owner = ::open(next.c_str(), O_RDONLY);
  ASSERT_EQ(::flock(owner, LOCK_EX), 0);
  AtomicFile file(path("out"));
  EXPECT_NE(file.temporaryPath(), next);
  EXPECT_EQ(read(next), "of another");
  ::close(owner);
}

TEST_F(AtomicFileTest, FilesAppearTogether) {
  write("b", "before");
  {
    const io::AtomicFiles files;
    io::writeFile(path("a"), "1");
    io::writeFile(path("b"), "2");
    EXPECT_FALSE(fs::exists(path("a")));
  }
  EXPECT_EQ(entries(m_folder), 1u);
  EXPECT_EQ(read(path("b")), "before");
  {
    io::AtomicFiles files;
    io::writeFile(path("a"), "1");
    io::writeFile(path("b"), "2");
    files.commit();
    EXPECT_EQ(read(path("a")) + read(path("b")), "12");
    EXPECT_NE(messageOf([] { io::AtomicFiles(); }), "no error");
  }
  EXPECT_EQ(entries(m_folder), 2u);
  io::writeFile(path("c"), "3");
  EXPECT_EQ(read(path("c")), "3");
}

TEST_F(AtomicFileTest, TheContentIsOnTheDiskBeforeTheNameAndThenTheFolder) {
  AtomicFile file(path("out"));
  const std::string temporary = file.temporaryPath().filename();
  const DiskCalls calls;
  file.commit();
  EXPECT_EQ(calls.all(),
            Names({"sync " + temporary, "rename out", "sync " + m_folder.filename().string()}));
}

TEST_F(AtomicFileTest, FilesThatAppearTogetherAreAllOnTheDiskBefore) {
  AtomicFile a(path("a")), b(path("b"));
  const Names temporaries{a.temporaryPath().filename(), b.temporaryPath().filename()};
  io::AtomicFiles files;
  const DiskCalls calls;
  a.commit();
  b.commit();
  files.commit();
  const std::string sync = "sync " + m_folder.filename().string();
  EXPECT_EQ(calls.all(), Names({"sync " + temporaries[0], "sync " + temporaries[1],
                                "rename a, locked", sync, "rename b, locked", sync}))
      << "and no other program renames meanwhile";
}

TEST_F(AtomicFileTest, FilesThatAppearTogetherNeverStandBesideEarlierOnes) {
  for (const char* name : {"a", "b"}) write(name, "before");
  AtomicFile a(path("a")), b(path("b"));
  io::AtomicFiles files;
  a.commit();
  b.commit();
  fs::remove(path("b"));
  fs::create_directory(path("b"));  // so that its name cannot be given
  EXPECT_REFUSED(files.commit(), path("b").string() + ": Is a directory");
  EXPECT_FALSE(fs::exists(path("a")));
}

TEST_F(AtomicFileTest, OfFilesThatAppearTogetherTheEarlierSideFilesGoFirst) {
  for (const char* name : {"a", "b"}) write(name, "before");
  AtomicFile a(path("a")), b(path("b"));
  io::AtomicFiles files;
  a.commit();
  b.commit();
  const DiskCalls calls;
  files.commit();
  const std::string sync = "sync " + m_folder.filename().string();
  EXPECT_EQ(calls.all(), Names({sync, "rename b, locked", sync, "rename a, locked", sync}));
}

TEST_F(AtomicFileTest, ADiskThatFailsIsAnErrorAndChangesNothing) {
  write("out", "before");
  {
    AtomicFile file(path("out"));
    file.stream() << "new";
    DiskCalls calls;
    calls.failSync = EIO;
    EXPECT_REFUSED(file.commit(), path("out").string() + ": Input/output error");
    EXPECT_TRUE(calls.of("rename").empty());
  }
  EXPECT_EQ(read(path("out")), "before");
  EXPECT_EQ(entries(m_folder), 1u);
}

TEST_F(AtomicFileTest, TakesAnotherNameWhenTheFirstIsTakenForALeftover) {
  DiskCalls calls;
  calls.othersLocks = 1;
  const AtomicFile file(path("out"));
  EXPECT_TRUE(io::PathLock(file.temporaryPath()).isOfAnother());
  EXPECT_EQ(entries(m_folder), 2u);
}

TEST_F(AtomicFileTest, KeepsALinkAndReplacesWhatItNames) {
  write("real/out", "before");
  fs::create_symlink(path("real/out"), path("link"));
  AtomicFile file(path("link"));
  file.stream() << "new";
  file.commit();
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read(path("real/out")), "new");
  EXPECT_EQ(entries(path("real")), 1u);
}

TEST_F(AtomicFileTest, PermissionsFollowTheUmask) {
  const mode_t before = ::umask(027);
  AtomicFile file(path("out"));
  file.commit();
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat(path("out").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST_F(AtomicFileTest, RefusesBadInput) {
  EXPECT_REFUSED(AtomicFile(path("no/out")), path("no/out").string(), "No such file or directory");
  EXPECT_REFUSED(AtomicFile(path(std::string(300, 'x'))), "File name too long");
  EXPECT_REFUSED(AtomicFile(m_folder), m_folder.string(), "folder");
  EXPECT_EQ(entries(m_folder), 0u);
  EXPECT_REFUSED(AtomicFile(path("no") / ""), "names no file");
  EXPECT_REFUSED(AtomicFile("/dev/null"), "/dev/null", "device");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, RefusesASecondCommit) {
  AtomicFile file(path("out"));
  file.commit();
  EXPECT_REFUSED(file.commit(), path("out").string(), "commit");
}

TEST_F(AtomicFileTest, FullDiskIsAnErrorAndChangesNothing) {
  write("out", "before");
  {
    AtomicFile file(path("out"));
    const FileSizeLimit limit(4096);
    file.stream() << std::string(100000, 'x');
    EXPECT_REFUSED(file.commit(), path("out").string(), "nothing was changed");
  }
  EXPECT_EQ(read(path("out")), "before");
  EXPECT_EQ(entries(m_folder), 1u);
}

TEST_F(AtomicFileTest, FullDiskIsNoticedWhenOnlyTheLastBytesDoNotFit) {
  {
    AtomicFile file(path("out"));
    const FileSizeLimit limit(2);
    file.stream() << "abc";  // still in the buffer
    EXPECT_TRUE(file.stream().good());
    EXPECT_REFUSED(file.commit(), "File too large");
  }
  EXPECT_EQ(entries(m_folder), 0u);
}

}  // namespace
}  // namespace polemcl::test_atomic_file
