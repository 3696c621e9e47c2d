#pragma once
/// \file BatchFiles.h
/// \brief Results of a batch as files: JSON, CSV and LaTeX for other programs, an HTML page to
/// read.
///
/// All are written atomically and hold no timing: the same results give the same bytes.

#include <filesystem>
#include <string>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief Everything, with the summaries of BatchSummary.h under `summary` for scripts. Numbers
/// keep all their digits; what does not exist is `null`.
/// \throws Error when the results are not valid or the file cannot be written.
void writeResultsJson(const std::filesystem::path& file, const BatchResults& results);

/// \brief One row for each run: configuration, session, run, seed, state, reason, figures, health.
void writeRunsCsv(const std::filesystem::path& file, const BatchResults& results);
/// \brief One row for each session under each configuration: mean and standard deviation over its
/// runs.
void writeSessionsCsv(const std::filesystem::path& file, const BatchResults& results);

/// \brief One row for each map that was scored: poles, then precision, recall, F1 and matches in
/// three ways to count, see MapScores. Without any, the header alone.
void writeMapsCsv(const std::filesystem::path& file, const BatchResults& results);

/// \brief The paper's tables (booktabs), to be \input into a document: sessions of each
/// configuration, scores of maps, published figures beside ours.
void writeLatexTable(const std::filesystem::path& file, const BatchResults& results);
/// \brief Text as LaTeX shows it letter by letter.
std::string latexText(const std::string& text);

/// \brief The page: no scripts, nothing from the network, light and dark.
/// \param timings May be null: the page has no section for them then, and the same results give the
///        same bytes.
/// \throws Error when the results are not valid.
std::string batchReport(const BatchResults& results, const BatchTimings* timings = nullptr);

/// \brief Writes the page atomically. \throws Error as above, or when it cannot be written.
void writeBatchReport(const BatchResults& results, const BatchTimings* timings,
                      const std::filesystem::path& file);

}  // namespace polemcl::report
