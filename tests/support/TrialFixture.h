#pragma once
// Trials on a simulated drive.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "eval/EvalApp.h"
#include "eval/Trials.h"
#include "support/CityFiles.h"

namespace polemcl::test_trials {

using namespace polemcl::apps;
using namespace testing_apps;

using Arguments = std::vector<std::string>;

/// Trials on a drive through a city of poles, a frame a metre, 5 m/s.
class Trials : public testing::Test {
 protected:
  explicit Trials(double metres = 250, int trials = 8) : city(metres) {
    registerClasses();
    options.files = {city.at("city.ini"), city.at("city.polemap"), city.at("drive.rawlog"),
                     city.at("drive.tum")};
    options.trials = trials;
    options.seed = 3;
  }
  TrialDrive drive() const { return loadTrialDrive(options.files); }
  std::vector<TrialOutcome> outcomes(const TrialDrive& of,
                                     TrialMaker (*maker)(const TrialDrive&, const TrialOptions&)) {
    std::atomic<std::size_t> told{0};
    options.progress = [&] { ++told; };
    auto result = runTrials(of, options, maker(of, options));
    EXPECT_EQ(told, result.size());
    EXPECT_EQ(result.size(), static_cast<std::size_t>(options.trials));
    return result;
  }
  Outcome run(const std::string& command, const Arguments& more = {}) const {
    return runProgram(evalMain,
                      {command, "--config", city.at("city.ini"), "--map", city.at("city.polemap"),
                       "--input", city.at("drive.rawlog"), "--truth", city.at("drive.tum")},
                      more);
  }
  /// What the command writes, the same on one thread as on all; `words` are in its text.
  nlohmann::json figures(const std::string& command, Arguments more, const std::string& words) {
    more.insert(more.end(), {"--seed", "3", "--json", city.at("j")});
    const auto once = [&] {
      const Outcome outcome = succeeded(run(command, more));
      EXPECT_NE(outcome.out.find(words), std::string::npos) << outcome.out;
      return readText(city.at("j"));
    };
    const std::string together = once();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(once(), together);
    return nlohmann::json::parse(together);
  }
  CityFiles city;
  TrialOptions options;
};

class FaultTrials : public Trials {
 protected:
  FaultTrials() : Trials(400, 6) {
    options.fault.lead = 8;
    options.fault.duration = 6;
    options.fault.tail = 60;
    options.fault.maxJump = 200;
  }
  Trial inject(Fault fault, std::uint64_t seed = 1) {
    options.fault.fault = fault;
    std::mt19937_64 random(seed);
    return injectFault(drive(), options.fault, random);
  }
};

}  // namespace polemcl::test_trials
