#pragma once
/// \file GnssFixes.h
/// \brief Positions from satellites in rawlogs.

#include <mrpt/obs/CObservationGPS.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/common/GnssFix.h"

namespace polemcl {

/// \brief All CObservationGPS of a rawlog that have a time, single ones and those in frames, in the
/// order of their times.
/// \throws Error as RawlogReader.
std::vector<mrpt::obs::CObservationGPS::Ptr> readGnssObservations(const std::string& rawlog,
                                                                  bool allowTruncated);

/// \brief The positions in the GGA messages of readGnssObservations(). Those that are not finite or
/// not on the globe are left out, as are those of quality 0 (none), 6 (dead reckoning), 7 (entered
/// by hand) and 8 (simulated).
///
/// Receivers state no sigma in this message. These figures are assumed: 0.02 m for quality 4 (RTK),
/// 0.3 m for quality 5 (RTK, float), 1 m times HDOP for quality 2 (differential), 2.5 m times HDOP
/// for the others. An HDOP that is not stated counts as 1.
/// \throws Error as RawlogReader.
std::vector<GnssFix> readGnssFixes(const std::string& rawlog, bool allowTruncated);

/// \brief The first of these positions in the order of the file that is accepted; reads no farther.
std::optional<GnssFix> findGnssFix(const std::string& rawlog, bool allowTruncated,
                                   const std::function<bool(const GnssFix&)>& accept);

/// \brief The observation, labelled `gnss`, for which readGnssFixes() gives this fix: of quality 1,
/// with the HDOP of its sigma. It has no height.
mrpt::obs::CObservationGPS::Ptr gnssObservation(const GnssFix& fix);

}  // namespace polemcl
