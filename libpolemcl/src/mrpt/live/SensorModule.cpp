/// \file SensorModule.cpp
/// \brief The module libpolemcl-sensors.so: see LiveSensors.h.

#include <mrpt/config/CConfigFileMemory.h>

#include <fstream>
#include <iterator>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "mrpt/live/LiveSensors.h"
#include "mrpt/live/SensorThread.h"

namespace polemcl {
namespace {

class SensorThreads : public LiveSensors {
 public:
  SensorThreads(const std::string& file, SensorEvents events) : m_events(std::move(events)) {
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw Error(file + ": cannot be read");
    mrpt::config::CConfigFileMemory config(text);
    std::vector<std::string> sections;
    config.getAllSections(sections);
    for (const std::string& section : sections)
      if (!section.empty() && section != "global" &&
          !config.read_bool(section, "rawlog-grabber-ignore", false))
        m_threads.push_back(std::make_unique<SensorThread>(file, section, config));
    if (m_threads.empty())
      throw Error(file + ": names no sensor: add a section with driver = CVelodyneScanner");
    for (const auto& thread : m_threads) thread->start(m_events);
  }

 private:
  SensorEvents m_events;
  std::vector<std::unique_ptr<SensorThread>> m_threads;
};

}  // namespace
}  // namespace polemcl

extern "C" __attribute__((visibility("default"))) polemcl::LiveSensors* polemclStartSensors(
    const std::string& file, polemcl::SensorEvents events) {
  return new polemcl::SensorThreads(file, std::move(events));
}
