#pragma once
/// \file UntoldTurn.h
/// \brief Scans that look raw though nothing says how their LiDAR turned, or where it was cut.

#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <optional>
#include <vector>

#include <polemcl/core/sensor/SensorOptions.h>
#include "core/sensor/PointOrder.h"

namespace polemcl {

/// \brief The scans of one LiDAR are taken as corrected for the motion during a turn, or as cut at
/// one azimuth. But their points are in the order of measuring and begin at azimuths far apart.
struct UntoldTurn {
  Turn turn = Turn::clockwise;  ///< or counterclockwise, in the frame of the clouds
  double arc = 0;               ///< in which the scans begin, rad
  bool hasSetCut = false;       ///< the settings state the azimuth of the cut
};

/// \brief Looks at a few scans of one LiDAR, ever farther apart: it takes milliseconds for each.
class UntoldTurnSearch {
 public:
  /// \param ordinal 0-based number of the scan. The first one may be cut short.
  static bool wants(std::size_t ordinal);
  /// \brief One of the scans that are wanted.
  /// \param order pointOrder() of its points; none also where its timing is told.
  void add(const std::optional<PointOrder>& order);
  /// \brief None unless at least three scans were whole turns, and all of them tell the same one.
  /// \param set What the settings say of this LiDAR.
  std::optional<UntoldTurn> found(const ScanTiming& set) const;

 private:
  std::vector<PointOrder> m_orders;
  bool m_isOther = false;  ///< one scan told no turn
};

/// \brief The order of the points of a scan. None of points in another order, of depth images, and
/// where the settings, the rawlog or the scan itself tell the timing; but of scans that are cut at
/// one azimuth by the settings, to see whether they are.
/// \param recorded As the rawlog states it.
std::optional<PointOrder> untoldOrder(const mrpt::obs::CObservation& scan,
                                      const SensorOptions& sensor, const ScanTiming& recorded);

}  // namespace polemcl
