#pragma once
/// \file ReportTables.h
/// \brief The tables of a batch's report.

#include <string>
#include <vector>

#include "report/batch/BatchSummary.h"

namespace polemcl::report {

/// \brief One row for each configuration: what it comes to.
std::string configurationsTable(const BatchResults& results,
                                const std::vector<ConfigurationSummary>& summaries);
/// \brief Sessions with all configurations side by side.
std::string sideBySideTable(const BatchResults& results,
                            const std::vector<ConfigurationSummary>& summaries);
/// \brief The paper's table: f_map, mean and RMSE of position and heading for each session, with
/// the figures published for it beside ours.
std::string paperTable(const BatchResults& results, std::size_t configuration,
                       const ConfigurationSummary& summary);
/// \brief Published figures and ours; empty when none are known for the dataset.
std::string publishedTable(const BatchResults& results,
                           const std::vector<ConfigurationSummary>& summaries);
/// \brief Scores of the maps of each configuration, below published ones; empty when none was
/// scored.
std::string mapScoresTable(const BatchResults& results,
                           const std::vector<ConfigurationSummary>& summaries);
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

/// \brief "+8 %" for 1.08, "−3 %" for 0.97.
std::string changeText(double ratio);
/// \brief "10", "10, 1 lost", "10, 2 failed".
std::string runsText(const RunCounts& counts);

}  // namespace polemcl::report
