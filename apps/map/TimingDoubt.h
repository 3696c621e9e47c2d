#pragma once
/// \file TimingDoubt.h
/// \brief Do the poles of a drive say that the timing of its scans is wrong?

#include <string>

#include "core/sensor/TimingSearch.h"
#include "map/MappingSession.h"

namespace polemcl::apps {

/// \brief The timing that fits the poles of a drive best, beyond what its scans were corrected by.
/// Its poses may drift. Where no odometry is, it has no clock that differs.
TimingEstimate remainingTiming(const MappingSession& drive, double turnSeconds);

/// \brief Another offset between the clocks of scans and odometry, or a turn of the LiDAR that
/// nobody corrected.
/// \param dead By dead reckoning. Only this shows the clocks: poses that poles made better follow
///             the scans.
/// \param mapped At the poses that were found, which may show the turn more clearly.
/// \param timing What the settings say.
/// \param looksRaw The order of the points tells the turn, which is not named here then.
/// \return A sentence for people; empty when there is nothing to say.
std::string timingDoubt(const TimingEstimate& dead, const TimingEstimate& mapped,
                        const ScanTiming& timing, bool looksRaw = false);

/// \brief The same of a drive at its true poses: about a turn, or about clocks where these explain
/// it better.
std::string timingDoubtOfTruth(const MappingSession& drive, const ScanTiming& timing);

}  // namespace polemcl::apps
