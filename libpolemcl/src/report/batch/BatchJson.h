#pragma once
/// \file BatchJson.h
/// \brief Results of a batch as JSON. share/report adds their summary and makes the page, the CSV
/// files and the LaTeX tables of it.

#include <string>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief Everything. Numbers keep all their digits; what does not exist is `null`. The same
/// results give the same bytes.
std::string resultsJson(const BatchResults& results);

}  // namespace polemcl::report
