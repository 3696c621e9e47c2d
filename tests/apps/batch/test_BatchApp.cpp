#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>

#include "batch/BatchApp.h"
#include "batch/BatchFolder.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "support/BatchTestFiles.h"

namespace polemcl::test_batch_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

const std::string program = std::string(POLEMCL_BIN_DIR) + "/pole-batch";

/// The programs, of which one only says that it has started, and goes on until it is ended.
class HeldPrograms {
 public:
  HeldPrograms(const fs::path& folder, const std::string& name) : m_folder(folder) {
    fs::create_directories(folder);
    for (const auto& entry : fs::directory_iterator(POLEMCL_BIN_DIR))
      if (entry.path().filename() != name)
        fs::create_symlink(entry.path(), folder / entry.path().filename());
    const std::string said = folder / "said", never = folder / "never";
    EXPECT_EQ(::mkfifo(said.c_str(), 0600) + ::mkfifo(never.c_str(), 0600), 0);
    m_said = ::open(said.c_str(), O_RDONLY | O_NONBLOCK);
    // Its own end of the pipe stays open until the process ends; nobody writes to the other one.
    writeText(folder / name,
              "#!/bin/sh\nexec 3>'" + said + "'\necho >&3\nread word <'" + never + "'\n");
    fs::permissions(folder / name, fs::perms::owner_all);
  }
  ~HeldPrograms() { ::close(m_said); }
  const fs::path& folder() const { return m_folder; }

  bool waitForStart() const {
    char newline = 0;
    return happens(POLLIN) && ::read(m_said, &newline, 1) == 1;
  }
  bool waitForEnd() const { return happens(POLLHUP); }

 private:
  /// \return False when it does not happen within a minute.
  bool happens(short event) const {
    pollfd pipe{m_said, event, 0};
    return ::poll(&pipe, 1, 60000) == 1 && (pipe.revents & event) != 0;
  }

  fs::path m_folder;
  int m_said = -1;
};

/// A street's batch, done once for all tests.
class BatchApp : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    s_folder = new TempFolder;
    writeStreetBatch(*s_folder);
    BatchOptions options = optionsFor("done");
    options.jobs = 2;
    doBatch(options);
  }
  static void TearDownTestSuite() {
    delete s_folder;
    s_folder = nullptr;
  }

  static BatchOptions optionsFor(const std::string& output) {
    BatchOptions options;
    options.batch = *s_folder / "street-batch.ini";
    options.output = *s_folder / output;
    options.quiet = true;
    return options;
  }
  /// All that a batch leaves but for what may differ: times, logs, locks.
  static std::map<std::string, std::string> left(const std::string& output) {
    auto all = contents(*s_folder / output, "times/");
    for (auto file = all.begin(); file != all.end();)
      file = file->first.rfind("logs/", 0) == 0 || file->first.rfind("slurm/", 0) == 0 ||
                     file->first == ".lock" || file->first == "report.html" ||
                     file->first == "timings.json"
                 ? all.erase(file)
                 : std::next(file);
    return all;
  }

  static TempFolder* s_folder;
};

TempFolder* BatchApp::s_folder = nullptr;

