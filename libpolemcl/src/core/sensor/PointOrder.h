#pragma once
/// \file PointOrder.h
/// \brief How a LiDAR turned, as the order of the points of a scan tells it.

#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/sensor/SensorOptions.h>

namespace polemcl {

/// \brief A turn whose points are in the order in which they were measured.
struct PointOrder {
  Turn turn = Turn::clockwise;  ///< or counterclockwise
  double begin = 0;             ///< azimuth of the first point, rad, frame of the points
  double arc = 0;               ///< of the turn that has points, rad
  double sweep = 0;             ///< from the first firing to the last, rad: arc and what has none
  /// Whether less than a sixth of the turn lacks points, so that `begin` is where it was cut.
  bool isWhole() const;
};

/// \brief None unless the azimuths of successive points make one turn, or a part of it where
/// returns are missing: rings one after the other make as many turns as there are, mixed points
/// none.
std::optional<PointOrder> pointOrder(const PointsView& points);

/// \brief A scan, or a turn of it.
struct OneTurn {
  PointsView points;
  double begin = 0;  ///< azimuth at which it begins, rad, frame of the points
};

/// \brief One turn of a scan that has more, as from drivers that count packets; else the scan.
/// \param order pointOrder() of the points.
/// \param stamp Which turn, in [0, 1]: 0 the first, 1 the last, 0.5 the one in the middle. If it is
///        the moment of the time stamp, it is the same moment of the turn that is left.
OneTurn oneTurn(const PointsView& points, const PointOrder& order, double stamp);

/// \brief The arc in which turns begin, rad; 0 if they turn different ways, or there are none.
double beginArc(const std::vector<PointOrder>& orders);

/// \brief Scans with a longer sweep have more than one turn, rad.
constexpr double kMoreThanATurn = 375 * 3.14159265358979323846 / 180;

/// \brief Turns of one LiDAR that begin farther apart were not cut at one azimuth, rad: lasers of
/// one firing differ less.
constexpr double kMovingBegin = 10 * 3.14159265358979323846 / 180;

}  // namespace polemcl
