#pragma once
/// \file Date.h
/// \brief Dates as text: ISO 8601, `YYYY-MM-DD`, UTC.

#include <string>

namespace polemcl::io {

/// \brief Date of a time, e.g. "2012-03-17". \param seconds Seconds since 1970-01-01; 0 means "not
/// known" and gives "".
std::string dateText(double seconds);

/// \brief Start of a day, in seconds since 1970-01-01.
/// \throws Error unless the text is an existing day of the years 1970 to 9999, written as
///         YYYY-MM-DD.
double secondsOfDate(const std::string& text);

}  // namespace polemcl::io
