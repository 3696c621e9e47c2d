#pragma once
// A small batch with all kinds of failures, with numbers that are easy to sum by hand.

#include <string>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// A run with position errors `pos` (mean), 2 `pos` (RMSE) and 3 `pos` (maximum); the same for
/// heading.
inline BatchRun runWith(std::size_t index, double pos, double ang) {
  BatchRun run;
  run.run = index;
  run.seed = 1000 + index;
  ErrorMetrics& errors = run.errors;
  errors.posMean = pos, errors.posRmse = 2 * pos, errors.posMax = 3 * pos, errors.posEnd = pos;
  errors.latMean = pos / 2, errors.latStd = pos / 4;
  errors.lonMean = pos / 2, errors.lonStd = pos / 4;
  errors.xRmse = 0.3 * pos, errors.yRmse = 0.4 * pos;
  errors.angMeanDeg = ang, errors.angStdDeg = ang, errors.angRmseDeg = 2 * ang;
  errors.poses = 100, errors.unmatched = 3;
  run.health = {0.9, 0.1, 0.0, 0, 1};
  return run;
}

inline BatchRun failedRun(std::size_t index, const std::string& reason) {
  BatchRun run;
  run.run = index;
  run.seed = 1000 + index;
  run.failure = reason;
  return run;
}

inline SessionPlots smallPlots() {
  SessionPlots plots;
  plots.mapPoles = {{1, 2}, {-3.25, 4}, {50, -20}};
  plots.truth = {{0, 0}, {40, 0}, {40, 30}};
  plots.estimate = {{0, 0.1}, {40.2, 0}, {40, 29.9}};
  plots.position = {10, {0.1, noFigure, 0.35, 0.2}};
  for (double error : {0.02, 0.03, 0.5}) plots.positionErrors.add(error);
  for (double error : {0.0, 0.4, 170.0}) plots.headingErrors.add(error);
  return plots;
}

/// A map of 8 poles against 10, of which 6 are correct; one to one 5, and 4 within half a metre.
inline MapScores smallScores() {
  const auto score = [](std::size_t matches) {
    MapScore one{8, 10, matches, matches / 8.0, matches / 10.0, 0};
    one.f1 = 2 * one.precision * one.recall / (one.precision + one.recall);
    return one;
  };
  return {"truth.csv", score(6), score(5), score(4)};
}

/// The small batch with a score of its first configuration's map, and published results for
/// sessions.
inline BatchResults smallBatch();
inline BatchResults scoredBatch() {
  BatchResults batch = smallBatch();
  batch.results[2].score = smallScores();
  batch.results[3].score = smallScores();
  batch.results[3].score->near = {8, 10, 8, 1.0, 0.8, 16 / 18.0};
  batch.published = {{"Dong et al. 2021", "two_2", 0.5, 0.12, 0.146, 0.626, 0.81},
                     {"Dong et al. 2021", "three", 0.25, 0.246, 0.354, 0.75, 0.982},
                     {"Dong et al. 2021", "another", 0.1, 9, 9, 9, 9},
                     {"Schaefer et al. 2019", "two_2", noFigure, 0.13, 0.178, 0.663, 0.857}};
  return batch;
}

/// Configuration 0: two runs in session 0, one of two failed in session 1, both lost in session 2.
/// Configuration 1: session 1 only.
inline BatchResults smallBatch() {
  BatchResults batch;
  batch.name = "small";
  batch.title = "Small & <odd> \"batch\"";
  batch.command = "pole-batch small.ini --data 'a&b' --output out";
  batch.versions = {"1.2.3", "2.5.8", "GCC 12.2"};
  batch.configurations = {
      {"plain", "no upkeep", "paper: own data in the map", "[map]\ncount = 6\n"},
      {"up_keep 100 %", "", "", ""}};
  batch.sessions = {{"one<&\">", "2012-01-08", 1500, 700, 8.25},
                    {"two_2", "", noFigure, 650, noFigure},
                    {"three", "2012-03-17", 1480.5, 690, 7}};
  const auto result = [](std::size_t configuration, std::size_t session, double share,
                         std::vector<BatchRun> runs) {
    SessionResult one;
    one.configuration = configuration, one.session = session, one.mapShare = share,
    one.mapPoles = 210;
    one.runs = std::move(runs);
    return one;
  };
  batch.results = {
      result(0, 0, 1.0, {runWith(0, 0.1, 0.2), runWith(1, 0.3, 0.4)}),
      result(0, 1, 0.25, {runWith(0, 0.4, 0.8), failedRun(1, "disk full, \"really\"")}),
      result(0, 2, noFigure, {runWith(0, 4.0, 1.0), BatchRun()}),
      result(1, 1, 0, {runWith(0, 0.2, 0.5)})};
  batch.results[0].plots = smallPlots();
  batch.failures = {{"localize plain/two_2/run 1", "disk full, \"really\"", "logs/a<b.log"}};
  return batch;
}

}  // namespace polemcl::report
