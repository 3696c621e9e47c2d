#include "batch/BatchApp.h"

#include <mrpt/system/md5.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>
#include <thread>

#include <polemcl/core/common/Types.h>
#include "batch/BatchCollect.h"
#include "batch/BatchCommands.h"
#include "batch/BatchFolder.h"
#include "batch/BatchPlan.h"
#include "batch/BatchRunner.h"
#include "batch/BatchSlurm.h"
#include "batch/BatchSpec.h"
#include "cli/CommandLine.h"
#include "cli/Messages.h"
#include "cli/Progress.h"
#include "io/file/Bytes.h"

namespace polemcl::apps {
namespace {

using Failures = std::map<std::string, std::string>;

std::size_t jobsOf(const BatchOptions& options) {
  if (options.jobs > 0) return options.jobs;
  return std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

Failures runHere(const BatchOptions& options, const BatchFolder& folder, const BatchPlan& plan,
                 const std::vector<const BatchTask*>& open) {
  const std::size_t all = plan.tasks.size();
  const std::chrono::seconds always{0};  // in a log, a line after each task
  Progress progress("batch", all, options.quiet, always);
  return runBatch(folder, open, all, {jobsOf(options), options.imports},
                  [&](const BatchTask& task, const TaskOutcome& outcome, const BatchProgress& now) {
                    if (!outcome.failure.empty() && !outcome.blocked)
                      progress.say("pole-batch: " + task.id + " failed: " + outcome.failure);
                    progress.update(now.done + now.failed);
                  });
}

/// What it needs is not done: not its own failure.
bool isBlocked(const BatchFolder& folder, const BatchPlan& plan, const BatchTask& task) {
  return std::any_of(task.needs.begin(), task.needs.end(),
                     [&](const std::string& need) { return !folder.isDone(plan.task(need)); });
}

Failures runThere(const BatchOptions& options, const BatchFolder& folder, const BatchPlan& plan,
                  const std::vector<const BatchTask*>& open) {
  SlurmOptions slurm;
  slurm.arguments = options.sbatch;
  Progress progress("batch on Slurm", open.size(), options.quiet);
  runOnSlurm(folder, plan, open, slurm, [&](std::size_t done) { progress.update(done); });
  Failures failures;
  for (const auto* task : open) {
    if (folder.isDone(*task) || isBlocked(folder, plan, *task)) continue;
    const std::string reason = folder.failure(task->id);
    failures[task->id] = reason.empty() ? "did not end; see slurm/" : reason;
    progress.say("pole-batch: " + task->id + " failed: " + failures[task->id]);
  }
  return failures;
}

/// The command that does it again, without where it lies on this machine; an installed batch has
/// its name.
std::string commandOf(const BatchOptions& options, const BatchSpec& spec) {
  const auto batch = spec.file == options.batch ? spec.file.filename() : options.batch;
  std::string command = "pole-batch " + shellQuoted(batch.string()) +
                        (options.data.empty() ? "" : " --data DATA") + " --output OUT";
  for (const auto& assignment : options.set) command += " --set " + shellQuoted(assignment);
  return command;
}

void printOpen(const BatchPlan& plan, const OpenTasks& open) {
  for (const auto& note : open.notes) std::cerr << "pole-batch: " << note << '\n';
  std::cout << plan.name << ": " << plan.tasks.size() << " tasks, " << open.tasks.size()
            << " to be done" << std::endl;
}

/// Tasks read their settings from frozen files, on which the keys of the plan depend.
void requireFrozen(const BatchFolder& folder, const BatchPlan& plan) {
  for (const auto& [name, sum] : plan.sums)
    if (mrpt::system::md5(io::readBytes(folder.path() / name)) != sum)
      throw Error((folder.path() / name).string() +
                  " has changed since the batch began; begin it again with --resume");
}

/// One task of a batch that was begun elsewhere.
void doTaskOf(const BatchOptions& options, const std::string& id) {
  const BatchFolder folder(options.output);
  const BatchPlan plan = readPlan(options.output / "plan.json");
  const BatchTask& task = plan.task(id);
  requireFrozen(folder, plan);
  if (plan.build != buildIdentity())
    throw Error("the batch was begun by another build (" + plan.build + "), this is " +
                buildIdentity() +
                "; use one build on all machines, or begin it again with --resume");
  if (isBlocked(folder, plan, task))
    throw Error(id + ": needs a task that is not done with the settings of now");
  const TaskOutcome outcome = runTask(folder, task);
  if (!outcome.failure.empty()) throw Error(id + ": " + outcome.failure);
}

void requireAllDone(const BatchFolder& folder, const BatchPlan& plan,
                    const report::BatchResults& results) {
  const auto undone = static_cast<std::size_t>(
      std::count_if(plan.tasks.begin(), plan.tasks.end(),
                    [&](const BatchTask& task) { return !folder.isDone(task); }));
  const auto& failures = results.failures;
  if (failures.empty() && undone == 0) return;
  std::string text = std::to_string(failures.size()) + " of " + std::to_string(plan.tasks.size()) +
                     " tasks failed";
  if (!failures.empty())
    text += " (" + failures.front().task + ": " + failures.front().reason + ")";
  throw Error(text + "; with the tasks that need them, " + std::to_string(undone) +
              " are not done");
}

void printPlan(const BatchPlan& plan) {
  for (const auto& task : plan.tasks) {
    std::cout << task.id << '\n';
    for (const auto& need : task.needs) std::cout << "  after " << need << '\n';
    for (const auto& command : task.commands) {
      std::cout << "  $";
      for (const auto& argument : command) std::cout << ' ' << shellQuoted(argument);
      std::cout << '\n';
    }
  }
}

}  // namespace

void doBatch(const BatchOptions& options) {
  const BatchSpec spec = readBatchSpec(options.batch, options.data, options.set);
  const BatchPlan plan = planBatch(spec);
  BatchFolder folder(options.output);
  folder.take(spec.name, options.resume);
  const OpenTasks open = openTasks(folder, plan);
  removeResults(folder, !open.tasks.empty());  // before the plan changes, which they belong to
  folder.store(plan, spec.file);
  for (const BatchTask* task : open.outdated) folder.remove(*task);
  if (!options.quiet) printOpen(plan, open);

  const auto begin = std::chrono::steady_clock::now();
  const Failures failures = options.slurm ? runThere(options, folder, plan, open.tasks)
                                          : runHere(options, folder, plan, open.tasks);
  folder.sweep();
  const std::filesystem::path times = folder.path() / "timings.json";
  try {
    if (!std::filesystem::exists(times)) {
      Json timings = collectTimings(folder, plan);
      if (open.tasks.size() == plan.tasks.size()) {
        timings["wall_s"] = secondsSince(begin);
        timings["jobs"] = options.slurm ? 0 : jobsOf(options);
      }
      writeJson(times, timings);
    }
    const auto results = collectBatch(folder, plan, spec, failures, commandOf(options, spec));
    writeBatchFiles(folder, results);
    if (!options.quiet)
      std::cout << "report: " << (folder.path() / "report.html").string() << std::endl;
    requireAllDone(folder, plan, results);
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + "; finished tasks are kept, continue with --resume");
  }
}

namespace {

/// Ends with a hint on how to continue; the children end with this process.
void endWithAHint(int signal) {
  constexpr char hint[] =
      "pole-batch: interrupted; finished tasks are kept, continue with --resume\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, hint, sizeof hint - 1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

const Guides kBatchGuides{
    {"",
     {{"pole-batch sample.ini --output report", "pole-batch batches/year.ini --output year",
       "pole-batch batches/kitti.ini --data KITTI --output kitti --jobs 4 --resume"},
      "Open report.html in the folder of the batch. After an interruption, go on with "
      "--resume."}},
};

}  // namespace

int batchMain(int argc, const char* const* argv) {
  CommandLine line("pole-batch",
                   "Imports, maps and localizes sessions x settings x runs, and writes a report.",
                   kBatchGuides);
  BatchOptions options;
  std::string task;
  bool dry = false;
  auto& cli = line.cli();
  auto* batch = cli.add_option("batch", options.batch,
                               "Batch: a file, or an installed one such as batches/year.ini")
                    ->type_name("INI");
  addFolder(cli, "--output", options.output, "Folder of the batch: intermediate files, report");
  addFolder(cli, "--data", options.data, "Folder of the dataset: {data} in the batch");
  addNumber(cli, "--jobs", options.jobs, "Number of tasks at the same time; 0: one for each core",
            CLI::Range(0, 4096));
  addNumber(cli, "--imports", options.imports,
            "Number of imports among them; 0: no limit. Scans lie on disk during an import",
            CLI::Range(0, 4096));
  addSetOption(cli, options.set);
  cli.add_flag("--resume", options.resume, "Continue the batch in the folder");
  auto* slurm = cli.add_flag("--slurm", options.slurm, "Run on a Slurm cluster, as job arrays");
  cli.add_option("--sbatch", options.sbatch, "Additional argument for sbatch; may be repeated")
      ->type_name("ARGUMENT")
      ->take_all()
      ->expected(1)
      ->needs(slurm);
  cli.add_flag("--dry-run", dry, "Print the tasks and their commands, do nothing");
  auto* one = cli.add_option("--task", task, "Do this one task of the batch in --output")
                  ->type_name("TASK");
  for (const char* other : {"--data", "--jobs", "--imports", "--set", "--resume", "--slurm",
                            "--sbatch", "--dry-run", "batch"})
    one->excludes(cli.get_option(other));
  cli.parse_complete_callback([&] {
    if (task.empty() && batch->count() == 0) throw CLI::RequiredError("batch");
    if (!dry && options.output.empty()) throw CLI::RequiredError("--output");
  });
  return line.run(argc, argv, [&] {
    options.quiet = line.quiet();
    if (!task.empty()) return doTaskOf(options, task);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
      if (std::signal(signal, endWithAHint) == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup
    if (dry) return printPlan(planBatch(readBatchSpec(options.batch, options.data, options.set)));
    doBatch(options);
  });
}

}  // namespace polemcl::apps
