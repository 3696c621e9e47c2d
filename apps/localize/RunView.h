#pragma once
/// \file RunView.h
/// \brief Shows a run as it goes: in a window, as scenes and as frames.

#include <memory>
#include <string>

#include "localize/RunFolder.h"
#include "localize/SceneRecorder.h"

namespace polemcl::apps {

/// \brief What `[view]` asks for. Everything is opened and refused here, before the run.
///
/// The window is drawn by the thread that shows; closed by the user, the run goes on without it.
/// Scenes and frames are made by a thread of their own, from copies.
class RunView {
 public:
  /// \param map Map to draw. \param name Name of the input, for the title.
  /// \param folder Gets `run_00_scenes/NNNNNN.3Dscene`, NNNNNN the scan; must outlive this object.
  /// \throws Error without a display for the window; when the folder of frames holds other files.
  RunView(const report::ViewOptions& options, const std::vector<MapPole>& map,
          const std::string& name, const RunFolder& folder);
  ~RunView();
  RunView(const RunView&) = delete;
  RunView& operator=(const RunView&) = delete;

  /// \brief To be called with each step of one run, in order, from one thread at a time.
  /// \throws Error when an earlier scene or frame could not be written.
  void show(const LocalizationPipeline& localization, const PoleScan& frame,
            const LocalizationUpdate& update);
  /// \brief A window is there, and the user has not closed it. From any thread.
  bool isOpen() const;

  /// \brief Once the run is over: waits until all scenes and frames are written, then puts the
  /// frames in the place of earlier ones. \throws Error when any could not be written.
  void finish();
  /// \brief `hold`: returns when the user has closed the window.
  void waitForWindow() const;

 private:
  class Screen;
  report::ViewOptions m_options;
  std::unique_ptr<Screen> m_screen;
  std::unique_ptr<SceneRecorder> m_recorder;
  report::Way m_way;
  std::size_t m_scan = 0;
  double m_start = 0;  ///< time of the first scan, s
};

}  // namespace polemcl::apps
