#pragma once
/// \file BatchFiles.h
/// \brief Results of a batch as files: JSON and CSV. share/report makes the page and the LaTeX
/// tables of them.
///
/// All are written atomically. The same results give the same bytes.

#include <filesystem>
#include <string>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief Everything, with the summaries of BatchSummary.h under `summary` for scripts. Numbers
/// keep all their digits; what does not exist is `null`.
/// \throws Error when the file cannot be written.
void writeResultsJson(const std::filesystem::path& file, const BatchResults& results);

/// \brief One row for each run: configuration, session, run, seed, state, reason, figures, health.
void writeRunsCsv(const std::filesystem::path& file, const BatchResults& results);
/// \brief One row for each session under each configuration: mean and standard deviation over its
/// runs.
void writeSessionsCsv(const std::filesystem::path& file, const BatchResults& results);

/// \brief One row for each map that was scored: poles, then precision, recall, F1 and matches in
/// three ways to count, see MapScores. Without any, the header alone.
void writeMapsCsv(const std::filesystem::path& file, const BatchResults& results);

}  // namespace polemcl::report
