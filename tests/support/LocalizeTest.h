#pragma once
// The input of `pole-localize` as files, and its runs.

#include <nlohmann/json.hpp>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "io/data/Trajectory.h"
#include "localize/LocalizeApp.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "support/PoleStreet.h"
#include "support/TempFolder.h"

namespace testing_apps {

using namespace polemcl;
using namespace polemcl::apps;

/// A street as files: `in.rawlog` of stored poles, `map.polemap`, `truth.tum`, `config.ini`.
class LocalizeTest : public testing::Test {
 protected:
  static constexpr std::size_t scans = 40;

  LocalizeTest() {
    registerClasses();
    tests::StreetOptions options;
    options.scans = scans;
    street = tests::makeStreet(options);
    street.map->saveToPoleMapFile((folder / "map.polemap").string());
    writeRawlog();
    std::vector<StampedPose2D> truth;
    for (std::size_t i = 0; i < scans; ++i)
      truth.push_back({street.frames[i].time, street.truth[i]});
    io::writeTum(folder / "truth.tum", truth);
    writeText(folder / "config.ini",
              "[likelihood]\nsigma_m = 0.1\nweighted = false\n[filter]\nparticles = "
              "200\n[start]\nparticles = 1\n");
  }

  void writeRawlog() {
    RawlogWriter writer((folder / "in.rawlog").string());
    for (const auto& frame : street.frames) {
      auto poles = CObservationPoles::Create();
      poles->timestamp = mrpt::Clock::fromDouble(frame.time);
      poles->poles = frame.poles_robot;
      poles->points = static_cast<std::uint32_t>(frame.points);
      writer.write(makeActions(frame.motion, poles->timestamp), poles);
    }
    writer.commit();
  }

  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{
        "--config", (folder / "config.ini").string(),  "--input",  (folder / "in.rawlog").string(),
        "--map",    (folder / "map.polemap").string(), "--output", (folder / "out").string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome run(const std::vector<std::string>& more = {}) const {
    return runProgram(localizeMain, arguments(more));
  }
  Outcome runWithTruth(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--truth", (folder / "truth.tum").string()});
    return run(more);
  }
  nlohmann::json summary() const { return nlohmann::json::parse(readText(out("summary.json"))); }
  fs::path out(const std::string& name) const { return folder / "out" / name; }
  /// All results except the timings.
  std::string bytes() const {
    std::string all;
    for (const auto& name : names(folder / "out"))
      if (name != "timings.json") all += name + "\n" + readText(out(name));
    return all;
  }

  TempFolder folder;
  tests::PoleStreet street;
};

}  // namespace testing_apps
