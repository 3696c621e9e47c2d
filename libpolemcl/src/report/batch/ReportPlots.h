#pragma once
/// \file ReportPlots.h
/// \brief The plots of a batch's report, each a `<figure>` with legend and caption.

#include <string>
#include <vector>

#include "report/batch/BatchSummary.h"

namespace polemcl::report {

/// \brief Gives each plot of a page an id of its own.
class PlotIds {
 public:
  std::string next() { return "p" + std::to_string(++m_count); }

 private:
  std::size_t m_count = 0;
};

/// \brief A figure that is plotted for every session.
struct SessionQuantity {
  std::string name;  ///< "mean position error"
  std::string unit;  ///< "m"
  Spread MetricSpreads::*spread;
};
/// \brief Mean and standard deviation over the runs of each session, for all configurations.
std::string sessionsFigure(const BatchResults& results,
                           const std::vector<ConfigurationSummary>& summaries,
                           const SessionQuantity& quantity, PlotIds& ids);

/// \brief Which errors a histogram shows.
struct HistogramQuantity {
  std::string name;  ///< "position error"
  std::string unit;  ///< "m" or "°"
  ErrorHistogram SessionPlots::*histogram;
};
/// \brief Shares of the poses of all runs and sessions, for all configurations; empty without any.
std::string histogramFigure(const BatchResults& results, const HistogramQuantity& quantity,
                            PlotIds& ids);

/// \brief Error of run 0 over the distance driven, for all configurations; empty without any.
std::string distanceFigure(const BatchResults& results, std::size_t session, PlotIds& ids);

/// \brief Map, true path and estimate of run 0; empty when there is nothing to draw.
std::string mapFigure(const BatchResults& results, const SessionResult& result, PlotIds& ids);
/// \brief What the shapes in mapFigure() mean.
std::string mapLegend();

}  // namespace polemcl::report
