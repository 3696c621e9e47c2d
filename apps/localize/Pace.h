#pragma once
/// \file Pace.h
/// \brief The clock by which a recording is played.

#include <functional>
#include <optional>

#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief Lets scans through when they are due: as far apart as their times, divided by the rate.
/// The clock starts with the first scan and goes on while scans are worked on: where the work is
/// too slow, the scans after it are late, and are let through at once until that is made up for.
class Pace {
 public:
  static constexpr double longestGap = 2;  ///< s of the recording; longer gaps are cut to this

  /// \param rate Times as fast as it was recorded; none: no scan waits.
  /// \param goesOn False from the moment on that no scan is to wait any more; may be empty.
  explicit Pace(std::optional<double> rate, std::function<bool()> goesOn = {});

  /// \brief Waits until the scan of this time (s) is due, or `work` gives false: it has failed.
  /// \return When it was due; without a rate, now.
  ScanClock::time_point waitFor(double time, const std::function<bool()>& work = {});
  /// \brief The same without the wait.
  ScanClock::time_point dueOf(double time);
  /// \brief The clock starts again with the next scan.
  void restart() { m_time.reset(); }

 private:
  std::optional<double> m_rate;
  std::function<bool()> m_goesOn;
  std::optional<double> m_time;  ///< of the last scan, s
  ScanClock::time_point m_due;   ///< the last scan
};

}  // namespace polemcl::apps
