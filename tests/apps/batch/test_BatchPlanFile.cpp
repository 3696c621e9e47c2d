// A plan that somebody else wrote is data.

#include <gtest/gtest.h>

#include "batch/BatchPlan.h"
#include "support/ExpectHas.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_batch_plan_file {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;
using tests::messageOf;

/// What is said about a plan of one task.
template <class Change>
std::string refusal(const Change& change) {
  const TempFolder folder;
  BatchTask task({TaskKind::poles, {"a"}});
  task.commands = {{"copy", "/data/a.tum", "a.tum"}};
  task.outputs = {"a.tum"};
  change(task);
  BatchPlan plan;
  plan.tasks = {task};
  writePlan(folder / "plan.json", plan);
  return messageOf([&] { readPlan(folder / "plan.json"); });
}

TEST(BatchPlanFile, NamesFoldersOfTasksAlone) {
  EXPECT_EQ(refusal([](BatchTask&) {}), "no error");
  for (const char* id : {"../../x", "poles./../../x", "poles.", "map.a"})
    EXPECT_HAS(refusal([&](BatchTask& task) { task.id = id; }), "is no id of a task");
  for (const char* output : {"../x", "/tmp/x", ""})
    EXPECT_HAS(refusal([&](BatchTask& task) { task.outputs.front() = output; }), "lies outside");
}

TEST(BatchPlanFile, RunsNothingButProgramsThatWriteIntoTheFolderOfTheirTask) {
  const struct {
    std::vector<std::string> command;
    const char* said;
  } commands[] = {
      {{"pole-eval", "map", "--map", "a", "--truth", "b", "--json", "c"}, "no error"},
      {{"pole-import", "nclt", "--sensor-pose", "-1 0 2", "--output", "c.rawlog"}, "no error"},
      {{}, "is empty"},
      {{"../../bin/rm"}, "'../../bin/rm' is no program that a batch runs"},
      {{"copy", "a.tum", "/home/u/.profile"}, "'/home/u/.profile' lies outside"},
      {{"copy", "a.tum", "../../b"}, "lies outside"},
      {{"copy", "a.tum"}, "needs two files"},
      {{"pole-eval", "map", "--json", "/home/u/.profile"}, "'/home/u/.profile' lies outside"},
      {{"pole-eval", "map", "--json=/home/u/.profile"}, "'--json=/home/u/.profile' is no option"},
      {{"pole-eval", "map", "-j", "a"}, "'-j' is no option that a batch uses"},
      {{"pole-localize", "--output", "out", "--png", "a.png"}, "'--png' is no option"},
      {{"pole-localize", "--output"}, "'' lies outside"},
      {{"pole-map", "update", "--map", "/data/a.polemap"}, "'pole-map' has no output"},
  };
  for (const auto& [command, said] : commands)
    EXPECT_HAS(refusal([&, &it = command](BatchTask& task) { task.commands.push_back(it); }), said);
}

TEST(BatchPlanFile, IsNotNestedWithoutEnd) {
  const TempFolder folder;
  writeText(folder / "plan.json", std::string(100000, '[') + std::string(100000, ']'));
  EXPECT_REFUSED(readPlan(folder / "plan.json"), "nested more than 64");
}

}  // namespace
}  // namespace polemcl::test_batch_plan_file
