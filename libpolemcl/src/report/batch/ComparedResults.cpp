#include "report/batch/ComparedResults.h"

#include <algorithm>
#include <cmath>

namespace polemcl::report {

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
