#include "batch/BatchSlurm.h"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <set>
#include <sstream>
#include <thread>

#include <polemcl/core/common/Types.h>
#include "batch/BatchCommands.h"
#include "batch/BatchRunner.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

/// What a command prints. \throws Error with it when the command fails.
std::string outputOf(const std::string& command) {
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw Error(command + ": cannot be run");
  std::string text;
  std::array<char, 4096> block;
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), pipe))
    text.append(block.data(), size);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text;
  std::replace(text.begin(), text.end(), '\n', ' ');
  throw Error(command.substr(0, command.find(' ')) + " failed: " + std::string(io::trimmed(text)) +
              "; is Slurm installed, and its controller running?");
}

std::string scriptOf(const BatchFolder& folder, const std::string& name) {
  return "#!/bin/sh\n# One task of a batch: the line of " + name +
         ".txt that has the number of this array task.\n"
         "export POLEMCL_BIN=" +
         shellQuoted(programFolder().string()) + "\ntask=$(sed -n \"${SLURM_ARRAY_TASK_ID}p\" " +
         shellQuoted((folder.path() / "slurm" / (name + ".txt")).string()) +
         ")\nexec \"$POLEMCL_BIN/pole-batch\" --quiet --output " +
         shellQuoted(folder.path().string()) + " --task \"$task\"\n";
}

/// The number of the job in what sbatch printed: NUMBER or NUMBER;CLUSTER, after warnings.
std::string jobIn(std::string said) {
  std::istringstream lines(said);
  std::string job;
  for (std::string line; std::getline(lines, line);) {
    const std::string number = line.substr(0, line.find_first_of(" ;"));
    if (!number.empty() && number.find_first_not_of("0123456789") == std::string::npos)
      job = number;
  }
  std::replace(said.begin(), said.end(), '\n', ' ');
  if (job.empty()) throw Error("sbatch names no job: " + std::string(io::trimmed(said)));
  return job;
}

/// Submits an array of tasks that can be done at the same time. \param after Jobs that must have
/// ended. \return The number of the job.
std::string submit(const BatchFolder& folder, const std::string& name,
                   const std::vector<std::string>& tasks, const SlurmOptions& options,
                   const std::vector<std::string>& after) {
  const fs::path here = folder.path() / "slurm";
  std::string list;
  for (const auto& task : tasks) list += task + "\n";
  io::writeFile(here / (name + ".txt"), list);
  io::writeFile(here / (name + ".sh"), scriptOf(folder, name));
  std::string command =
      "sbatch --parsable --requeue --job-name=" + shellQuoted(name) + " --array=1-" +
      std::to_string(tasks.size()) + " --chdir=" + shellQuoted(folder.path().string()) +
      " --output=" + shellQuoted((here / (name + "_%a.log")).string()) + " --open-mode=append";
  for (std::size_t i = 0; i < after.size(); ++i)
    command += (i == 0 ? " --dependency=afterany:" : ":") + after[i];
  for (const auto& argument : options.arguments) command += " " + shellQuoted(argument);
  return jobIn(outputOf(command + " " + shellQuoted((here / (name + ".sh")).string())));
}

/// The open tasks by level, in arrays that Slurm takes.
std::vector<std::vector<std::vector<std::string>>> arraysOf(
    const BatchPlan& plan, const std::vector<const BatchTask*>& open, std::size_t largest) {
  std::set<std::string> ids;
  for (const auto* task : open) ids.insert(task->id);
  std::vector<std::vector<std::vector<std::string>>> result;
  for (const auto& level : levels(plan)) {
    std::vector<std::vector<std::string>> arrays;
    for (const auto& id : level) {
      if (!ids.count(id)) continue;
      if (arrays.empty() || arrays.back().size() == largest) arrays.emplace_back();
      arrays.back().push_back(id);
    }
    if (!arrays.empty()) result.push_back(arrays);
  }
  return result;
}

/// What to do with jobs that were submitted before an error.
std::string mayRun(const std::vector<std::string>& jobs) {
  std::string list;
  for (const auto& job : jobs) list += " " + job;
  return list.empty() ? "" : " Jobs may still run; before --resume: scancel" + list;
}

bool isQueued(const std::vector<std::string>& jobs) {
  std::string list;
  for (const auto& job : jobs) list += (list.empty() ? "" : ",") + job;
  // Jobs that ended long ago are forgotten, which squeue calls an error if all of them are.
  try {
    return !io::trimmed(outputOf("squeue --noheader --jobs=" + list + " --format=%i")).empty();
  } catch (const Error& error) {
    if (std::string(error.what()).find("Invalid job id") != std::string::npos) return false;
    throw;
  }
}

}  // namespace

void runOnSlurm(const BatchFolder& folder, const BatchPlan& plan,
                const std::vector<const BatchTask*>& open, const SlurmOptions& options,
                const std::function<void(std::size_t)>& progress) {
  fs::create_directories(folder.path() / "slurm");
  std::vector<std::string> jobs, before;
  std::size_t number = 0;
  for (const auto& level : arraysOf(plan, open, options.largestArray)) {
    std::vector<std::string> submitted;
    for (const auto& tasks : level) {
      const std::string name = plan.name + "." + std::to_string(++number);
      try {
        submitted.push_back(submit(folder, name, tasks, options, before));
      } catch (const Error& error) {
        throw Error(error.what() + mayRun(jobs));
      }
      jobs.push_back(submitted.back());
    }
    before = submitted;
  }
  const auto done = [&] {
    return static_cast<std::size_t>(std::count_if(
        open.begin(), open.end(), [&](const BatchTask* task) { return folder.isDone(*task); }));
  };
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> patience(options.patienceSeconds);
  auto answered = Clock::now();  // a busy controller does not answer for a while
  while (!jobs.empty()) {
    try {
      if (!isQueued(jobs)) return;
      answered = Clock::now();
    } catch (const Error& error) {
      if (Clock::now() - answered > patience) throw Error(error.what() + mayRun(jobs));
    }
    if (progress) progress(done());
    std::this_thread::sleep_for(std::chrono::duration<double>(options.pollSeconds));
  }
}

}  // namespace polemcl::apps
