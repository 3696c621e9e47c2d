#include "report/batch/PublishedResults.h"

#include <algorithm>
#include <sstream>

#include <polemcl/core/common/Types.h>
#include "io/file/CsvTable.h"

namespace polemcl::report {
namespace {

constexpr const char* dong = "Dong et al. 2021";
constexpr const char* schaefer = "Schaefer et al. 2019";

PublishedResult publishedFigure(const std::string& system, const std::string& remark) {
  PublishedResult published;
  published.system = system;
  published.remark = remark;
  return published;
}

PublishedDataset nclt() {
  PublishedResult first = publishedFigure(schaefer, "as quoted by Dong et al."),
                  second = publishedFigure(dong, "");
  first.posMean = 0.284, first.posRmse = 0.526, first.angMeanDeg = 0.801, first.angRmseDeg = 1.081;
  second.posMean = 0.174, second.posRmse = 0.293;
  second.angMeanDeg = 0.761, second.angRmseDeg = 1.016;
  return {"nclt",
          "NCLT",
          "Means of 27 sessions, 10 runs each, evaluated every metre of the true path; the map "
          "holds data of the session localized in it. The true poses themselves are known to be "
          "wrong by decimetres.",
          {first, second},
          "One map of all sessions against poles that the authors labelled by hand, which may hold "
          "poles that no session saw; a map pole within 1 m of one of them counts as found, in "
          "precision and in recall.",
          {{schaefer, 0.518, 0.664, 0.582}, {dong, 0.525, 0.713, 0.605}}};
}

PublishedDataset semanticKitti() {
  return {"semantickitti",
          "SemanticKITTI, sequences 00 to 10",
          "",
          {},
          "A map of each sequence against poles made of its labels (classes pole, trunk, traffic "
          "sign), mean of the sequences. How the authors clustered the labelled points is not "
          "published: pole-labels does it its own way.",
          {{schaefer, 0.621, 0.380, 0.455}, {dong, 0.687, 0.439, 0.515}}};
}

PublishedDataset kitti() {
  PublishedResult kuemmerle = publishedFigure("Kümmerle et al. 2019", ""),
                  weng = publishedFigure("Weng et al. 2018", "standard deviations only"),
                  sefati = publishedFigure("Sefati et al. 2017", "RMSE only"),
                  first = publishedFigure(schaefer, ""), second = publishedFigure(dong, "");
  kuemmerle.posMean = 0.12, kuemmerle.latMean = 0.07, kuemmerle.lonMean = 0.08;
  kuemmerle.angMeanDeg = 0.33;
  weng.latStd = 0.082, weng.lonStd = 0.164, weng.angStdDeg = 0.329;
  sefati.posRmse = 0.24, sefati.angRmseDeg = 0.68;
  first.posMean = 0.096, first.posRmse = 0.111;
  first.latMean = 0.061, first.latStd = 0.075, first.lonMean = 0.060, first.lonStd = 0.067;
  first.angMeanDeg = 0.133, first.angStdDeg = 0.188, first.angRmseDeg = 0.214;
  second.posMean = 0.091, second.posRmse = 0.106;
  second.latMean = 0.066, second.latStd = 0.067, second.lonMean = 0.046, second.lonStd = 0.058;
  second.angMeanDeg = 0.084, second.angStdDeg = 0.102, second.angRmseDeg = 0.102;
  return {"kitti-0009",
          "KITTI raw, drive 2011_09_26_0009",
          "Schaefer and Dong localize in the map built from the same detections, with odometry "
          "that is the truth with 2 % noise, evaluated every metre of the true path, in the plane; "
          "the other three as quoted by them.",
          {kuemmerle, weng, sefati, first, second},
          "",
          {}};
}

PublishedDataset mulran() {
  const char* perAxis = "position RMSE per axis";
  PublishedResult first = publishedFigure(schaefer, perAxis),
                  chen = publishedFigure("Chen et al. 2021", perAxis),
                  second = publishedFigure(dong, perAxis);
  first.axisRmse = 1.82, first.angRmseDeg = 0.56;
  chen.axisRmse = 0.83, chen.angRmseDeg = 3.14;
  second.axisRmse = 0.48, second.angRmseDeg = 0.27;
  return {
      "mulran-kaist",
      "MulRan, KAIST 01 localized in a map of KAIST 02",
      "Evaluated at every scan. The authors' code averages squares over the axes, so that 0.48 m "
      "per axis stands for about 0.68 m in the plane; that of this batch is given both ways.",
      {first, chen, second},
      "",
      {}};
}

}  // namespace

const std::vector<PublishedDataset>& publishedDatasets() {
  static const std::vector<PublishedDataset> all{nclt(), semanticKitti(), kitti(), mulran()};
  return all;
}

const PublishedDataset* publishedResults(const std::string& key) {
  const auto& all = publishedDatasets();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const PublishedDataset& data) { return data.key == key; });
  return found == all.end() ? nullptr : &*found;
}

namespace {

constexpr const char* sessionTableColumns =
    "system,session,f_map,pos_mean,pos_rmse,ang_mean_deg,ang_rmse_deg";

/// All that are missing at once.
void requireSessionColumns(const io::CsvTable& table, const std::filesystem::path& file) {
  std::istringstream wanted(sessionTableColumns);
  std::string missing;
  for (std::string name; std::getline(wanted, name, ',');)
    if (!table.find(name)) missing += (missing.empty() ? "" : ",") + name;
  if (!missing.empty())
    throw Error(file.string() + ": columns are missing: " + missing +
                "; the first line must name " + sessionTableColumns +
                " (m and degrees; f_map a share; fields may be empty)");
}

}  // namespace

std::vector<PublishedSession> readPublishedSessions(const std::filesystem::path& file) {
  const io::CsvTable table(file);
  requireSessionColumns(table, file);
  const std::pair<const char*, double PublishedSession::*> columns[] = {
      {"f_map", &PublishedSession::mapShare},
      {"pos_mean", &PublishedSession::posMean},
      {"pos_rmse", &PublishedSession::posRmse},
      {"ang_mean_deg", &PublishedSession::angMeanDeg},
      {"ang_rmse_deg", &PublishedSession::angRmseDeg}};
  const std::size_t system = table.column("system"), session = table.column("session");
  std::vector<PublishedSession> published;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    PublishedSession one;
    one.system = table.text(row, system);
    one.session = table.text(row, session);
    for (const auto& [name, figure] : columns) {
      const std::size_t column = table.column(name);
      if (!table.text(row, column).empty()) one.*figure = table.number(row, column);
    }
    if (find(published, one.system, one.session))
      throw Error(table.at(row) + "session " + one.session + " of " + one.system +
                  " is there already; each may be there once");
    published.push_back(std::move(one));
  }
  return published;
}

std::vector<std::string> publishedSystems(const std::vector<PublishedSession>& published) {
  std::vector<std::string> systems;
  for (const PublishedSession& one : published)
    if (std::find(systems.begin(), systems.end(), one.system) == systems.end())
      systems.push_back(one.system);
  return systems;
}

const PublishedSession* find(const std::vector<PublishedSession>& published,
                             const std::string& system, const std::string& session) {
  const auto found = std::find_if(
      published.begin(), published.end(),
      [&](const PublishedSession& one) { return one.system == system && one.session == session; });
  return found == published.end() ? nullptr : &*found;
}

}  // namespace polemcl::report
