#pragma once
/// \file PlayerPanels.h
/// \brief What a player shows over a LiveScene: the time line of the run, and help on the keys.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <polemcl/mrpt/common/Compatibility.h>
#include "report/scene/Playback.h"

namespace polemcl::report {

/// \brief A run, in columns of the same length of time.
struct TimeLine {
  struct Column {
    std::optional<HealthState> state;  ///< the worst; nothing where the run has not been
    std::optional<double> error;       ///< of the position, the largest, m
  };
  double length = 0;  ///< of the whole run as far as it is known, s
  std::vector<Column> columns;
  double shown = 0;  ///< the scan that is shown, as a share of the length
  double limit = 0;  ///< upper end of the errors, m; 0 without
};

/// \param errors At each scan, m; negative where unknown. \param expected Scans of the whole run;
/// 0: not known.
TimeLine makeTimeLine(const Playback& playback, const std::vector<float>& errors,
                      std::size_t expected);

/// \brief `scan 13 of about 239, 1.3 s, paused`: as the files of results count, from 0 to the last.
std::string describe(const Playback& playback, std::size_t expected);

/// \brief Panel `player` along the upper edge: the words, errors if there are any, health by
/// colours, times in s, and a line at what is shown.
void showTimeLine(viz::Scene& scene, const TimeLine& line, const std::string& words);
/// \brief Panel `help` in the upper right corner, below the other one. No lines: none.
void showKeys(viz::Scene& scene, const std::vector<std::string>& lines, bool withErrors);

}  // namespace polemcl::report
