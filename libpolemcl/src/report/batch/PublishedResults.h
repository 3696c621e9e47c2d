#pragma once
/// \file PublishedResults.h
/// \brief What the papers report for the datasets a batch may run on.

#include <filesystem>
#include <string>
#include <vector>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief One system's figures on one dataset, as published; noFigure where a paper gives none.
/// Means over runs and sessions, m and degrees, with the meaning of ErrorMetrics.
struct PublishedResult {
  std::string system;  ///< first author and year: "Schaefer et al. 2019"
  std::string remark;  ///< what makes it comparable or not; may be empty
  double posMean = noFigure, posRmse = noFigure;
  double axisRmse = noFigure;  ///< position RMSE per axis
  double latMean = noFigure, latStd = noFigure;
  double lonMean = noFigure, lonStd = noFigure;
  double angMeanDeg = noFigure, angStdDeg = noFigure, angRmseDeg = noFigure;
};

/// \brief One system's map scores on one dataset, as published: shares.
struct PublishedMapScore {
  std::string system;
  double precision = noFigure, recall = noFigure, f1 = noFigure;
};

/// \brief A dataset with published figures; either list may be empty, and its protocol with it.
struct PublishedDataset {
  std::string key;       ///< BatchResults::dataset: "nclt", "semantickitti", "kitti-0009", …
  std::string title;     ///< "KITTI raw, drive 2011_09_26_0009"
  std::string protocol;  ///< how the figures of localization were come by, in sentences
  std::vector<PublishedResult> figures;
  std::string mapProtocol;  ///< the same for the scores of maps
  std::vector<PublishedMapScore> maps;
};

/// \brief All datasets known.
/// Sources: the tables of Dong et al., "Online Range Image-based Pole Extractor for Long-term LiDAR
/// Localization in Urban Environments" (ECMR 2021), which also quotes the other systems.
const std::vector<PublishedDataset>& publishedDatasets();
/// \brief The dataset of that key, or null.
const PublishedDataset* publishedResults(const std::string& key);

/// \brief Reads figures by session: CSV with the columns `system,session,f_map,pos_mean,pos_rmse,
/// ang_mean_deg,ang_rmse_deg`; f_map a share, m, degrees; an empty field: not published.
/// \throws Error naming the file (and line): cannot be read, a column is missing, no number, a
///         session of a system that appears twice.
std::vector<PublishedSession> readPublishedSessions(const std::filesystem::path& file);
/// \brief Systems with figures by session, in the order of the list.
std::vector<std::string> publishedSystems(const std::vector<PublishedSession>& published);
/// \brief A system's figures for a session, or null.
const PublishedSession* find(const std::vector<PublishedSession>& published,
                             const std::string& system, const std::string& session);

}  // namespace polemcl::report
