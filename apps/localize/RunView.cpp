#include "localize/RunView.h"

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "cli/OutputFolder.h"
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "mrpt/drawing/SceneParts.h"
#include "report/scene/FrameRenderer.h"
#include "report/scene/LiveMoment.h"
#include "report/scene/LiveScene.h"
#include "report/scene/ViewOptions.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t mostWaiting = 8;

std::string numbered(std::size_t scan, const char* extension) {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu%s", scan, extension);
  return name;
}

bool isFrame(const std::string& name) {
  const std::size_t digits = name.find_first_not_of("0123456789");
  return digits >= 6 && digits != std::string::npos && name.substr(digits) == ".png";
}

/// What an earlier call has left, which a new one may replace.
std::vector<std::string> framesIn(const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (isFrame(entry.path().filename().string())) found.push_back(entry.path().filename());
  return found;
}

}  // namespace

/// Writes the moments of a run as scenes and frames, in a thread of its own.
class SceneRecorder {
 public:
  /// \param scenes Folder to make and fill, when `options.scenes` asks for it.
  /// \throws Error when a folder cannot be made, or that of the frames holds other things.
  SceneRecorder(const report::ViewOptions& options, std::vector<MapPole> map, std::string title,
                fs::path scenes);
  /// Ends at once: frames that were not finished() are removed.
  ~SceneRecorder();

  bool wants(std::size_t scan) const { return wantsScene(scan) || wantsFrame(scan); }
  /// Hands a moment over; waits while too many are on their way.
  /// \throws Error when an earlier one could not be written.
  void add(report::LiveMoment moment);
  /// Waits for the last, then puts the frames in their place.
  /// \throws Error when any could not be written.
  void finish();

 private:
  bool wantsScene(std::size_t scan) const {
    return m_options.scenes > 0 && scan % static_cast<std::size_t>(m_options.scenes) == 0;
  }
  bool wantsFrame(std::size_t scan) const {
    return m_frames && scan % static_cast<std::size_t>(m_options.frameEvery) == 0;
  }
  void work();
  void writeAll();
  std::optional<report::LiveMoment> next();
  void stop(bool atOnce);

  report::ViewOptions m_options;
  std::vector<MapPole> m_map;
  std::string m_title;
  fs::path m_scenes;
  std::optional<OutputFolder> m_frames;

  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::deque<report::LiveMoment> m_waiting;
  bool m_closed = false;
  std::exception_ptr m_failure;
  std::thread m_thread;  ///< last: it uses all of the above
};

SceneRecorder::SceneRecorder(const report::ViewOptions& options, std::vector<MapPole> map,
                             std::string title, fs::path scenes)
    : m_options(options),
      m_map(std::move(map)),
      m_title(std::move(title)),
      m_scenes(std::move(scenes)) {
  if (!m_options.frames.empty())
    m_frames.emplace(m_options.frames, "frames", framesIn(m_options.frames), numbered(0, ".png"));
  std::error_code error;
  if (m_options.scenes > 0) fs::create_directory(m_scenes, error);
  if (error) throw Error(m_scenes.string() + ": cannot create the folder: " + error.message());
  m_thread = std::thread([this] { work(); });
}

SceneRecorder::~SceneRecorder() {
  stop(true);
}

void SceneRecorder::add(report::LiveMoment moment) {
  std::unique_lock<std::mutex> lock(m_mutex);
  m_changed.wait(lock, [&] { return m_failure || m_waiting.size() < mostWaiting; });
  if (m_failure) std::rethrow_exception(m_failure);
  m_waiting.push_back(std::move(moment));
  m_changed.notify_all();
}

void SceneRecorder::finish() {
  stop(false);
  if (m_failure) std::rethrow_exception(m_failure);
  if (m_frames) m_frames->commit();
}

void SceneRecorder::stop(bool atOnce) {
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_closed = true;
    if (atOnce) m_waiting.clear();
    m_changed.notify_all();
  }
  if (m_thread.joinable()) m_thread.join();
}

std::optional<report::LiveMoment> SceneRecorder::next() {
  std::unique_lock<std::mutex> lock(m_mutex);
  m_changed.wait(lock, [&] { return m_closed || !m_waiting.empty(); });
  if (m_waiting.empty()) return std::nullopt;
  report::LiveMoment moment = std::move(m_waiting.front());
  m_waiting.pop_front();
  m_changed.notify_all();
  return moment;
}

void SceneRecorder::work() {
  try {
    writeAll();
  } catch (...) {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_failure = std::current_exception();
    m_changed.notify_all();
  }
}

/// All of OpenGL stays in this thread.
void SceneRecorder::writeAll() {
  std::optional<report::FrameRenderer> renderer;
  if (m_frames)
    renderer.emplace(static_cast<unsigned>(m_options.width),
                     static_cast<unsigned>(m_options.height));
  // Two, as letters of frames are made larger before the picture is halved.
  std::optional<report::LiveScene> forScenes, forFrames;
  if (m_options.scenes > 0) forScenes.emplace(m_map, m_title);
  if (m_frames)
    forFrames.emplace(m_map, m_title,
                      report::FrameRenderer::textScale(static_cast<unsigned>(m_options.height)));
  while (const auto moment = next()) {
    if (wantsScene(moment->scan)) {
      forScenes->show(*moment);
      scene::save(*forScenes->scene(), m_scenes / numbered(moment->scan, ".3Dscene"));
    }
    if (wantsFrame(moment->scan)) {
      forFrames->show(*moment);
      renderer->render(*forFrames->scene(), m_frames->temporary() / numbered(moment->scan, ".png"));
    }
  }
}

RunView::RunView(const report::ViewOptions& options, WatchedRun run, const RunFolder& folder)
    : m_options(options), m_truth(run.truth) {
  m_options.validate();
  if (m_options.scenes > 0 || !m_options.frames.empty())
    m_recorder = std::make_unique<SceneRecorder>(m_options, run.map, run.name,
                                                 folder.staged("run_00_scenes"));
  if (m_options.live)
    m_player = std::make_unique<LivePlayer>(m_options, run.map, run.name, run.source,
                                            std::move(run.reading));
}

RunView::~RunView() = default;

void RunView::show(const LocalizationPipeline& localization, const PoleScan& frame,
                   const LocalizationUpdate& update, const WatchedScan& scan) {
  if (!m_player && !m_recorder) return;
  if (m_scan == 0) m_start = frame.time;
  std::optional<Pose2D> truth;
  if (m_truth) truth = poseAt(*m_truth, frame.time, longestTruthGap);
  m_way.add(update);
  m_trueWay.add(truth, false);
  const bool recorded = m_recorder && m_recorder->wants(m_scan);
  if (recorded || isOpen()) {
    auto moment = report::momentOf(localization, frame, update, m_scan, m_start);
    moment.truth = truth;
    if (isOpen()) m_player->add(moment, scan);
    moment.way = m_way.points();
    moment.trueWay = m_trueWay.points();
    if (recorded) m_recorder->add(std::move(moment));
  }
  ++m_scan;
}

void RunView::finish() {
  if (m_player) m_player->end();
  if (m_recorder) m_recorder->finish();
}

void RunView::waitForWindow() {
  if (m_player) m_player->wait(m_options.hold);
}

}  // namespace polemcl::apps
