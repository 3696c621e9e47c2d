#pragma once
/// \file PoleClassifier.h
/// \brief How likely a candidate is a pole: boosted decision trees. Private to the library.

#include <array>

namespace polemcl {

/// \brief What the score looks at. Heights in m above local ground.
struct PoleFeatures {
  // Known from segments and from what surrounds the candidate.
  double segments = 1, points = 1;
  double extent = 0;         ///< from the lowest to the highest segment, m
  double passed = 0;         ///< share of the rows between that saw through
  double wide = 0;           ///< share of the rows between that met something wide
  double notWhole = 0;       ///< share of the segments with a side that is not free
  double scatter = 0;        ///< of the segments around a straight line, m
  double widthSpread = 0;    ///< m
  double tilt = 0;           ///< rad
  double top = 0;            ///< m
  double missingTop = 0;     ///< how far the top is below what a pole must have, m
  double bottom = 0;         ///< m
  double roughRadius = 0;    ///< before the fit, m
  double range = 0;          ///< m
  double columnWidth = 0.1;  ///< one firing step at that range, m
  double hiddenEdges = 0;    ///< share of the edges of the segments fitted that are not free
  // Known only when the surroundings were looked at and the cylinder was fitted.
  double clutter = 0;   ///< share of the rows with something in the ring around
  double residual = 0;  ///< of the fit, m
  double radius = 0.1;  ///< fitted, m
};

/// \brief What the trees see: functions of the features.
enum class ClassifierTerm : unsigned char {
  one,
  logSegments,
  logPoints,
  extent,
  passed,
  wide,
  notWhole,
  scatter,
  widthSpread,
  lowTop,
  roughRadius,
  top,
  bottom,
  clutter,
  excess,
  highBottom,
  tilt,
  range,
  radius,
  density,
  count_  ///< number of terms
};
constexpr int kClassifierTerms = static_cast<int>(ClassifierTerm::count_);
using ClassifierTerms = std::array<double, kClassifierTerms>;

/// \brief Name as in trees.csv.
const char* name(ClassifierTerm term);
/// \brief The terms of a candidate, before any scaling.
ClassifierTerms classifierTerms(const PoleFeatures& features);

/// \brief Log odds by trees of their own from what is known before the fit; clearly low ones need
/// no fit.
double roughOdds(const PoleFeatures& features);
/// \brief Log odds of a pole, ln(p / (1 - p)): the sum of the trees (gradient boosting, Friedman
/// 2001). It never grows with clutter.
double poleOdds(const PoleFeatures& features);

}  // namespace polemcl
