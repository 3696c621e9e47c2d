#pragma once
/// \file ReportSentences.h
/// \brief What a batch comes to, in sentences and on cards.

#include <string>
#include <vector>

#include "report/batch/BatchSummary.h"

namespace polemcl::report {

/// \brief The main figures, what was lost, how the last session compares with the first: HTML.
std::string headlines(const BatchResults& results,
                      const std::vector<ConfigurationSummary>& summaries);
/// \brief A card for each configuration.
std::string configurationCards(const BatchResults& results,
                               const std::vector<ConfigurationSummary>& summaries);
/// \brief A session's figures in a few words, for the head of its fold: HTML.
std::string sessionLine(const BatchResults& results,
                        const std::vector<ConfigurationSummary>& summaries, std::size_t session);

}  // namespace polemcl::report