TEST_F(BatchApp, ReportsAllRuns) {
  const auto results = resultsIn(*s_folder / "done");
  EXPECT_EQ(results["name"], "street-batch");
  ASSERT_EQ(results["settings"].size(), 2u);
  ASSERT_EQ(results["sessions"].size(), 3u);
  EXPECT_TRUE(results["failures"].empty());
  EXPECT_EQ(results["sessions"][1]["date"], "2026-02-01");
  EXPECT_NEAR(results["sessions"][0]["length_m"], 120, 5);  // in one lane of a bent street
  for (const char* configuration : {"kept", "once"})
    for (const char* session : {"s1", "s2"}) {
      const auto result = resultOf(results, configuration, session);
      ASSERT_EQ(result["runs"].size(), 2u);
      EXPECT_GT(result["map_poles"], 10);
      EXPECT_GT(result["plots"]["truth_xy"].size(), 2u);
      std::size_t poses = 0, counted = 0;
      for (const auto& run : result["runs"]) {
        EXPECT_EQ(run["failure"], "");
        EXPECT_GT(run["errors"]["pos_mean"], 0);
        EXPECT_LT(run["errors"]["pos_mean"], 0.1);
        const auto& health = run["health"];
        EXPECT_EQ(health["ok"].get<double>() + health["degraded"].get<double>() +
                      health["lost"].get<double>(),
                  1);
        poses += run["errors"]["poses"].get<std::size_t>();
      }
      for (const std::size_t count : result["plots"]["position_histogram"]) counted += count;
      EXPECT_EQ(counted, poses);
      EXPECT_NE(result["runs"][0]["seed"], result["runs"][1]["seed"]);
    }
  EXPECT_TRUE(resultOf(results, "kept", "s0")["runs"].empty());  // the map's own session
  for (const char* file : {"report.html", "runs.csv", "sessions.csv", "table.tex"})
    EXPECT_GT(fs::file_size(*s_folder / "done" / file), 100u) << file;
}

TEST_F(BatchApp, FiguresAreThoseOfTheRuns) {
  const auto summary =
      nlohmann::json::parse(readText(*s_folder / "done/tasks/run.kept.s2.01/out/summary.json"));
  const auto result = resultOf(resultsIn(*s_folder / "done"), "kept", "s2");
  EXPECT_NEAR(result["runs"][1]["errors"]["pos_mean"], summary["runs"][0]["pos_mean"], 1e-6);
}

TEST_F(BatchApp, BytesDependOnNothingElse) {
  BatchOptions options = optionsFor("other");
  options.jobs = 3;
  doBatch(options);
  EXPECT_EQ(left("other"), left("done"));
}

TEST_F(BatchApp, GoesOnAfterItWasKilled) {
  const fs::path output = *s_folder / "killed";
  HeldPrograms held(*s_folder / "held", "pole-localize");
  const pid_t child = ::fork();
  if (child == 0) {
    ::setenv("POLEMCL_BIN", held.folder().c_str(), 1);
    ::execl(program.c_str(), "pole-batch", (*s_folder / "street-batch.ini").c_str(), "--output",
            output.c_str(), "--jobs", "1", "--quiet", nullptr);
    ::_exit(127);
  }
  EXPECT_TRUE(held.waitForStart());
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(held.waitForEnd()) << "a child goes on";
  EXPECT_FALSE(fs::exists(output / "results.json"));
  const auto before = contents(output / "tasks", ".part");
  ASSERT_FALSE(before.empty());
  ASSERT_LT(before.size(), contents(*s_folder / "done/tasks").size());
  BatchOptions options = optionsFor("killed");
  EXPECT_NE(messageOf([&] { doBatch(options); }).find("--resume"), std::string::npos);
  options.resume = true;
  doBatch(options);
  EXPECT_EQ(left("killed"), left("done"));
}

TEST_F(BatchApp, FailedSessionsAreReportedAndStopNoOthers) {
  std::string text = readText(*s_folder / "street-batch.ini");
  const std::string good = "set = world.day=2";
  text.replace(text.find(good), good.size(), "source = poles\ninput = broken.rawlog");
  writeText(*s_folder / "broken.rawlog", "nothing");
  writeText(*s_folder / "broken.tum", "0 0 0 0 0 0 0 1\n");
  writeText(*s_folder / "broken.ini", text);
  BatchOptions options = optionsFor("broken");
  options.batch = *s_folder / "broken.ini";
  testing::internal::CaptureStderr();
  const std::string message = messageOf([&] { doBatch(options); });
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(message.find("4 of 14 tasks failed (run.kept.s2.00: "), std::string::npos) << message;
  EXPECT_HAS(message, "with the tasks that need them, 4 are not done");
  EXPECT_NE(said.find("run.once.s2.00 failed: "), std::string::npos) << said;
  const auto results = resultsIn(*s_folder / "broken");
  EXPECT_EQ(results["failures"].size(), 4u);
  EXPECT_NE(resultOf(results, "once", "s2")["runs"][0]["failure"], "");
  EXPECT_EQ(resultOf(results, "once", "s1")["runs"][0]["failure"], "");
}

