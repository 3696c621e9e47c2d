#pragma once
/// \file SceneRecorder.h
/// \brief Writes the moments of a run as scenes and frames, in a thread of its own.

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/OutputFolder.h"
#include "report/scene/LiveMoment.h"
#include "report/scene/ViewOptions.h"

namespace polemcl::apps {

class SceneRecorder {
 public:
  /// \param scenes Folder to make and fill, when `options.scenes` asks for it.
  /// \throws Error when a folder cannot be made, or that of the frames holds other things.
  SceneRecorder(const report::ViewOptions& options, std::vector<MapPole> map, std::string title,
                std::filesystem::path scenes);
  /// \brief Ends at once: frames that were not finished() are removed.
  ~SceneRecorder();

  bool wants(std::size_t scan) const { return wantsScene(scan) || wantsFrame(scan); }
  /// \brief Hands a moment over; waits while too many are on their way.
  /// \throws Error when an earlier one could not be written.
  void add(report::LiveMoment moment);
  /// \brief Waits for the last, then puts the frames in their place.
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
  std::filesystem::path m_scenes;
  std::optional<OutputFolder> m_frames;

  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::deque<report::LiveMoment> m_waiting;
  bool m_closed = false;
  std::exception_ptr m_failure;
  std::thread m_thread;  ///< last: it uses all of the above
};

}  // namespace polemcl::apps
