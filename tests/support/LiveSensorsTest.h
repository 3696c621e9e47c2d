#pragma once
// Sensors of an INI file, and what they gave.

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>

#include "mrpt/live/LiveSensors.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"
#include "support/UdpSender.h"

namespace testing_apps {

using polemcl::LiveSensors;

class LiveSensorsTest : public testing::Test {
 protected:
  std::unique_ptr<LiveSensors> start(const std::string& ini) {
    writeText(folder / "sensors.ini", ini);
    return polemcl::startSensors((folder / "sensors.ini").string(),
                                 {[this](const mrpt::obs::CObservation::Ptr& observation) {
                                    const std::lock_guard lock(mutex);
                                    observations.push_back(observation);
                                  },
                                  [this](const std::string& failure) {
                                    const std::lock_guard lock(mutex);
                                    ends.push_back(failure);
                                  },
                                  [this](const std::string& warning) {
                                    const std::lock_guard lock(mutex);
                                    warnings.push_back(warning);
                                  },
                                  [this](std::size_t moreLost, std::size_t moreIgnored) {
                                    lost += moreLost;
                                    ignored += moreIgnored;
                                  }});
  }
  void expectError(const std::string& ini, const std::vector<std::string>& words) {
    EXPECT_TRUE(polemcl::tests::says(polemcl::tests::messageOf([&] { start(ini); }), words)) << ini;
  }
  std::size_t ended() {
    const std::lock_guard lock(mutex);
    return ends.size();
  }
  std::size_t observed() {
    const std::lock_guard lock(mutex);
    return observations.size();
  }
  /// A VLP-16 at free ports.
  static std::string velodyne(const std::string& more) {
    return "[lidar]\ndriver = CVelodyneScanner\nmodel = VLP16\ndata_port = " +
           std::to_string(freeUdpPort()) + "\nposition_port = " + std::to_string(freeUdpPort()) +
           "\n" + more;
  }

  const TempFolder folder;
  std::mutex mutex;
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  std::vector<std::string> ends, warnings;
  std::atomic<std::size_t> lost{0}, ignored{0};  ///< packets
};

}  // namespace testing_apps
