#pragma once
/// \file ErrorStrip.h
/// \brief Errors over the distance driven, as strips of a plot.

#include <string>
#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"
#include "report/picture/PlotAxes.h"

namespace polemcl::report {

/// \brief Distance driven along the true path at the time of each error, m; constant outside it.
std::vector<double> distanceDriven(const std::vector<StampedPose2D>& truth,
                                   const std::vector<PoseError>& errors);

/// \brief A value over the distance; both of one size.
struct ErrorSeries {
  std::string name;              ///< "position"
  std::string title;             ///< of the axis, with unit: "position (cm)"
  std::string unit;              ///< after numbers: " cm"
  std::vector<double> distance;  ///< m, increasing
  std::vector<double> values;    ///< not negative
  double mean = 0;
};
/// \brief Upper end of the value axis: a little above the largest value, but not above 2.2 times
/// the 95th percentile, so that the first moments of a search do not flatten the rest.
/// \param values Not empty.
double valueLimit(const std::vector<double>& values);
/// \brief Draws the series and its mean; above the frame (30 px), mean and maximum in words.
/// \param withDistances Labels and title of the distance axis, below the frame.
void drawErrorStrip(Canvas& canvas, const Rect& frame, const ErrorSeries& series,
                    const Color& color, bool withDistances);

}  // namespace polemcl::report
