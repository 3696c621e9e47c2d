#include "batch/BatchRunner.h"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>

#include <polemcl/core/common/Types.h>
#include "batch/BatchCommands.h"
#include "cli/Progress.h"
#include "io/file/InstalledFiles.h"
#include "io/file/Process.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

/// Files that the commands leave beside their outputs would be found by the next attempt.
class Staging {
 public:
  Staging(const BatchFolder& folder, const BatchTask& task) : m_path(folder.stage(task)) {}
  ~Staging() {
    std::error_code none;
    fs::remove_all(m_path, none);
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;
  const fs::path& path() const { return m_path; }

 private:
  fs::path m_path;
};

void copyFiles(const std::vector<std::string>& command, const fs::path& folder) {
  std::error_code failure;
  fs::copy_file(command.at(1), folder / command.at(2), failure);
  if (failure) throw Error(command.at(1) + ": cannot be copied: " + failure.message());
}

/// A program of the project, or `copy FROM TO`. Command and output are added to the log. Throws
/// Error with the last line of the output.
void runCommand(const std::vector<std::string>& command, const fs::path& folder,
                const fs::path& log) {
  {
    std::ofstream stream(log, std::ios::app);
    stream << "$";
    for (const auto& argument : command) stream << ' ' << shellQuoted(argument);
    stream << '\n';
    if (!stream.flush()) throw Error(log.string() + ": cannot be written; is the disk full?");
  }
  if (command.front() == "copy") return copyFiles(command, folder);
  std::vector<std::string> started = command;
  started.front() = programFolder() / command.front();
  io::runLogged(started, folder, log);
}

void doTask(const BatchFolder& folder, const BatchTask& task) {
  for (const auto& need : task.needs)
    if (!fs::exists(folder.work(need) / "done.json"))
      throw Error("needs " + need + ", which is not done");
  folder.remove(task);  // an older one, with other settings
  std::error_code none;
  const fs::path log = fs::absolute(folder.log(task.id));
  fs::remove(log, none);
  const Staging staging(folder, task);
  for (const auto& output : task.outputs)
    fs::create_directories((staging.path() / output).parent_path());
  for (const auto& command : task.commands) runCommand(command, staging.path(), log);
  folder.commit(task, staging.path());
}

/// Hands out tasks whose needs are done, to several threads.
class Queue {
 public:
  using Report = std::function<void(const BatchTask&, const TaskOutcome&, const BatchProgress&)>;

  Queue(const BatchFolder& folder, std::vector<const BatchTask*> open, std::size_t all,
        std::size_t imports, const Report& report)
      : m_folder(folder), m_waiting(std::move(open)), m_mostImports(imports), m_report(report) {
    for (const auto* task : m_waiting) m_open.insert(task->id);
    m_progress.all = all;
    m_progress.done = all - m_waiting.size();
  }

  void work() {
    std::unique_lock lock(m_mutex);
    while (!m_waiting.empty()) {
      const BatchTask* task = takeReady();
      if (!task) {
        m_changed.wait(lock);
        continue;
      }
      const std::string blocked = blockedBy(*task);
      lock.unlock();
      const TaskOutcome outcome =
          blocked.empty() ? runTask(m_folder, *task) : TaskOutcome{blocked, 0, true};
      lock.lock();
      finish(*task, outcome);
    }
  }

  const std::map<std::string, std::string>& failures() const { return m_failures; }

 private:
  static bool isImport(const BatchTask& task) { return task.kind == TaskKind::poles; }

  const BatchTask* takeReady() {
    for (auto task = m_waiting.begin(); task != m_waiting.end(); ++task) {
      bool ready = true;
      for (const auto& need : (*task)->needs) ready = ready && !m_open.count(need);
      if (!ready || (isImport(**task) && m_mostImports > 0 && m_imports >= m_mostImports)) continue;
      const BatchTask* found = *task;
      m_imports += isImport(*found);
      m_waiting.erase(task);
      return found;
    }
    return nullptr;
  }

  std::string blockedBy(const BatchTask& task) const {
    for (const auto& need : task.needs)
      if (m_failed.count(need)) return "needs " + need + ", which is not done";
    return {};
  }

  void finish(const BatchTask& task, const TaskOutcome& outcome) {
    m_open.erase(task.id);
    m_imports -= isImport(task);
    if (outcome.failure.empty()) {
      ++m_progress.done;
    } else {
      if (!outcome.blocked) m_failures[task.id] = outcome.failure;
      m_failed.insert(task.id);
      ++m_progress.failed;
    }
    if (m_report) m_report(task, outcome, m_progress);
    m_changed.notify_all();
  }

  const BatchFolder& m_folder;
  std::vector<const BatchTask*> m_waiting;
  const std::size_t m_mostImports;
  std::size_t m_imports = 0;  ///< under way
  const Report& m_report;
  std::set<std::string> m_open;    ///< ids of tasks that are not done yet
  std::set<std::string> m_failed;  ///< blocked ones too
  std::map<std::string, std::string> m_failures;
  BatchProgress m_progress;
  std::mutex m_mutex;
  std::condition_variable m_changed;
};

}  // namespace

fs::path programFolder() {
  if (const char* folder = std::getenv("POLEMCL_BIN"); folder && *folder)
    return fs::absolute(folder);
  return io::programFolder();
}

TaskOutcome runTask(const BatchFolder& folder, const BatchTask& task) {
  TaskOutcome outcome;
  const auto begin = std::chrono::steady_clock::now();
  try {
    if (folder.state(task) == BatchFolder::State::done) return outcome;
    doTask(folder, task);
  } catch (const std::exception& error) {
    outcome.failure = error.what();
    folder.noteFailure(task, outcome.failure);
  }
  outcome.seconds = secondsSince(begin);
  if (outcome.failure.empty()) folder.noteTime(task.id, outcome.seconds);
  return outcome;
}

OpenTasks openTasks(const BatchFolder& folder, const BatchPlan& plan) {
  OpenTasks open;
  std::set<std::string> ids;
  std::map<std::string, std::size_t> doneByOthers;
  for (const auto& task : plan.tasks) {
    const bool again = std::any_of(task.needs.begin(), task.needs.end(),
                                   [&](const std::string& need) { return ids.count(need) > 0; });
    std::string why;
    const auto state = folder.state(task, &why);
    if (state == BatchFolder::State::damaged)
      open.notes.push_back(task.id + ": " + why + "; it is done again");
    if (state == BatchFolder::State::done && !again) continue;
    const std::string build = folder.buildOf(task);
    if (state == BatchFolder::State::open && !build.empty() && build != plan.build)
      ++doneByOthers[build];
    if (state != BatchFolder::State::open || again) open.outdated.push_back(&task);
    open.tasks.push_back(&task);
    ids.insert(task.id);
  }
  for (const auto& [build, count] : doneByOthers)
    open.notes.push_back(std::to_string(count) + " tasks were done by another build (" + build +
                         ") and are done again; this is " + plan.build);
  return open;
}

std::map<std::string, std::string> runBatch(const BatchFolder& folder,
                                            const std::vector<const BatchTask*>& open,
                                            std::size_t all, const BatchLimits& limits,
                                            const Queue::Report& report) {
  Queue queue(folder, open, all, limits.imports, report);
  std::vector<std::thread> others;
  try {
    while (others.size() + 1 < limits.jobs) others.emplace_back([&queue] { queue.work(); });
  } catch (const std::system_error&) {
    // No memory for another thread: as many tasks at a time as there are threads.
  }
  queue.work();
  for (auto& thread : others) thread.join();
  return queue.failures();
}

}  // namespace polemcl::apps