TEST_F(BatchApp, ASessionWithoutReadableTruthIsReportedAlone) {
  for (const char* name : {"s0", "s1", "s2"}) {
    const fs::path from = *s_folder / "done/tasks" / (std::string("poles.") + name);
    for (const char* end : {".rawlog", ".tum"})
      fs::copy_file(from / (std::string(name) + end), *s_folder / (std::string(name) + end),
                    fs::copy_options::overwrite_existing);
  }
  std::string truth = readText(*s_folder / "s2.tum");
  truth.replace(truth.find('\n') + 1, 3, "nan");
  writeText(*s_folder / "s2.tum", truth);
  std::string text = readText(*s_folder / "street-batch.ini");
  for (const char* gone : {"set = world.day=1\n", "set = world.day=2\n"})
    text.erase(text.find(gone), std::string(gone).size());
  const std::string source = "source = simulated\ninput = street.ini";
  text.replace(text.find(source), source.size(), "source = poles\ninput = {session}.rawlog");
  writeText(*s_folder / "truth.ini", text);
  BatchOptions options = optionsFor("truth");
  options.batch = *s_folder / "truth.ini";
  testing::internal::CaptureStderr();
  const std::string message = messageOf([&] { doBatch(options); });
  testing::internal::GetCapturedStderr();
  EXPECT_NE(message.find("s2.tum:2: 'nan"), std::string::npos) << message;
  const auto results = resultsIn(*s_folder / "truth");
  EXPECT_NE(resultOf(results, "once", "s2")["runs"][0]["failure"], "");
  EXPECT_EQ(resultOf(results, "once", "s1")["runs"][0]["failure"], "");
  EXPECT_TRUE(fs::exists(*s_folder / "truth/report.html"));
}

TEST_F(BatchApp, WithoutItsPackagesTheReportAloneIsMissing) {
  fs::copy(*s_folder / "done", *s_folder / "bare", fs::copy_options::recursive);
  for (const char* file : {"report.html", "table.tex", "results.json", "runs.csv"})
    fs::remove(*s_folder / "bare" / file);
  // results.json must not be seen before it is complete.
  const fs::path seen = *s_folder / "seen.txt";
  writeText(*s_folder / "python/matplotlib.py",
            "import os\nopen('" + seen.string() + "', 'w').write(' '.join(os.listdir('" +
                (*s_folder / "bare").string() + "')))\nraise ImportError('No Matplotlib here')\n");
  ::setenv("PYTHONPATH", (*s_folder / "python").c_str(), 1);
  BatchOptions options = optionsFor("bare");
  options.resume = true;
  const std::string message = messageOf([&] { doBatch(options); });
  ::unsetenv("PYTHONPATH");
  EXPECT_EQ(message.rfind("report.html, table.tex, the CSV files and `summary` of results.json are "
                          "not written, all other results are: No Matplotlib here; install the "
                          "packages python3-jinja2 and python3-matplotlib; ",
                          0),
            0u)
      << message;
  EXPECT_HAS(readText(seen), "timings.json");
  EXPECT_EQ(readText(seen).find("results.json"), std::string::npos);
  EXPECT_FALSE(fs::exists(*s_folder / "bare/report.html"));
  EXPECT_FALSE(fs::exists(*s_folder / "bare/runs.csv"));
  EXPECT_EQ(resultsIn(*s_folder / "bare")["results"].size(), 6u);
  doBatch(options);
  EXPECT_EQ(left("bare"), left("done"));
  EXPECT_EQ(readText(*s_folder / "bare/timings.json"), readText(*s_folder / "done/timings.json"));
}

