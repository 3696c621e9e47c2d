#include "localize/RunView.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "cli/Progress.h"
#include "report/scene/LiveScene.h"
#include "report/scene/LiveWindow.h"

namespace polemcl::apps {

/// The window and what is drawn in it.
class RunView::Screen {
 public:
  Screen(const report::ViewOptions& options, const std::vector<MapPole>& map,
         const std::string& title)
      : m_scene(map, title),
        m_window(report::openLiveWindow("pole-localize: " + title,
                                        static_cast<unsigned>(options.width),
                                        static_cast<unsigned>(options.height), m_scene.scene())) {}

  bool isOpen() const { return m_window->isOpen(); }

  /// More often than so the eye sees nothing new, and the run would only wait.
  bool isDue() const { return secondsSince(m_drawn) > 1.0 / 30; }

  void draw(const report::LiveMoment& moment) {
    m_window->update([&] { m_scene.show(moment); }, m_scene.camera());
    m_drawn = std::chrono::steady_clock::now();
  }

 private:
  report::LiveScene m_scene;
  std::unique_ptr<report::LiveWindow> m_window;
  std::chrono::steady_clock::time_point m_drawn;
};

RunView::RunView(const report::ViewOptions& options, const std::vector<MapPole>& map,
                 const std::string& name, const RunFolder& folder)
    : m_options(options) {
  m_options.validate();
  if (m_options.scenes > 0 || !m_options.frames.empty())
    m_recorder =
        std::make_unique<SceneRecorder>(m_options, map, name, folder.staged("run_00_scenes"));
  if (m_options.live) m_screen = std::make_unique<Screen>(m_options, map, name);
}

RunView::~RunView() = default;

bool RunView::isOpen() const {
  return m_screen && m_screen->isOpen();
}

void RunView::show(const LocalizationPipeline& localization, const PoleScan& frame,
                   const LocalizationUpdate& update) {
  if (!m_screen && !m_recorder) return;
  if (m_scan == 0) m_start = frame.time;
  m_way.add(update);
  const bool recorded = m_recorder && m_recorder->wants(m_scan);
  const bool drawn = isOpen() && m_screen->isDue();
  if (recorded || drawn) {
    auto moment = report::momentOf(localization, frame, update, m_scan, m_start, m_way);
    if (drawn) m_screen->draw(moment);
    if (recorded) m_recorder->add(std::move(moment));
  }
  ++m_scan;
}

void RunView::finish() {
  if (m_recorder) m_recorder->finish();
}

void RunView::waitForWindow() const {
  while (m_options.hold && isOpen()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

}  // namespace polemcl::apps
