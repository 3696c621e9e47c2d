#pragma once
/// \file ComparedResults.h
/// \brief The columns in which ours and published figures stand beside each other.

#include <vector>

#include "report/batch/BatchSummary.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/PublishedResults.h"

namespace polemcl::report {

/// \brief A column of the comparison.
struct ComparedColumn {
  const char* html;   ///< without its unit
  const char* latex;  ///< the same
  Quantity quantity;  ///< m or degrees
  double PublishedResult::*published;
  Spread MetricSpreads::*ours;
};

/// \brief The columns for which any system has a published figure, in the papers' order; the RMSE
/// in the plane stands before one per axis, which is no measure by itself.
std::vector<ComparedColumn> comparedColumns(const PublishedDataset& dataset);

/// \brief A column of the paper's table of sessions.
struct SessionColumn {
  const char* html;   ///< without its unit
  const char* latex;  ///< the same
  Quantity quantity;  ///< m or degrees
  double PublishedSession::*published;
  Spread MetricSpreads::*ours;
};
inline constexpr SessionColumn sessionColumns[] = {
    {"Δ<sub>pos</sub>", "$\\Delta_\\mathrm{pos}$", Quantity::length, &PublishedSession::posMean,
     &MetricSpreads::posMean},
    {"RMSE<sub>pos</sub>", "$\\mathrm{RMSE}_\\mathrm{pos}$", Quantity::length,
     &PublishedSession::posRmse, &MetricSpreads::posRmse},
    {"Δ<sub>ang</sub>", "$\\Delta_\\mathrm{ang}$", Quantity::angle, &PublishedSession::angMeanDeg,
     &MetricSpreads::angMeanDeg},
    {"RMSE<sub>ang</sub>", "$\\mathrm{RMSE}_\\mathrm{ang}$", Quantity::angle,
     &PublishedSession::angRmseDeg, &MetricSpreads::angRmseDeg}};

/// \brief What was published for the sessions of a configuration, system by system; sessions that
/// were not localized have no figures.
struct PublishedRows {
  std::vector<std::string> systems;
  /// \brief A figure of a system for one of the configuration's sessions; noFigure where none was
  /// published.
  double figure(std::size_t system, const SessionSummary& session,
                double PublishedSession::*figure) const;
  /// \brief Its mean over the sessions of which ours has a figure as well.
  double mean(std::size_t system, const ConfigurationSummary& configuration,
              double PublishedSession::*figure) const;
  const BatchResults& results;
};
PublishedRows publishedRows(const BatchResults& results);

/// \brief What a row of this batch is a mean of, as plain text: "2 sessions, 10 runs of each, 1
/// lost. One map of 2 sessions."
std::string rowText(const BatchConfiguration& configuration, const ConfigurationSummary& summary);
/// \brief The same for the scores of its maps: "Mean of 11 maps. A map of each session."
std::string scoreRowText(const BatchConfiguration& configuration,
                         const ConfigurationSummary& summary);

/// \brief The figures of a column that decide on its unit: ours and those published.
MetricColumn unitOf(const SessionColumn& column, const ConfigurationSummary& configuration,
                    const PublishedRows& published);
MetricColumn unitOf(const ComparedColumn& column, const PublishedDataset& dataset,
                    const Summaries& summaries);

}  // namespace polemcl::report