TEST_F(BatchApp, TasksDoneByHandNeedTheSettingsOfTheBatch) {
  fs::copy(*s_folder / "done", *s_folder / "hand", fs::copy_options::recursive);
  fs::remove_all(*s_folder / "hand/tasks/run.once.s1.00");
  const std::vector<std::string> task{"--output", (*s_folder / "hand").string(), "--task",
                                      "run.once.s1.00"};
  const std::string settings = readText(*s_folder / "hand/settings/once.ini");
  writeText(*s_folder / "hand/settings/once.ini", settings + "\n# edited\n");
  expectFailure(runProgram(batchMain, task), {"once.ini", "has changed since the batch began"});
  writeText(*s_folder / "hand/settings/once.ini", settings);
  EXPECT_EQ(runProgram(batchMain, task).code, 0);
  EXPECT_EQ(left("hand"), left("done"));
}

TEST_F(BatchApp, ATaskByHandNeedsMapsOfTheSameSettings) {
  fs::copy(*s_folder / "done", *s_folder / "newer", fs::copy_options::recursive);
  BatchPlan plan = readPlan(*s_folder / "newer/plan.json");
  for (BatchTask& task : plan.tasks)
    if (task.kind != TaskKind::poles) task.key += " of other settings";
  writePlan(*s_folder / "newer/plan.json", plan);
  expectFailure(runProgram(batchMain, {"--output", (*s_folder / "newer").string(), "--task",
                                       "run.once.s1.00"}),
                {"run.once.s1.00: needs a task that is not done with the settings of now"});
}

// An old page would tell of other settings.
TEST_F(BatchApp, ResultsGoBeforeNewOnesCome) {
  fs::copy(*s_folder / "done", *s_folder / "stale", fs::copy_options::recursive);
  writeText(*s_folder / "python/matplotlib.py", "raise ImportError('No Matplotlib here')\n");
  ::setenv("PYTHONPATH", (*s_folder / "python").c_str(), 1);
  BatchOptions options = optionsFor("stale");
  options.resume = true;
  options.set = {"batch.runs=1", "setting once.set=filter.particles=100"};
  EXPECT_NE(messageOf([&] { doBatch(options); }), "");
  ::unsetenv("PYTHONPATH");
  EXPECT_FALSE(fs::exists(*s_folder / "stale/report.html"));
  EXPECT_TRUE(fs::exists(*s_folder / "stale/results.json"));
}

TEST_F(BatchApp, ARunThatCannotBeComparedIsReportedAlone) {
  BatchOptions options = optionsFor("sparse");
  // Scans 2.5 s apart: there is no estimate at most of the metres.
  options.set = {"batch.runs=1",
                 "batch.settings=once",
                 "batch.errors=metre",
                 "sessions.names=s0 s1",
                 "setting once.sessions=s1",
                 "session s1.set=world.day=1 simulation.speed_m_s=1 simulation.spacing_m=2.5"};
  testing::internal::CaptureStderr();
  const std::string message = messageOf([&] { doBatch(options); });
  testing::internal::GetCapturedStderr();
  EXPECT_NE(message.find("run.once.s1.00: "), std::string::npos) << message;
  const auto results = resultsIn(*s_folder / "sparse");
  EXPECT_NE(resultOf(results, "once", "s1")["runs"][0]["failure"], "");
  EXPECT_TRUE(fs::exists(*s_folder / "sparse/report.html"));
}

TEST_F(BatchApp, RefusesWrongUsage) {
  expectUsageError(runProgram(batchMain, {}));
  expectUsageError(runProgram(batchMain, {"a.ini"}));
  expectUsageError(runProgram(batchMain, {"a.ini", "--output", "o", "--task", "x"}));
  for (const char* other : {"--dry-run", "--resume", "--slurm"})
    expectUsageError(runProgram(batchMain, {"--output", "o", "--task", "x", other}));
  expectUsageError(runProgram(batchMain, {"a.ini", "--output", "o", "--sbatch", "x"}));
  expectFailure(runProgram(batchMain, {"/not/there.ini", "--output", "o"}), {"/not/there.ini"});
  expectFailure(runProgram(batchMain, {"--output", (*s_folder / "done").string(), "--task", "x"}),
                {"no task 'x'"});
}

