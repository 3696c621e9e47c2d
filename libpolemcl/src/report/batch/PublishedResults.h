#pragma once
/// \file PublishedResults.h
/// \brief What the papers report for the datasets a batch may run on.

#include <filesystem>
#include <string>
#include <vector>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief The datasets with published figures, by the keys that BatchResults::dataset takes: those
/// of the installed file `published/tables.json`, which the report shows.
/// \throws Error when the file is not found or cannot be read.
std::vector<std::string> publishedDatasets();

/// \brief Reads figures by session: CSV with the columns `system,session,f_map,pos_mean,pos_rmse,
/// ang_mean_deg,ang_rmse_deg`; f_map a share, m, degrees; an empty field: not published.
/// \throws Error naming the file (and line): cannot be read, a column is missing, no number, a
///         session of a system that appears twice.
std::vector<PublishedSession> readPublishedSessions(const std::filesystem::path& file);
}  // namespace polemcl::report
