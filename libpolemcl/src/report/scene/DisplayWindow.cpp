/// \file DisplayWindow.cpp
/// \brief The module libpolemcl-window.so: see LiveWindow.h.

#include <dlfcn.h>
#include <mrpt/gui/CDisplayWindow3D.h>
#include <mrpt/gui/keycodes.h>
#include <mrpt/system/CObserver.h>
#include <unistd.h>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "report/scene/LiveWindow.h"

namespace polemcl::report {
namespace {

/// None: a key that no program uses, such as Shift alone.
std::optional<KeyPress> keyOf(int code) {
  using Key = KeyPress::Key;
  using namespace mrpt::gui;
  static const std::map<int, Key> named{{MRPTK_LEFT, Key::left},
                                        {MRPTK_NUMPAD_LEFT, Key::left},
                                        {MRPTK_RIGHT, Key::right},
                                        {MRPTK_NUMPAD_RIGHT, Key::right},
                                        {MRPTK_UP, Key::up},
                                        {MRPTK_NUMPAD_UP, Key::up},
                                        {MRPTK_DOWN, Key::down},
                                        {MRPTK_NUMPAD_DOWN, Key::down},
                                        {MRPTK_PAGEUP, Key::pageUp},
                                        {MRPTK_NUMPAD_PAGEUP, Key::pageUp},
                                        {MRPTK_PAGEDOWN, Key::pageDown},
                                        {MRPTK_NUMPAD_PAGEDOWN, Key::pageDown},
                                        {MRPTK_HOME, Key::home},
                                        {MRPTK_NUMPAD_HOME, Key::home},
                                        {MRPTK_END, Key::end},
                                        {MRPTK_NUMPAD_END, Key::end},
                                        {MRPTK_RETURN, Key::enter},
                                        {MRPTK_NUMPAD_ENTER, Key::enter},
                                        {MRPTK_ESCAPE, Key::escape},
                                        {MRPTK_BACK, Key::backspace}};
  if (const auto found = named.find(code); found != named.end()) return KeyPress{found->second, 0};
  if (code >= MRPTK_NUMPAD0 && code <= MRPTK_NUMPAD9)
    return KeyPress{Key::character, static_cast<char>('0' + code - MRPTK_NUMPAD0)};
  if (code == MRPTK_DECIMAL || code == MRPTK_NUMPAD_DECIMAL) return KeyPress{Key::character, '.'};
  // Some events say which key it is, others which letter: the case tells nothing.
  if (code >= 32 && code < 127)
    return KeyPress{Key::character, static_cast<char>(std::tolower(code))};
  return std::nullopt;
}

/// Collects what is pressed; MRPT calls it from the window's thread.
class PressedKeys : public mrpt::system::CObserver {
 public:
  std::vector<KeyPress> take() {
    const std::lock_guard lock(m_mutex);
    return std::exchange(m_pressed, {});
  }

 private:
  void OnEvent(const mrpt::system::mrptEvent& event) override {
    const auto* typed = dynamic_cast<const mrpt::gui::mrptEventWindowChar*>(&event);
    if (!typed) return;
    const auto key = keyOf(typed->char_code);
    const std::lock_guard lock(m_mutex);
    if (key) m_pressed.push_back(*key);
  }

  std::mutex m_mutex;
  std::vector<KeyPress> m_pressed;
};

/// MRPT's thread draws a window, and gives it keys, for a moment after it has been closed: it would
/// use memory that is freed. So this one is closed, but never deleted.
struct Window : mrpt::gui::CDisplayWindow3D {
  using CDisplayWindow3D::CDisplayWindow3D;
  void close() { destroyWxWindow(); }
  PressedKeys keys;
};

class DisplayWindow : public LiveWindow {
 public:
  DisplayWindow(const std::string& title, unsigned width, unsigned height,
                const viz::Scene::Ptr& scene)
      : m_window(*new Window(title, width, height)) {
    if (!m_window.isOpen())
      throw Error(
          "no window can be opened on this display; leave --live out, --frames DIR writes "
          "pictures without a display");
    m_window.get3DSceneAndLock() = scene;
    m_window.unlockAccess3DScene();
    m_window.keys.observeBegin(m_window);
  }
  ~DisplayWindow() override { m_window.close(); }
  DisplayWindow(const DisplayWindow&) = delete;
  DisplayWindow& operator=(const DisplayWindow&) = delete;

  bool isOpen() const override { return m_window.isOpen(); }

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

  void setTitle(const std::string& title) override {
    if (m_window.isOpen()) m_window.setWindowTitle(title);
  }

  std::vector<KeyPress> takeKeys() override { return m_window.keys.take(); }

 private:
  /// How the user has turned the camera.
  struct View {
    float azimuth, elevation, zoom;  ///< deg, azimuth from that of the scene's camera; deg; m
  };

  /// The window has a camera of its own, which the user turns; it gets the scene's movements.
  void follow(const viz::CCamera& camera) {
    m_window.setCameraPointingToPoint(camera.getPointingAtX(), camera.getPointingAtY(),
                                      camera.getPointingAtZ());
    if (m_followed)
      m_views[m_zoom] = {m_window.getCameraAzimuthDeg() - m_azimuth,
                         m_window.getCameraElevationDeg(), m_window.getCameraZoom()};
    m_azimuth = camera.getAzimuthDegrees(), m_zoom = camera.getZoomDistance();
    // Another distance: another picture, from the whole map to the vehicle or back.
    const View fresh{0, camera.getElevationDegrees(), camera.getZoomDistance()};
    const View& view = m_views.emplace(m_zoom, fresh).first->second;
    m_window.setCameraAzimuthDeg(std::remainder(m_azimuth + view.azimuth, 360.0f));
    m_window.setCameraElevationDeg(view.elevation);
    m_window.setCameraZoom(view.zoom);
    m_followed = true;
  }

  Window& m_window;
  bool m_followed = false;
  float m_azimuth = 0, m_zoom = 0;  ///< of the scene's camera
  std::map<float, View> m_views;    ///< by the distance of the scene's camera
};

/// MRPT's thread goes on after the last window, and would use wxWidgets while exit() takes it
/// apart. So the program ends before that; what it wrote is complete.
void endBeforeLibraries() {
  static const int registered = on_exit(
      [](int status, void*) {
        std::cout.flush();
        std::fflush(nullptr);
        _exit(status);
      },
      nullptr);
  if (registered != 0) throw Error("no window can be opened: the system is out of memory");
}

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
  polemcl::report::endBeforeLibraries();
  return new polemcl::report::DisplayWindow(title, width, height, scene);
}
