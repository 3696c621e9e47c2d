#include "ComparedFigures.h"

#include <algorithm>
#include <cmath>

namespace polemcl::report {

std::vector<ComparedColumn> comparedColumns(const PublishedDataset& dataset) {
  using P = PublishedFigure;
  using F = FigureSpreads;
  static const ComparedColumn all[] = {
      {"Δ<sub>pos</sub> (m)", "$\\Delta_\\mathrm{pos}$ [m]", &P::posMean, &F::posMean},
      {"RMSE<sub>pos</sub> (m)", "$\\mathrm{RMSE}_\\mathrm{pos}$ [m]", &P::posRmse, &F::posRmse},
      {"RMSE per axis (m)", "$\\mathrm{RMSE}_\\mathrm{axis}$ [m]", &P::axisRmse, &F::axisRmse},
      {"Δ<sub>lat</sub> (m)", "$\\Delta_\\mathrm{lat}$ [m]", &P::latMean, &F::latMean},
      {"σ<sub>lat</sub> (m)", "$\\sigma_\\mathrm{lat}$ [m]", &P::latStd, &F::latStd},
      {"Δ<sub>lon</sub> (m)", "$\\Delta_\\mathrm{lon}$ [m]", &P::lonMean, &F::lonMean},
      {"σ<sub>lon</sub> (m)", "$\\sigma_\\mathrm{lon}$ [m]", &P::lonStd, &F::lonStd},
      {"Δ<sub>ang</sub> (°)", "$\\Delta_\\mathrm{ang}$ [$^\\circ$]", &P::angMeanDeg,
       &F::angMeanDeg},
      {"σ<sub>ang</sub> (°)", "$\\sigma_\\mathrm{ang}$ [$^\\circ$]", &P::angStdDeg, &F::angStdDeg},
      {"RMSE<sub>ang</sub> (°)", "$\\mathrm{RMSE}_\\mathrm{ang}$ [$^\\circ$]", &P::angRmseDeg,
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

}  // namespace polemcl::report