TEST_F(BatchApp, PrintsItsPlan) {
  const Outcome outcome =
      succeeded(runProgram(batchMain, {(*s_folder / "street-batch.ini").string(), "--dry-run"}));
  EXPECT_HAS(outcome.out,
             "run.once.s2.01\n  after poles.s2\n  after map.once.s0\n  $ pole-localize");
}

TEST_F(BatchApp, AnInstalledBatchIsDoneByItsName) {
  BatchOptions options = optionsFor("year");
  options.batch = "batches/year.ini";
  options.set = {"batch.settings=never", "batch.runs=1", "sessions.names=may june",
                 "session june.set=world.day=30",
                 "sessions.set=simulation.detections=hdl32e.json "
                 "world.seed=500 world.length_m=120"};
  doBatch(options);
  const auto results = resultsIn(*s_folder / "year");
  EXPECT_EQ(resultOf(results, "never", "june")["runs"][0]["failure"], "");
  const std::string command = results["command"];
  EXPECT_EQ(command.rfind("pole-batch batches/year.ini --output OUT --set ", 0), 0u) << command;
  EXPECT_EQ(readText(*s_folder / "year/batch.ini"),
            readText(fs::path(POLEMCL_SOURCE_DIR) / "config/batches/year.ini"));
}

TEST_F(BatchApp, ScoresItsMaps) {
  BatchOptions options = optionsFor("scored");
  // Poles where the first map has them, but for one; and one that it has not.
  const auto map = io::readPoleMap(*s_folder / "done/tasks/map.once.s0/map.polemap").poles;
  std::string truth = "x,y\n1000,1000\n";
  for (std::size_t i = 1; i < map.size(); ++i)
    truth += io::fixed(map[i].x, 3) + ',' + io::fixed(map[i].y, 3) + '\n';
  writeText(*s_folder / "truth.csv", truth);
  options.set = {"sessions.truth_map=truth.csv", "batch.runs=1", "batch.settings=once"};
  doBatch(options);
  const auto results = resultsIn(*s_folder / "scored");
  const auto score = resultOf(results, "once", "s0")["map_score"];
  EXPECT_EQ(score["truth"], "truth.csv");
  const auto& oneToOne = score["one_to_one_1m"];
  EXPECT_EQ(oneToOne["map_poles"], map.size());
  EXPECT_EQ(oneToOne["truth_poles"], map.size());
  EXPECT_EQ(oneToOne["matches"], map.size() - 1);
  EXPECT_NEAR(score["one_to_one_0.5m"]["f1"], 1 - 1.0 / static_cast<double>(map.size()), 1e-9);
  const std::string command = results["command"];
  EXPECT_NE(command.find("--set batch.runs=1"), std::string::npos) << command;
}

TEST_F(BatchApp, WritesALineAfterEachTaskWithoutATerminal) {
  BatchOptions options = optionsFor("told");
  options.set = {"batch.runs=1"};
  options.quiet = false;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  doBatch(options);
  testing::internal::GetCapturedStdout();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("batch 1/10 (10 %)"), std::string::npos) << said;
  EXPECT_NE(said.find("batch 10/10 (100 %)"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 10) << said;
}

TEST_F(BatchApp, AFullDiskLosesNothing) {
  // Files of at most 64 kB stand in for it: rawlogs are larger, and their writers are told so.
  const fs::path output = *s_folder / "full";
  const std::string run = " \"" + program + "\" \"" + (*s_folder / "street-batch.ini").string() +
                          "\" --quiet --output \"" + output.string() + "\" 2>/dev/null";
  // Elsewhere: a file of coverage counts that is cut short spoils those of all tests.
  const std::string counts = "export GCOV_PREFIX='" + (*s_folder / "counts").string() + "'; ";
  EXPECT_NE(std::system((counts + "trap '' XFSZ; ulimit -f 64;" + run).c_str()), 0);
  for (const auto& entry : fs::directory_iterator(output / "tasks"))
    EXPECT_TRUE(fs::exists(entry.path() / "done.json")) << entry.path();
  EXPECT_EQ(std::system((run + " --resume").c_str()), 0);
  EXPECT_EQ(left("full"), left("done"));
}

}  // namespace
}  // namespace polemcl::test_batch_app
