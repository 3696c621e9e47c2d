#include "mrpt/live/LiveSensors.h"

#include <dlfcn.h>

#include <polemcl/core/common/Types.h>
#include "io/file/InstalledFiles.h"

namespace polemcl {
namespace {

using Factory = LiveSensors* (*)(const std::string&, SensorEvents);

constexpr const char* kModuleName = "libpolemcl-sensors.so";

/// Loaded once and never closed: MRPT's registry of classes keeps what it holds.
Factory loadFactory() {
  void* module = dlopen(io::installedModule(kModuleName).c_str(), RTLD_NOW | RTLD_LOCAL);
  void* factory = module ? dlsym(module, "polemclStartSensors") : nullptr;
  if (!factory) throw Error(std::string("no sensor can be used: ") + dlerror());
  return reinterpret_cast<Factory>(factory);
}

}  // namespace

std::unique_ptr<LiveSensors> startSensors(const std::string& file, SensorEvents events) {
  static const Factory factory = loadFactory();
  return std::unique_ptr<LiveSensors>(factory(file, std::move(events)));
}

}  // namespace polemcl
