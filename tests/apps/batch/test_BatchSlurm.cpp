// With a stand-in for Slurm. A real cluster: tests/slurm/run.sh.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "batch/BatchSlurm.h"
#include "support/BatchTestFiles.h"

namespace polemcl::test_batch_slurm {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// Two tasks are given to an `sbatch` that takes them, and to a `squeue` that fails `failures`
/// times before it says that nothing is queued.
class BatchSlurm : public testing::Test {
 protected:
  BatchSlurm() : m_path(std::getenv("PATH")) {
    ::setenv("PATH", (m_folder.path().string() + ":" + m_path).c_str(), 1);
    command("sbatch", "echo 7");
    m_options.pollSeconds = 0.01;
    m_options.largestArray = 1;
  }
  ~BatchSlurm() override { ::setenv("PATH", m_path.c_str(), 1); }

  void runWith(int failures, const std::string& name = "out") {
    command("squeue", "echo >>" + (m_folder / "asked").string() + "\n[ $(wc -l <" +
                          (m_folder / "asked").string() + ") -gt " + std::to_string(failures) +
                          " ] || { echo Unable to contact slurm controller; exit 1; }");
    BatchPlan plan;
    plan.name = "try";
    for (const char* task : {"a", "b"}) plan.tasks.push_back(BatchTask({TaskKind::poles, {task}}));
    runOnSlurm(BatchFolder(m_folder / name), plan, {&plan.tasks[0], &plan.tasks[1]}, m_options, {});
  }
  std::size_t asked() {
    const std::string lines = readText(m_folder / "asked");
    return static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n'));
  }

  void command(const std::string& name, const std::string& text) {
    writeText(m_folder / name, "#!/bin/sh\n" + text + "\n");
    fs::permissions(m_folder / name, fs::perms::owner_all);
  }
  /// What the stand-in of this name was given, see keepArguments().
  std::vector<std::string> given(const std::string& name) {
    std::vector<std::string> arguments;
    std::istringstream all(readText(m_folder / (name + ".given")));
    for (std::string one; std::getline(all, one, '\0');) arguments.push_back(one);
    return arguments;
  }
  std::string keepArguments(const std::string& name) {
    return "printf '%s\\0' \"$@\" >" + (m_folder / (name + ".given")).string();
  }
  SlurmOptions m_options;
  std::string m_path;
  TempFolder m_folder;
};

TEST_F(BatchSlurm, WaitsWhileTheControllerDoesNotAnswer) {
  runWith(3);
  EXPECT_EQ(asked(), 4u);
}

TEST_F(BatchSlurm, SaysWhichJobsMayRunWhenItGivesUp) {
  m_options.patienceSeconds = 0.05;
  EXPECT_REFUSED(runWith(1000), "squeue failed: Unable to contact slurm controller",
                 "before --resume: scancel 7 7");
}

TEST_F(BatchSlurm, FindsTheJobAmongWarnings) {
  command("sbatch", "echo 'sbatch: lua: job (of 1 h) will be charged' >&2; echo '8;cluster'");
  m_options.patienceSeconds = 0.05;
  EXPECT_REFUSED(runWith(1000), "before --resume: scancel 8 8");
  command("sbatch", "echo 'sbatch: 2 warnings'");
  EXPECT_REFUSED(runWith(0), "sbatch names no job: sbatch: 2 warnings");
}

TEST_F(BatchSlurm, SaysWhichJobsMayRunWhenTheNextIsRefused) {
  command("sbatch", "[ ! -e " + (m_folder / "one").string() + " ] || exit 1; echo >" +
                        (m_folder / "one").string() + "; echo 7");
  EXPECT_REFUSED(runWith(0), "sbatch failed", "before --resume: scancel 7");
}

/// Names that a shell would not leave as they are; `evil` is a command.
const std::vector<std::string> kHostile = {"'; evil; $(evil)",
                                           "a'b",
                                           "two\nlines; evil",
                                           "'\n`evil`\\",
                                           "\"$(evil)\" && evil | evil & evil",
                                           "${HOME} ~ * ? [a] {b,c} !",
                                           "'",
                                           "''",
                                           "\\",
                                           "-x",
                                           "# no",
                                           "tab\tand space "};

TEST_F(BatchSlurm, GivesNamesOfAllKindsAsTheyAre) {
  command("evil", "echo >" + (m_folder / "evil.ran").string());
  command("sbatch", keepArguments("sbatch") + "\necho 7");
  command("pole-batch", keepArguments("task"));
  m_options.largestArray = 2;
  m_options.arguments = kHostile;
  m_options.arguments.emplace_back();
  for (int c = 1; c < 256; ++c) m_options.arguments.push_back(std::string(1, static_cast<char>(c)));
  for (const std::string& name : kHostile) {
    runWith(0, name);
    const std::string batch = (m_folder / name).string(), script = batch + "/slurm/try.1.sh";
    std::vector<std::string> expected = {
        "--parsable",        "--requeue",        "--job-name=try.1",
        "--array=1-2",       "--chdir=" + batch, "--output=" + batch + "/slurm/try.1_%a.log",
        "--open-mode=append"};
    expected.insert(expected.end(), m_options.arguments.begin(), m_options.arguments.end());
    expected.push_back(script);
    EXPECT_EQ(given("sbatch"), expected) << name;
    // The script of a task, with a stand-in for the program.
    std::string text = readText(script);
    const std::size_t line = text.find("export POLEMCL_BIN=");
    ASSERT_NE(line, text.npos);
    text.replace(line, text.find('\n', line) - line,
                 "export POLEMCL_BIN=" + m_folder.path().string());
    command("task", "SLURM_ARRAY_TASK_ID=2\n" + text);
    ASSERT_EQ(std::system((m_folder / "task").c_str()), 0) << text;
    EXPECT_EQ(given("task"),
              (std::vector<std::string>{"--quiet", "--output", batch, "--task", "poles.b"}));
  }
  EXPECT_FALSE(fs::exists(m_folder / "evil.ran"));
}

}  // namespace
}  // namespace polemcl::test_batch_slurm
