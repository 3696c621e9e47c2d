#pragma once
/// \file RunView.h
/// \brief Shows a run as it goes: in a window, as scenes and as frames.

#include <memory>
#include <string>
#include <vector>

#include "localize/LivePlayer.h"
#include "localize/RunFolder.h"

namespace polemcl::apps {

/// \brief The run that is shown. All must outlive its view.
struct WatchedRun {
  const std::vector<MapPole>& map;
  std::string name;                                   ///< of the input, for the title
  const std::vector<StampedPose2D>* truth = nullptr;  ///< null without
  SequenceOptions reading = {};                       ///< of the scans whose points are shown
  report::Playback::Source source = report::Playback::Source::rawlog;
};

class SceneRecorder;

/// \brief What `[view]` asks for. Everything is opened and refused here, before the run.
///
/// The window, with its keys, has a thread of its own (LivePlayer); closed by the user, the run
/// goes on without it. Scenes and frames are made by another, from copies.
class RunView {
 public:
  /// \param folder Gets `run_00_scenes/NNNNNN.3Dscene`, NNNNNN the scan; must outlive this object.
  /// \throws Error without a display for the window; when the folder of frames holds other files.
  RunView(const report::ViewOptions& options, WatchedRun run, const RunFolder& folder);
  ~RunView();
  RunView(const RunView&) = delete;
  RunView& operator=(const RunView&) = delete;

  /// \brief To be called with each step of one run, in order, from one thread at a time. Waits as
  /// long as the user has paused a run of a rawlog, or looks at earlier scans.
  /// \throws Error when something could not be drawn or written.
  void show(const LocalizationPipeline& localization, const PoleScan& frame,
            const LocalizationUpdate& update, const WatchedScan& scan = {});
  /// \brief A window is there, and the user has not closed it. From any thread.
  bool isOpen() const { return m_player && m_player->isOpen(); }
  /// \brief A window shows the scans as the run gives them. From any thread.
  bool follows() const { return m_player && m_player->follows(); }

  /// \brief Once the run is over: waits until all scenes and frames are written, then puts the
  /// frames in the place of earlier ones. \throws Error when any could not be written.
  void finish();
  /// \brief Returns when the user has closed the window; without `hold`, when it shows the last
  /// scan and is not paused. \throws Error when something could not be drawn.
  void waitForWindow();

 private:
  report::ViewOptions m_options;
  const std::vector<StampedPose2D>* m_truth;
  std::unique_ptr<LivePlayer> m_player;
  std::unique_ptr<SceneRecorder> m_recorder;
  report::Way m_way, m_trueWay;  ///< of what is recorded
  std::size_t m_scan = 0;
  double m_start = 0;  ///< time of the first scan, s
};

}  // namespace polemcl::apps
