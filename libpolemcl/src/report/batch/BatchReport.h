#pragma once
/// \file BatchReport.h
/// \brief The report of a batch: one HTML file that needs nothing but itself.

#include <filesystem>
#include <string>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief The page: no scripts, nothing from the network, light and dark.
/// \param timings May be null: the page has no section for them then, and the same results give the
///        same bytes.
/// \throws Error when the results are not valid.
std::string batchReport(const BatchResults& results, const BatchTimings* timings = nullptr);

/// \brief Writes the page atomically. \throws Error as above, or when it cannot be written.
void writeBatchReport(const BatchResults& results, const BatchTimings* timings,
                      const std::filesystem::path& file);

}  // namespace polemcl::report
