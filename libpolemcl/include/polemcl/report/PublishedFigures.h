#pragma once
/// \file PublishedFigures.h
/// \brief What the papers report for the datasets a batch may run on.

#include <polemcl/report/BatchResults.h>

#include <string>
#include <vector>

namespace polemcl::report {

/// \brief One system's figures on one dataset, as published; noFigure where a paper gives none.
/// Means over runs and sessions, m and degrees, with the meaning of ErrorFigures.
struct PublishedFigure {
  std::string system;  ///< first author and year: "Schaefer et al. 2019"
  std::string remark;  ///< what makes it comparable or not; may be empty
  double posMean = noFigure, posRmse = noFigure;
  double axisRmse = noFigure;  ///< position RMSE per axis
  double latMean = noFigure, latStd = noFigure;
  double lonMean = noFigure, lonStd = noFigure;
  double angMeanDeg = noFigure, angStdDeg = noFigure, angRmseDeg = noFigure;
};

/// \brief A dataset with published figures.
struct PublishedDataset {
  std::string key;       ///< BatchResults::dataset: "nclt", "kitti-0009", "mulran-kaist"
  std::string title;     ///< "KITTI raw, drive 2011_09_26_0009"
  std::string protocol;  ///< how the figures were come by, a sentence
  std::vector<PublishedFigure> figures;
};

/// \brief All datasets known.
/// Sources: the tables of Dong et al., "Online Range Image-based Pole Extractor for Long-term LiDAR
/// Localization in Urban Environments" (ECMR 2021), which also quotes the other systems.
const std::vector<PublishedDataset>& publishedDatasets();
/// \brief The dataset of that key, or null.
const PublishedDataset* publishedFigures(const std::string& key);

}  // namespace polemcl::report
