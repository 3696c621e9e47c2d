#pragma once
/// \file TrialCity.h
/// \brief A fixture for trials of `pole-eval` on a drive through a city of poles.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <polemcl/mrpt/common/RegisterClasses.h>
#include "support/CityFiles.h"

namespace testing_apps {

template <class Options>
class TrialCity : public testing::Test {
 protected:
  /// \param metres Length of the drive.
  TrialCity(double metres, int trials) : city(metres) {
    polemcl::registerClasses();
    options.files = {city.at("city.ini"), city.at("city.polemap"), city.at("drive.rawlog"),
                     city.at("drive.tum")};
    options.trials = trials;
    options.seed = 3;
  }
  /// \brief Arguments of `pole-eval COMMAND` with these files.
  std::vector<std::string> arguments(const std::string& command,
                                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{command,
                                 "--config",
                                 options.files.config.string(),
                                 "--map",
                                 options.files.map.string(),
                                 "--input",
                                 options.files.input.string(),
                                 "--truth",
                                 options.files.truth.string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  CityFiles city;
  Options options;
};

}  // namespace testing_apps
