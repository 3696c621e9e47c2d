#include "report/batch/ComparedResults.h"

#include <algorithm>
#include <cmath>

#include "report/batch/NumberFormat.h"

namespace polemcl::report {
namespace {

/// "1 run", "2 runs"; digits alone, for LaTeX as well.
std::string counted(std::size_t count, const std::string& word) {
  return std::to_string(count) + ' ' + word + (count == 1 ? "" : "s");
}

/// "2 sessions, 10 runs of each", "3 sessions, 7 runs in all", "1 session, 1 run".
std::string sampleText(const ConfigurationSummary& summary) {
  std::size_t sessions = 0, most = 0;
  for (const SessionSummary& session : summary.sessions) {
    sessions += session.counts.runs > 0;
    most = std::max(most, session.counts.runs);
  }
  if (sessions == 0) return "no session localized";
  const std::string runs = sessions == 1 ? counted(most, "run")
                           : summary.counts.runs == most * sessions
                               ? counted(most, "run") + " of each"
                               : counted(summary.counts.runs, "run") + " in all";
  const std::string figures =
      summary.localized < sessions ? std::to_string(summary.localized) + " with figures of " : "";
  return figures + counted(sessions, "session") + ", " + runs;
}

std::string withProtocol(const std::string& text, const BatchConfiguration& configuration) {
  const std::string& protocol = configuration.protocol;
  return text + '.' + (protocol.empty() ? "" : ' ' + sentence(protocol));
}

}  // namespace

std::vector<ComparedColumn> comparedColumns(const PublishedDataset& dataset) {
  using P = PublishedResult;
  using F = MetricSpreads;
  static const ComparedColumn all[] = {
      {"Δ<sub>pos</sub>", "$\\Delta_\\mathrm{pos}$", Quantity::length, &P::posMean, &F::posMean},
      {"RMSE<sub>pos</sub>", "$\\mathrm{RMSE}_\\mathrm{pos}$", Quantity::length, &P::posRmse,
       &F::posRmse},
      {"RMSE per axis", "$\\mathrm{RMSE}_\\mathrm{axis}$", Quantity::length, &P::axisRmse,
       &F::axisRmse},
      {"Δ<sub>lat</sub>", "$\\Delta_\\mathrm{lat}$", Quantity::length, &P::latMean, &F::latMean},
      {"σ<sub>lat</sub>", "$\\sigma_\\mathrm{lat}$", Quantity::length, &P::latStd, &F::latStd},
      {"Δ<sub>lon</sub>", "$\\Delta_\\mathrm{lon}$", Quantity::length, &P::lonMean, &F::lonMean},
      {"σ<sub>lon</sub>", "$\\sigma_\\mathrm{lon}$", Quantity::length, &P::lonStd, &F::lonStd},
      {"Δ<sub>ang</sub>", "$\\Delta_\\mathrm{ang}$", Quantity::angle, &P::angMeanDeg,
       &F::angMeanDeg},
      {"σ<sub>ang</sub>", "$\\sigma_\\mathrm{ang}$", Quantity::angle, &P::angStdDeg, &F::angStdDeg},
      {"RMSE<sub>ang</sub>", "$\\mathrm{RMSE}_\\mathrm{ang}$", Quantity::angle, &P::angRmseDeg,
       &F::angRmseDeg}};
  const auto has = [&](double P::*figure) {
    return std::any_of(dataset.figures.begin(), dataset.figures.end(),
                       [&](const P& system) { return std::isfinite(system.*figure); });
  };
  std::vector<ComparedColumn> columns;
  for (const ComparedColumn& column : all)
    if (has(column.published) || (column.published == &P::posRmse && has(&P::axisRmse)))
      columns.push_back(column);
  return columns;
}

double PublishedRows::figure(std::size_t system, const SessionSummary& session,
                             double PublishedSession::*figure) const {
  const PublishedSession* one =
      find(results.published, systems[system], results.sessions[session.session].name);
  return one && session.counts.runs > 0 ? one->*figure : noFigure;
}

double PublishedRows::mean(std::size_t system, const ConfigurationSummary& configuration,
                           double PublishedSession::*wanted) const {
  std::vector<double> values;
  for (const SessionSummary& session : configuration.sessions)
    if (session.figures.posMean.count > 0) values.push_back(figure(system, session, wanted));
  return spreadOf(values).mean;
}

std::string rowText(const BatchConfiguration& configuration, const ConfigurationSummary& summary) {
  std::string text = sampleText(summary);
  if (summary.counts.lost > 0) text += ", " + std::to_string(summary.counts.lost) + " wrong";
  if (summary.counts.failed > 0) text += ", " + std::to_string(summary.counts.failed) + " failed";
  return withProtocol(text, configuration);
}

std::string scoreRowText(const BatchConfiguration& configuration,
                         const ConfigurationSummary& summary) {
  const std::size_t maps = summary.scores.maps;
  return withProtocol((maps > 1 ? "Mean of " : "") + counted(maps, "map"), configuration);
}

PublishedRows publishedRows(const BatchResults& results) {
  return {publishedSystems(results.published), results};
}

MetricColumn unitOf(const SessionColumn& column, const ConfigurationSummary& configuration,
                    const PublishedRows& published) {
  std::vector<double> values;
  for (const SessionSummary& session : configuration.sessions) {
    values.push_back((session.figures.*column.ours).mean);
    for (std::size_t i = 0; i < published.systems.size(); ++i)
      values.push_back(published.figure(i, session, column.published));
  }
  return {column.quantity, values};
}

MetricColumn unitOf(const ComparedColumn& column, const PublishedDataset& dataset,
                    const Summaries& summaries) {
  std::vector<double> values;
  for (const PublishedResult& system : dataset.figures) values.push_back(system.*column.published);
  for (const ConfigurationSummary& summary : summaries)
    values.push_back((summary.figures.*column.ours).mean);
  return {column.quantity, values};
}

}  // namespace polemcl::report
