#pragma once
/// \file ReportParts.h
/// \brief The parts of a batch's report, as HTML: sentences, cards, tables and plots. A plot is a
/// `<figure>` with legend and caption.

#include <string>
#include <vector>

#include "report/batch/BatchSummary.h"

namespace polemcl::report {

extern const char* const reportStyle;

/// \brief The main figures, what was lost, how the last session compares with the first: HTML.
std::string headlines(const BatchResults& results, const Summaries& summaries);
/// \brief A card for each configuration.
std::string configurationCards(const BatchResults& results, const Summaries& summaries);
/// \brief A session's figures in a few words, for the head of its fold: HTML.
std::string sessionLine(const BatchResults& results, const Summaries& summaries,
                        std::size_t session);

/// \brief One row for each configuration: what it comes to.
std::string configurationsTable(const BatchResults& results, const Summaries& summaries);
/// \brief Sessions with all configurations side by side.
std::string sideBySideTable(const BatchResults& results, const Summaries& summaries);
/// \brief The paper's table: f_map, mean and RMSE of position and heading for each session, with
/// the figures published for it beside ours.
std::string paperTable(const BatchResults& results, std::size_t configuration,
                       const ConfigurationSummary& summary);
/// \brief Published figures and ours; empty when none are known for the dataset.
std::string publishedTable(const BatchResults& results, const Summaries& summaries);
/// \brief Scores of the maps of each configuration, below published ones; empty when none was
/// scored.
std::string mapScoresTable(const BatchResults& results, const Summaries& summaries);
/// \brief The score of every map; empty when no configuration has more than one.
std::string everyScoreTable(const BatchResults& results);
/// \brief What the runs said of themselves, for each session.
std::string healthTable(const BatchResults& results, std::size_t configuration,
                        const ConfigurationSummary& summary);
/// \brief Every run of a configuration, with its seed.
std::string runsTable(const BatchResults& results, std::size_t configuration);
/// \brief Tasks that failed and runs that were lost; empty without any.
std::string troublesTables(const BatchResults& results);
std::string sessionsTable(const BatchResults& results);
std::string timingsTable(const BatchTimings& timings);
/// \brief Keys of the effective INI texts whose values are not the same in all configurations;
/// empty when there are none.
std::string differencesTable(const BatchResults& results);

/// \brief "+8 %" for 1.08, "−3 %" for 0.97, "17 times" for 17.
std::string changeText(double ratio);
/// \brief "10", "10, 1 wrong", "10, 2 failed".
std::string runsText(const RunCounts& counts);

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
std::string sessionsFigure(const BatchResults& results, const Summaries& summaries,
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
