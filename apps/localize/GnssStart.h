#pragma once
/// \file GnssStart.h
/// \brief Where a drive starts, by a position from satellites in its rawlog.

#include <filesystem>

#include "core/global_localization/GlobalLocalizer.h"
#include "io/map/Datum.h"

namespace polemcl::apps {

/// \brief Where the robot was at its first scan, by the usable fix within 50 km of the datum that
/// is nearest in time.
///
/// The radius is five standard deviations of the fix, 10 m for errors that last, the way of a fast
/// vehicle (40 m/s) between fix and scan, and the distance of the antenna from the robot's origin.
/// \param firstScan s. \param datum Of the map.
/// \throws Error when there is no such fix, or it is more than 5 s from the first scan.
SearchArea gnssStart(const std::filesystem::path& rawlog, bool allowTruncated, double firstScan,
                     const io::Datum& datum);

}  // namespace polemcl::apps
