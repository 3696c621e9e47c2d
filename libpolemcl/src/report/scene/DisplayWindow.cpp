/// \file DisplayWindow.cpp
/// \brief The module libpolemcl-window.so: see LiveWindow.h.

#include <dlfcn.h>
#include <mrpt/gui/CDisplayWindow3D.h>

#include <cmath>
#include <cstdlib>

#include <polemcl/core/common/Types.h>
#include "report/scene/LiveWindow.h"

namespace polemcl::report {
namespace {

class DisplayWindow : public LiveWindow {
 public:
  DisplayWindow(const std::string& title, unsigned width, unsigned height,
                const viz::Scene::Ptr& scene)
      : m_window(title, width, height) {
    if (!m_window.isOpen())
      throw Error(
          "no window can be opened on this display; leave --live out, --frames DIR writes "
          "pictures without a display");
    m_window.get3DSceneAndLock() = scene;
    m_window.unlockAccess3DScene();
  }

  bool isOpen() const override {
    return const_cast<mrpt::gui::CDisplayWindow3D&>(m_window).isOpen();
  }

  void update(const std::function<void()>& change, const viz::CCamera& camera) override {
    m_window.get3DSceneAndLock();
    try {
      change();
    } catch (...) {
      m_window.unlockAccess3DScene();
      throw;
    }
    m_window.unlockAccess3DScene();
    follow(camera);
    m_window.forceRepaint();
  }

 private:
  /// The window has a camera of its own, which the user turns; it gets the scene's movements.
  void follow(const viz::CCamera& camera) {
    m_window.setCameraPointingToPoint(camera.getPointingAtX(), camera.getPointingAtY(),
                                      camera.getPointingAtZ());
    const float azimuth = camera.getAzimuthDegrees(), zoom = camera.getZoomDistance(),
                elevation = camera.getElevationDegrees();
    // Another distance: another picture, from the whole map to the vehicle or back.
    if (!m_followed || zoom != m_zoom) {
      m_window.setCameraAzimuthDeg(azimuth);
      m_window.setCameraElevationDeg(elevation);
      m_window.setCameraZoom(zoom);
    } else if (azimuth != m_azimuth) {
      m_window.setCameraAzimuthDeg(m_window.getCameraAzimuthDeg() +
                                   std::remainder(azimuth - m_azimuth, 360.0f));
    }
    m_azimuth = azimuth, m_zoom = zoom, m_followed = true;
  }

  mrpt::gui::CDisplayWindow3D m_window;
  bool m_followed = false;
  float m_azimuth = 0, m_zoom = 0;
};

/// MRPT would wait for seconds, print GTK's complaint, and go on without a window.
void requireDisplay() {
  const char* name = std::getenv("DISPLAY");
  const char* wayland = std::getenv("WAYLAND_DISPLAY");
  if (!name || (wayland && *wayland)) return;
  // GTK has brought Xlib along.
  const auto open = reinterpret_cast<void* (*)(const char*)>(dlsym(RTLD_DEFAULT, "XOpenDisplay"));
  const auto close = reinterpret_cast<int (*)(void*)>(dlsym(RTLD_DEFAULT, "XCloseDisplay"));
  if (!open || !close) return;
  void* display = open(nullptr);
  if (!display)
    throw Error(std::string("no window can be opened: the display ") + name +
                " (DISPLAY) does not answer; --frames DIR writes pictures without a display");
  close(display);
}

}  // namespace
}  // namespace polemcl::report

extern "C" __attribute__((visibility("default"))) polemcl::report::LiveWindow* polemclOpenWindow(
    const std::string& title, unsigned width, unsigned height,
    const polemcl::viz::Scene::Ptr& scene) {
  polemcl::report::requireDisplay();
  return new polemcl::report::DisplayWindow(title, width, height, scene);
}
