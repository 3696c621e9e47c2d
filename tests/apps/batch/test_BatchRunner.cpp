#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

#include "batch/BatchRunner.h"
#include "support/BatchTestFiles.h"
#include "support/DiskCalls.h"

namespace polemcl::test_batch_runner {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

using Names = std::vector<std::string>;
using State = BatchFolder::State;

/// Tasks of shell scripts that stand in for the programs, in a batch of their own.
class BatchRunner : public testing::Test {
 protected:
  BatchRunner() : m_batch(m_temporary / "batch") {
    fs::create_directories(m_temporary / "bin");
    // Writes its second argument, and what the file of the third holds, to the first.
    addProgram("write",
               "echo \"$2\" > \"$1\"; [ -z \"$3\" ] || cat \"$3\" >> \"$1\"; echo aside > other");
    addProgram("fail", "echo one; echo 'no scan in it' >&2; echo 'Try `fail --help`.'; exit 1");
    addProgram("die", "kill -9 $$");
    addProgram("silent", "exit 3");
    ::setenv("POLEMCL_BIN", (m_temporary / "bin").c_str(), 1);
    writeText(m_temporary / "batch.ini", "[batch]\n");
    m_plan.name = "made-up";
    m_batch.take("made-up", false);
  }
  ~BatchRunner() override { ::unsetenv("POLEMCL_BIN"); }

  void addProgram(const std::string& name, const std::string& script) {
    writeText(m_temporary / "bin" / name, "#!/bin/sh\n" + script + "\n");
    fs::permissions(m_temporary / "bin" / name, fs::perms::owner_all);
  }

  std::string at(const std::string& name) const { return m_temporary / name; }
  void addPipe(const std::string& name) { ASSERT_EQ(::mkfifo(at(name).c_str(), 0600), 0); }

  void add(const std::string& id, const std::vector<Names>& commands, const Names& needs = {}) {
    BatchTask task;
    task.id = id;
    task.kind = TaskKind::run;
    task.commands = commands;
    task.needs = needs;
    task.outputs = {"out"};
    task.key = "key of " + id;
    m_plan.tasks.push_back(task);
  }

  /// \return The ids of the tasks that were worked on, in that order.
  Names run(std::size_t jobs = 2) {
    m_batch.store(m_plan, m_temporary / "batch.ini");
    Names worked;
    const OpenTasks open = openTasks(m_batch, m_plan);
    for (const BatchTask* task : open.outdated) m_batch.remove(*task);
    m_failures = runBatch(m_batch, open.tasks, m_plan.tasks.size(), {jobs, m_imports},
                          [&](const BatchTask& task, const TaskOutcome&, const BatchProgress& now) {
                            worked.push_back(task.id);
                            m_last = now;
                          });
    return worked;
  }

  std::string out(const std::string& id) const { return readText(m_batch.work(id) / "out"); }

