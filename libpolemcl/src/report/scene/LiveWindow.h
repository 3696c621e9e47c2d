#pragma once
/// \file LiveWindow.h
/// \brief A window on the desktop that shows scenes: MRPT's CDisplayWindow3D.
///
/// MRPT's windows bring wxWidgets and GTK along, which would slow the start of every program. So
/// the window is a module of its own, `libpolemcl-window.so`, loaded when the first one is opened.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <polemcl/mrpt/common/Compatibility.h>
#include "report/scene/PlayerKeys.h"

namespace polemcl::report {

class LiveWindow {
 public:
  virtual ~LiveWindow() = default;
  /// \brief False once the user has closed it.
  virtual bool isOpen() const = 0;
  /// \brief Changes the scene that the window shows. The window's camera follows the scene's
  /// camera, and keeps the turn and the zoom that the user chose. The view of the whole map has its
  /// own.
  /// \param change Called with the window's drawing stopped.
  /// \param camera That of the scene, read after the change.
  virtual void update(const std::function<void()>& change, const viz::CCamera& camera) = 0;
  virtual void setTitle(const std::string& title) = 0;
  /// \brief The keys that were pressed since the last call, in order.
  virtual std::vector<KeyPress> takeKeys() = 0;
};

/// \brief Opens a window that shows this scene. \param width,height Pixels.
/// \throws Error without a display, or when the module is missing.
std::unique_ptr<LiveWindow> openLiveWindow(const std::string& title, unsigned width,
                                           unsigned height, const viz::Scene::Ptr& scene);

}  // namespace polemcl::report
