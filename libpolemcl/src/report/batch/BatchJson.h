#pragma once
/// \file BatchJson.h
/// \brief What the writer and the reader of results.json agree on.

namespace polemcl::report {

inline constexpr const char* resultsFormat = "polemcl batch results";
inline constexpr unsigned resultsVersion = 2;

}  // namespace polemcl::report
