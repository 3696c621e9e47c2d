#pragma once
/// \file ComparedFigures.h
/// \brief The columns in which ours and published figures stand beside each other.

#include <polemcl/report/BatchSummary.h>
#include <polemcl/report/PublishedFigures.h>

#include <vector>

namespace polemcl::report {

/// \brief A column of the comparison.
struct ComparedColumn {
  const char* html;
  const char* latex;
  double PublishedFigure::*published;
  Spread FigureSpreads::*ours;
};

/// \brief The columns for which any system has a published figure, in the papers' order; the RMSE
/// in the plane stands before one per axis, which is no measure by itself.
std::vector<ComparedColumn> comparedColumns(const PublishedDataset& dataset);

}  // namespace polemcl::report
