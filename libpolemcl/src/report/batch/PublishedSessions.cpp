#include <algorithm>

#include <polemcl/core/common/Types.h>
#include "io/file/CsvTable.h"
#include "report/batch/PublishedResults.h"

namespace polemcl::report {

std::vector<PublishedSession> readPublishedSessions(const std::filesystem::path& file) {
  const io::CsvTable table(file);
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
