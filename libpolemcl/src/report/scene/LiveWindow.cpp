#include "report/scene/LiveWindow.h"

#include <dlfcn.h>

#include <cstdlib>

#include <polemcl/core/common/Types.h>
#include "io/file/InstalledFiles.h"

namespace polemcl::report {
namespace {

using Factory = LiveWindow* (*)(const std::string&, unsigned, unsigned, const viz::Scene::Ptr&);

constexpr const char* moduleName = "libpolemcl-window.so";

bool isSet(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value;
}

/// Loaded once and never closed: GTK cannot be.
Factory loadFactory() {
  void* module = dlopen(io::installedModule(moduleName).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) throw Error(std::string("no window can be opened: ") + dlerror());
  void* factory = dlsym(module, "polemclOpenWindow");
  if (!factory) throw Error(std::string("no window can be opened: ") + dlerror());
  return reinterpret_cast<Factory>(factory);
}

}  // namespace

std::unique_ptr<LiveWindow> openLiveWindow(const std::string& title, unsigned width,
                                           unsigned height, const viz::Scene::Ptr& scene) {
  // Before anything is loaded: MRPT would wait for seconds and then go on without a window.
  if (!isSet("DISPLAY") && !isSet("WAYLAND_DISPLAY"))
    throw Error(
        "no window can be opened: there is no display (DISPLAY is not set); leave --live out, "
        "--frames DIR writes pictures without a display");
  static const Factory factory = loadFactory();
  return std::unique_ptr<LiveWindow>(factory(title, width, height, scene));
}

}  // namespace polemcl::report
