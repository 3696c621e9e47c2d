#include "localize/SceneRecorder.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "mrpt/drawing/SceneParts.h"
#include "report/scene/FrameRenderer.h"
#include "report/scene/LiveScene.h"

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

}  // namespace polemcl::apps
