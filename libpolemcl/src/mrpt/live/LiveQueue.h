#pragma once
/// \file LiveQueue.h
/// \brief Between the sensors, each in a thread of its own, and the one who takes their scans.

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "mrpt/rawlog/EntrySource.h"

namespace polemcl {

struct LiveQueueOptions {
  /// Sensor labels of the LiDARs to be fused; empty: one LiDAR with any label.
  std::vector<std::string> lidars = {};
  /// Most scans of each LiDAR that wait; one more drops the oldest. Half a second of a LiDAR of 10
  /// Hz: short interruptions drop nothing, and under lasting overload no scan waits longer than
  /// that.
  std::size_t longest = 5;
  /// Longest wait of a scan for odometry of its time, s. Odometry usually is there before: the time
  /// of a scan is that of its first beam.
  double odometryWait = 0.2;
  /// Asked every few milliseconds, from the taking thread. False ends the drive at once.
  std::function<bool()> goesOn = {};
  /// What is not right but does not end the drive. From any thread.
  std::function<void(const std::string&)> warn = {};
};

/// \brief Times of sensors that never go far back: where a clock is set back, they go on as the
/// time of arrival does. All sensors of one clock get the same offset, so what belongs together
/// stays so. Times that jump and then agree with the computer's clock, counted from the start of
/// the drive, get no offset: a clock that was wrong for a while does not last. They may go back
/// then.
class SteadyTimes {
 public:
  using Clock = std::chrono::steady_clock;
  /// \brief An observation may be this late without a clock that was set back, s.
  static constexpr double kLatest = 3;
  /// \param now Time of the computer's clock at the moment `at`, s.
  explicit SteadyTimes(double now = mrpt::Clock::nowDouble(), Clock::time_point at = Clock::now())
      : m_now(now), m_at(at) {}
  /// \param time As the sensor states it, s. \return What to count it for, s.
  double of(const std::string& sensor, double time, Clock::time_point arrival);
  /// \brief Whether the last time is far before the one before it, of the same sensor.
  bool wentBack() const { return m_wentBack; }
  /// \brief What is added to the times of a sensor, s.
  double offset(const std::string& sensor) const;

 private:
  struct Sensor {
    double offset = 0, last = 0;  ///< s
    Clock::time_point arrival;    ///< of the last observation
  };
  double m_now;  ///< s
  Clock::time_point m_at;
  std::map<std::string, Sensor> m_sensors;
  double m_offset = 0;  ///< since the last step of a clock, s
  bool m_wentBack = false;
};

/// \brief Scans in the order of their times, each after the odometry of its time. Odometry is given
/// as it comes, so no motion is lost with a scan; only of more than `kMostReadings` that wait the
/// oldest are dropped. Other observations are not used.
class LiveQueue : public EntrySource {
 public:
  static constexpr std::size_t kMostReadings = 100'000;  ///< a quarter of an hour at 100 Hz

  explicit LiveQueue(LiveQueueOptions options = {});

  /// \brief From any thread. A scan older than the last one of its LiDAR that was taken is dropped.
  /// A scan of another sensor than those of the options is a failure.
  void push(const mrpt::obs::CObservation::Ptr& observation);
  /// \brief The first sensor has come to its end, or failed with this message: what waits is still
  /// taken, then the drive ends. Only the first call counts. From any thread.
  void end(const std::string& failure = "");
  /// \brief Why the drive ended; empty when no sensor has failed.
  std::string failure() const;

  /// \brief Waits for the next observation. \return false when the drive has ended.
  bool next(RawlogEntry& entry) override;
  void stop() override;
  bool isLive() const override { return true; }
  const std::string& comment() const override { return m_comment; }
  std::size_t dropped() const override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    double time;  ///< of the observation, s
    Clock::time_point arrival;
    mrpt::obs::CObservation::Ptr observation;
  };
  double steadyTime(mrpt::obs::CObservation& observation, std::string& warning);
  void forgetFuture(const std::string& label);
  void pushScan(Waiting scan);
  bool isExpected(const std::string& label);
  void endNow(const std::string& failure);
  bool isDue(const Waiting& scan) const;

  const LiveQueueOptions m_options;
  const std::string m_comment;
  mutable std::mutex m_mutex;  ///< of all below
  std::condition_variable m_changed;
  SteadyTimes m_times;
  std::deque<Waiting> m_scans;  ///< in the order of their times
  std::deque<mrpt::obs::CObservation::Ptr> m_odometry;
  std::optional<double> m_reached;        ///< time of the latest odometry that is used, s
  std::string m_odometryLabel;            ///< of its sensor
  std::optional<std::string> m_label;     ///< of the first scan
  std::map<std::string, double> m_taken;  ///< time of the last scan taken, s, by label
  std::size_t m_dropped = 0;
  bool m_ended = false;
  std::string m_failure;
};

}  // namespace polemcl
