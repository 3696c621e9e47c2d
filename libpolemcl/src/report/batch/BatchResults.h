#pragma once
/// \file BatchResults.h
/// \brief All that a finished batch has to tell: sessions x configurations x runs, as plain data.
///
/// Filled from run folders by the program, measured with BatchMeasures.h, written by BatchJson.h,
/// summed up and shown by share/report. It holds no clock and no timing: the same batch gives the
/// same bytes. A figure that does not exist is NaN; it is shown as a dash, an empty field or
/// `null`.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/evaluation/MapEvaluation.h"

namespace polemcl::report {

/// \brief Stands for a figure that does not exist.
constexpr double noFigure = std::numeric_limits<double>::quiet_NaN();

/// \brief What the results were computed with.
struct BatchVersions {
  std::string polemcl, mrpt, compiler;
};

/// \brief One way to map and localize; all sessions are run with each.
struct BatchConfiguration {
  std::string name;         ///< short, unique in the batch: "upkeep"
  std::string description;  ///< a sentence; may be empty
  std::string protocol;  ///< "paper: map from sessions 1 to i, own data in the map"; may be empty
  std::string config;    ///< text of the effective INI
};

/// \brief One drive.
struct BatchSession {
  std::string name;          ///< unique in the batch: "2012-01-08"
  std::string date;          ///< YYYY-MM-DD or empty
  double length = noFigure;  ///< m driven along the true path
  std::size_t scans = 0;
  double polesPerScan = noFigure;  ///< extracted
};

/// \brief Errors of one run over its compared poses; 2D, convergence included.
/// lat/lon/ang means are of absolute values; standard deviations are of the signed errors about
/// their mean.
struct ErrorMetrics {
  double posMean = noFigure, posRmse = noFigure, posMax = noFigure;  ///< m
  double posEnd = noFigure;                                          ///< m, at the last pose
  double latMean = noFigure, latStd = noFigure;                      ///< m, across the true heading
  double lonMean = noFigure, lonStd = noFigure;                      ///< m, along it
  double xRmse = noFigure, yRmse = noFigure;                         ///< m, axes of the map
  double angMeanDeg = noFigure, angStdDeg = noFigure, angRmseDeg = noFigure;  ///< degrees
  std::size_t poses = 0;                                                      ///< compared
  std::size_t unmatched = 0;  ///< poses without truth, or metres without an estimate
};

/// \brief What the run said of itself.
struct HealthShares {
  double ok = noFigure, degraded = noFigure, lost = noFigure;  ///< shares of its scans, in [0, 1]
  std::optional<std::size_t> firstPoseScan;  ///< 0-based; none when no pose was ever known
  std::size_t relocalizations = 0;
};

/// \brief One run of the filter.
struct BatchRun {
  std::size_t run = 0;  ///< 0-based
  std::uint64_t seed = 0;
  std::string failure;  ///< why it has no result; empty when it has one
  ErrorMetrics errors;
  HealthShares health;
};
/// \brief "failed": it has no result. "lost": see BatchResults::lostBound. Else "ok".
const char* stateOf(const BatchRun& run, double lostBound);

/// \brief The largest value in each bin of a distance; thins a curve without hiding its peaks.
struct BinnedMaxima {
  double binWidth = 1;          ///< m, > 0; bin i covers [i, i + 1) times this
  std::vector<double> largest;  ///< noFigure in bins without a value
};

/// \brief Counts in bins of equal width of the logarithm: ten to a factor of ten, 10^-3 to 10^2.
/// Values beyond are counted in the outermost bins.
struct ErrorHistogram {
  static constexpr std::size_t bins = 50;
  std::vector<std::uint64_t> counts = std::vector<std::uint64_t>(bins, 0);
  /// \brief Lower edge of a bin; edge(bins) is the upper edge of the last.
  static double edge(std::size_t bin);
  /// \param value Not negative, finite. \throws Error otherwise.
  void add(double value);
};

/// \brief What is drawn of a session under a configuration. Any part may be empty.
struct SessionPlots {
  std::vector<Eigen::Vector2d> mapPoles;         ///< m, of the map the session was localized in
  std::vector<Eigen::Vector2d> truth, estimate;  ///< m, of run 0; see thinPath()
  BinnedMaxima position;                         ///< m, error of run 0 over the distance driven
  ErrorHistogram positionErrors;                 ///< m, of all runs
  ErrorHistogram headingErrors;                  ///< degrees, absolute, of all runs
};

/// \brief A map against true poles, counted in three ways; see scoreMap().
struct MapScores {
  std::string truth;      ///< name of the file of true poles, or "labels"
  MapScore near;          ///< map poles with a true one within 1 m, as the authors count
  MapScore oneToOne;      ///< pairs within 1 m
  MapScore oneToOneHalf;  ///< pairs within 0.5 m
};

/// \brief What a paper reports for one session; noFigure where it gives none.
struct PublishedSession {
  std::string system;   ///< "Dong et al. 2021"
  std::string session;  ///< name of a BatchSession
  double mapShare = noFigure;
  double posMean = noFigure, posRmse = noFigure;        ///< m
  double angMeanDeg = noFigure, angRmseDeg = noFigure;  ///< degrees
};

/// \brief One session under one configuration.
struct SessionResult {
  std::size_t configuration = 0, session = 0;  ///< indices in the batch
  double mapShare = noFigure;      ///< f_map: share of the session's scans used for the map
  std::size_t mapPoles = 0;        ///< of the map it was localized in
  std::optional<MapScores> score;  ///< of the map that the session completes
  std::vector<BatchRun> runs;      ///< by index; empty for a session that was only mapped
  SessionPlots plots;
};

/// \brief A task that did not end well.
struct FailedTask {
  std::string task;    ///< "localize upkeep/month_03/run 4"
  std::string reason;  ///< one line
  std::string log;     ///< file, relative to the report
};

/// \brief A whole batch.
struct BatchResults {
  std::string name;                         ///< "nclt"
  std::string title;                        ///< "NCLT, long-term localization"
  std::string dataset;                      ///< one of publishedDatasets(), or empty
  std::vector<PublishedSession> published;  ///< figures by session, system after system
  std::string date;                         ///< only if the caller gives one
  std::string command;                      ///< that makes the batch again
  BatchVersions versions;
  /// A run is lost when no pose could be compared, or when its position error is larger than this
  /// on average or at the end, m.
  double lostBound = 2.0;
  std::vector<BatchConfiguration> configurations;
  std::vector<BatchSession> sessions;  ///< in the order they were driven
  std::vector<SessionResult>
      results;  ///< at most one for each configuration and session, in any order
  std::vector<FailedTask> failures;

  /// \brief The result of a session under a configuration, or null.
  const SessionResult* find(std::size_t configuration, std::size_t session) const;
};

}  // namespace polemcl::report