  TempFolder m_temporary;
  BatchFolder m_batch;
  BatchPlan m_plan;
  std::size_t m_imports = 0;
  std::map<std::string, std::string> m_failures;
  BatchProgress m_last;
};

TEST_F(BatchRunner, DoesWhatIsNeededFirst) {
  add("a", {{"write", "out", "A"}});
  add("b", {{"write", "out", "B", "../a/out"}}, {"a"});
  add("c", {{"write", "out", "C", "../b/out"}}, {"b", "a"});
  EXPECT_EQ(run(4), (Names{"a", "b", "c"}));
  EXPECT_TRUE(m_failures.empty());
  EXPECT_EQ(out("c"), "C\nB\nA\n");
  EXPECT_EQ(m_last.done, 3u);
  EXPECT_EQ(m_last.all, 3u);
}

TEST_F(BatchRunner, KeepsOutputsAlone) {
  add("a", {{"write", "out", "A"}});
  run();
  EXPECT_TRUE(fs::exists(m_batch.work("a") / "out"));
  EXPECT_FALSE(fs::exists(m_batch.work("a") / "other"));
  for (const auto& entry : fs::directory_iterator(m_batch.path() / "tasks"))
    EXPECT_EQ(entry.path().filename(), "a");
}

TEST_F(BatchRunner, AFailureStopsOnlyWhatNeedsIt) {
  add("a", {{"write", "out", "A"}, {"fail"}});
  add("b", {{"write", "out", "B", "../a/out"}}, {"a"});
  add("c", {{"write", "out", "C", "../b/out"}}, {"b"});
  add("d", {{"write", "out", "D"}});
  run(1);
  EXPECT_EQ(m_failures.size(), 1u);
  EXPECT_EQ(m_last.failed, 3u);
  EXPECT_EQ(m_failures["a"], "no scan in it");
  EXPECT_EQ(out("d"), "D\n");
  EXPECT_FALSE(fs::exists(m_batch.work("a")));
  EXPECT_EQ(m_batch.failure("a"), "no scan in it");
  EXPECT_NE(readText(m_batch.log("a")).find("$ fail\none\n"), std::string::npos);
  m_batch.store(m_plan, m_temporary / "batch.ini");  // the next attempt has failures of its own
  EXPECT_EQ(m_batch.failure("a"), "");
  // Mended, it is done, and what needs it.
  m_plan.tasks[0].commands = {{"write", "out", "A"}};
  EXPECT_EQ(run(1), (Names{"a", "b", "c"}));
  EXPECT_TRUE(m_failures.empty());
  EXPECT_EQ(m_batch.failure("a"), "");
}

TEST_F(BatchRunner, SaysHowProgramsEnded) {
  add("killed", {{"die"}});
  add("silent", {{"silent"}});
  add("none", {{"no-such-program"}});
  add("lazy", {{"write", "somewhere", "A"}});
  run();
  EXPECT_NE(m_failures["killed"].find("ended by signal 9"), std::string::npos);
  EXPECT_EQ(m_failures["silent"], "silent ended with exit code 3");
  EXPECT_NE(m_failures["none"].find("no-such-program: cannot be started"), std::string::npos);
  EXPECT_EQ(m_failures["lazy"], "it did not write out");
}

TEST_F(BatchRunner, DoesNothingTwice) {
  add("a", {{"write", "out", "A"}});
  add("b", {{"write", "out", "B", "../a/out"}}, {"a"});
  run();
  EXPECT_EQ(run(), Names{});
  EXPECT_EQ(m_last.done, 2u);
}

TEST_F(BatchRunner, OtherSettingsAreDoneAgain) {
  add("a", {{"write", "out", "A"}});
  add("b", {{"write", "out", "B", "../a/out"}}, {"a"});
  add("c", {{"write", "out", "C"}});
  run();
  m_plan.tasks[0].key = "another";
  m_plan.tasks[0].commands = {{"write", "out", "other"}};
  const OpenTasks open = openTasks(m_batch, m_plan);
  EXPECT_EQ(open.tasks, (std::vector<const BatchTask*>{&m_plan.tasks[0], &m_plan.tasks[1]}));
  EXPECT_EQ(open.outdated, std::vector<const BatchTask*>{&m_plan.tasks[1]});
  EXPECT_EQ(out("b"), "B\nA\n");  // asking removes nothing
  EXPECT_EQ(run(), (Names{"a", "b"}));
  EXPECT_EQ(out("b"), "B\nother\n");
}

TEST_F(BatchRunner, DamagedOutputsAreDoneAgain) {
  add("a", {{"write", "out", "A"}});
  add("b", {{"write", "out", "B", "../a/out"}}, {"a"});
  add("c", {{"write", "out", "C"}});
  run();
  writeText(m_batch.work("a") / "out", "B\n");  // as long as it was
  std::string why;
  EXPECT_EQ(m_batch.state(m_plan.task("a"), &why), State::damaged);
  EXPECT_NE(why.find("/tasks/a/out is not what was written"), std::string::npos);
  EXPECT_EQ(run(), (Names{"a", "b"}));
  EXPECT_EQ(out("b"), "B\nA\n");
  fs::remove(m_batch.work("c") / "out");
  EXPECT_EQ(run(), Names{"c"});
  writeText(m_batch.work("c") / "done.json", "{\"key\": \"key of c\", \"outputs\": []}");
  EXPECT_EQ(run(), Names{"c"});
  fs::remove(m_batch.work("c") / "done.json");
  fs::create_directories(m_batch.work("c") / "done.json");
  EXPECT_EQ(run(), Names{"c"});
  writeText(m_batch.work("c") / "done.json", "{");
  EXPECT_EQ(m_batch.state(m_plan.task("c")), State::damaged);
  EXPECT_EQ(run(), Names{"c"});
  for (const std::string damaged :
       {"{\"key\": 1, \"outputs\": []}", "{\"key\": \"key of c\", \"outputs\": [{}]}",
        "{\"key\": \"key of c\", \"build\": [], \"outputs\": []}",
        "{\"key\": \"key of c\", \"outputs\": [{\"file\": 1, \"bytes\": 2, \"crc32\": 3}]}"}) {
    writeText(m_batch.work("c") / "done.json", damaged);
    EXPECT_EQ(m_batch.state(m_plan.task("c"), &why), State::damaged) << damaged;
    EXPECT_NE(why.find("c/done.json is not what was written"), std::string::npos) << why;
    EXPECT_EQ(run(), Names{"c"}) << damaged;
  }
}

TEST_F(BatchRunner, HalfOfATaskNeverHasItsName) {
  add("a", {{"write", "out", "A"}});
  run();
  const testing_disk::DiskCalls calls;
  m_batch.remove(m_plan.tasks[0]);
  ASSERT_EQ(calls.of("rename a.").size(), 1u);
  EXPECT_NE(calls.all()[0].find(".part"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(m_batch.path() / "tasks"));
  EXPECT_NO_THROW(m_batch.remove(m_plan.tasks[0])) << "nothing is there";
}

TEST_F(BatchRunner, RemainsOfTasksCutShortGo) {
  add("a", {{"write", "out", "A"}});
  fs::create_directories(m_batch.path() / "tasks" / "a.elsewhere-12.part");
  run();
  EXPECT_FALSE(fs::exists(m_batch.path() / "tasks" / "a.elsewhere-12.part"));
  EXPECT_EQ(out("a"), "A\n");
}

TEST_F(BatchRunner, ATaskDoneElsewhereMeanwhileStays) {
  add("a", {{"write", "out", "A"}});
  m_batch.store(m_plan, m_temporary / "batch.ini");
  const auto staged = m_batch.stage(m_plan.tasks[0]);
  writeText(staged / "out", "A\n");
  run();
  EXPECT_TRUE(fs::exists(m_batch.work("a") / "out"));
  const auto late = m_batch.stage(m_plan.tasks[0]);
  writeText(late / "out", "A\n");
  EXPECT_NO_THROW(m_batch.commit(m_plan.tasks[0], late));
  EXPECT_EQ(m_batch.state(m_plan.tasks[0]), State::done);
  EXPECT_FALSE(fs::exists(late));
}

TEST_F(BatchRunner, TasksRunAtTheSameTime) {
  // Each hears of the other one by a pipe.
  for (const char* pipe : {"x", "y"}) addPipe(pipe);
  addProgram("meet", "timeout 60 sh -c \"echo met > $2\" & timeout 60 cat $1 > out");
  add("a", {{"meet", at("x"), at("y")}});
  add("b", {{"meet", at("y"), at("x")}});
  run(2);
  EXPECT_TRUE(m_failures.empty());
}

TEST_F(BatchRunner, AsManyImportsAsAllowed) {
  // The first goes on until d has run, so that the one beside it is another import or d.
  addPipe("d_has_run");
  addProgram("alone",
             "mkdir ../../under_way && { [ $1 != a ] || timeout 60 cat $2; } && "
             "rmdir ../../under_way && echo $1 > out");
  for (const char* id : {"a", "b", "c"}) {
    add(id, {{"alone", id, at("d_has_run")}});
    m_plan.tasks.back().kind = TaskKind::poles;
  }
  addProgram("tell", "timeout 60 sh -c \"echo run > $1\" && echo D > out");
  add("d", {{"tell", at("d_has_run")}});
  m_imports = 1;
  EXPECT_EQ(run(2).size(), 4u);
  EXPECT_TRUE(m_failures.empty()) << m_failures.begin()->second;
}

/// Ends a test's child process with exit code 0 when a batch of 64 jobs is done in little memory.
TEST_F(BatchRunner, DoesWithFewerThreadsWhereMemoryIsShort) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space";
#endif
  addProgram("one", "echo 1 > out");
  add("a", {{"one"}});
  const auto inLittleMemory = [this] {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (rlim_t{64} << 20);
    const rlimit limit = {most, most};
    ::setrlimit(RLIMIT_AS, &limit);
    run(64);
    ::_exit(m_failures.empty() ? 0 : 1);
  };
  EXPECT_EXIT(inLittleMemory(), ::testing::ExitedWithCode(0), "");
}

TEST(BatchFolder, IsForOneBatchAlone) {
  const TempFolder folder;
  const fs::path path = folder / "batch";
  writeText(folder / "batch.ini", "[batch]\n");
  BatchPlan plan;
  plan.name = "one";
  plan.tasks = {BatchTask({TaskKind::poles, {"a"}})};
  {
    BatchFolder first(path);
    first.take("one", false);
    first.store(plan, folder / "batch.ini");
    EXPECT_REFUSED(BatchFolder(path).take("one", true), "is under way");
  }
  EXPECT_REFUSED(BatchFolder(path).take("one", false), "--resume");
  EXPECT_REFUSED(BatchFolder(path).take("two", true), "holds the batch 'one', not 'two'");
  EXPECT_NO_THROW(BatchFolder(path).take("one", true));
  // Cut short before its plan was written, and one that lost it.
  fs::remove(path / "plan.json");
  EXPECT_NO_THROW(BatchFolder(path).take("one", true));
  EXPECT_NO_THROW(BatchFolder(path).take("one", false));
  writeText(path / "plan.json", "nonsense");
  EXPECT_NO_THROW(BatchFolder(path).take("one", true));
}

TEST(BatchFolder, LeavesForeignFoldersAlone) {
  const TempFolder folder;
  writeText(folder / "letter.txt", "Dear");
  EXPECT_REFUSED(BatchFolder(folder.path()).take("one", true), "holds no batch");
  EXPECT_REFUSED(BatchFolder(folder / "letter.txt").take("one", true), "holds no batch");
  EXPECT_EQ(readText(folder / "letter.txt"), "Dear");
  writeText(folder / ".lock", "");  // of another program
  EXPECT_REFUSED(BatchFolder(folder.path()).take("one", false), "holds no batch");
}

TEST(BatchFolder, OfSomebodyElseDoesNotLeadOutOfIt) {
  const TempFolder folder;
  writeText(folder / "batch.ini", "[batch]\n");
  const fs::path path = folder / "batch";
  {
    BatchFolder begun(path);
    begun.take("one", false);
    begun.store(BatchPlan(), folder / "batch.ini");
  }
  for (const char* name : {"results.json.part", "times/task", "tasks/run.a.b.00"}) {
    fs::create_symlink(folder / "batch.ini", path / name);
    EXPECT_REFUSED(BatchFolder{path}, (path / name).string() + ": is a link");
    fs::remove(path / name);
  }
  EXPECT_NO_THROW(BatchFolder{path});
  fs::remove(path / "plan.json");  // cut short
  fs::remove(path / "batch.ini");
  fs::create_symlink(folder / "batch.ini", path / "batch.ini");
  EXPECT_REFUSED(BatchFolder{path}, "batch/batch.ini: is a link");
}

TEST_F(BatchRunner, SaysWhichBuildDidWhatIsDoneAgain) {
  add("a", {{"write", "out", "A"}});
  add("b", {{"write", "out", "B"}});
  m_plan.build = buildIdentity();
  EXPECT_EQ(run(1), (Names{"a", "b"}));
  EXPECT_EQ(m_batch.buildOf(m_plan.tasks[0]), buildIdentity());
  EXPECT_TRUE(openTasks(m_batch, m_plan).tasks.empty());

  // Another build gives the tasks other keys, see BatchPlan.
  m_plan.build = "0123456789ab, GNU 12.2.0, Debug, -g";
  for (BatchTask& task : m_plan.tasks) task.key += " of another build";
  const OpenTasks open = openTasks(m_batch, m_plan);
  EXPECT_EQ(open.tasks.size(), 2u);
  EXPECT_TRUE(open.outdated.empty());  // their keys tell them apart
  ASSERT_EQ(open.notes.size(), 1u);
  EXPECT_EQ(open.notes[0], std::string("2 tasks were done by another build (") + buildIdentity() +
                               ") and are done again; this is " + m_plan.build);
  EXPECT_EQ(run(1), (Names{"a", "b"}));
}

}  // namespace
}  // namespace polemcl::test_batch_runner
