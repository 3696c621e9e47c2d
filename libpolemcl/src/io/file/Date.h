#pragma once
/// \file Date.h
/// \brief Days as people write them: ISO 8601, `YYYY-MM-DD`, UTC.

#include <string>

namespace polemcl::io {

/// \brief The day of a time, e.g. "2012-03-17". \param seconds Since 1970-01-01; 0 stands for "not
/// known" and gives "".
std::string dateText(double seconds);

/// \brief Seconds since 1970-01-01 of the beginning of a day.
/// \throws Error unless it is a day of the years 1970 to 9999, written as YYYY-MM-DD.
double secondsOfDate(const std::string& text);

}  // namespace polemcl::io
