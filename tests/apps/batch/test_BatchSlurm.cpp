// With a stand-in for Slurm. A real cluster: tests/slurm/run.sh.
#include <gtest/gtest.h>

#include <cstdlib>

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

  void runWith(int failures) {
    command("squeue", "echo >>" + (m_folder / "asked").string() + "\n[ $(wc -l <" +
                          (m_folder / "asked").string() + ") -gt " + std::to_string(failures) +
                          " ] || { echo Unable to contact slurm controller; exit 1; }");
    BatchPlan plan;
    plan.name = "try";
    for (const char* name : {"a", "b"}) plan.tasks.push_back(BatchTask({TaskKind::poles, {name}}));
    runOnSlurm(BatchFolder(m_folder / "out"), plan, {&plan.tasks[0], &plan.tasks[1]}, m_options,
               {});
  }
  std::size_t asked() {
    const std::string lines = readText(m_folder / "asked");
    return static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n'));
  }

  void command(const std::string& name, const std::string& text) {
    writeText(m_folder / name, "#!/bin/sh\n" + text + "\n");
    fs::permissions(m_folder / name, fs::perms::owner_all);
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

}  // namespace
}  // namespace polemcl::test_batch_slurm
