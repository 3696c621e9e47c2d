#pragma once
// Batches for tests: files of simulated sessions, plans of made-up tasks.

#include <map>
#include <nlohmann/json.hpp>

#include "batch/BatchPlan.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace testing_apps {

/// A batch of three short simulated drives with sampled poles, two runs with two configurations.
inline fs::path writeStreetBatch(const TempFolder& folder) {
  const std::string source = POLEMCL_SOURCE_DIR;
  writeText(folder / "street.ini", readText(source + "/config/hdl32e.ini") +
                                       "\n[world]\nseed = 31\nlength_m = 120\n[simulation]\n"
                                       "detections = " +
                                       source + "/share/models/hdl32e.json\n");
  writeText(folder / "street-batch.ini",
            "[batch]\nruns = 2\nsettings = kept once\n"
            "[sessions]\nnames = s0 s1 s2\nsource = simulated\ninput = street.ini\n"
            "[session s1]\nset = world.day=1\ndate = 2026-02-01\n"
            "[session s2]\nset = world.day=2\n"
            "[setting kept]\nconfig = " +
                source +
                "/config/hdl32e.ini\nset = filter.particles=200\nmap_sessions = all\n"
                "sessions = s1 s2\nmaps = upkeep\n"
                "[setting once]\nconfig = " +
                source + "/config/hdl32e.ini\nset = filter.particles=200\nsessions = s1 s2\n");
  return folder / "street-batch.ini";
}

/// The results of a batch, as scripts read them.
inline nlohmann::json resultsIn(const fs::path& folder) {
  return nlohmann::json::parse(readText(folder / "results.json"));
}

/// The result of a session under a configuration; null when the batch has no such result.
inline nlohmann::json resultOf(const nlohmann::json& batch, const std::string& configuration,
                               const std::string& session) {
  for (const auto& result : batch.at("results"))
    if (result.at("setting") == configuration && result.at("session") == session) return result;
  return nullptr;
}

/// The files of a folder with their contents, by path, except paths that contain `except`.
inline std::map<std::string, std::string> contents(const fs::path& folder,
                                                   const std::string& except = "\n") {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && name.find(except) == std::string::npos)
      all[name] = readText(entry.path());
  }
  return all;
}

}  // namespace testing_apps
