#include "report/batch/PublishedResults.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"
#include "io/file/CsvTable.h"
#include "io/file/InstalledFiles.h"

namespace polemcl::report {
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

std::vector<std::string> publishedDatasets() {
  const std::filesystem::path file = io::fileOfDataFolder("tables.json", "published");
  if (file.empty()) throw Error("published/tables.json is not among the installed files");
  std::vector<std::string> keys;
  try {
    const auto tables = nlohmann::ordered_json::parse(io::readBytes(file));
    for (const auto& dataset : tables.items()) keys.push_back(dataset.key());
  } catch (const nlohmann::json::exception& error) {
    throw Error(file.string() + ": no JSON: " + error.what());
  }
  return keys;
}

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
    const bool known =
        std::any_of(published.begin(), published.end(), [&](const PublishedSession& other) {
          return other.system == one.system && other.session == one.session;
        });
    if (known)
      throw Error(table.at(row) + "session " + one.session + " of " + one.system +
                  " is there already; each may be there once");
    published.push_back(std::move(one));
  }
  return published;
}

}  // namespace polemcl::report
