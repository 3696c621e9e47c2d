#include <polemcl/core/Types.h>
#include <polemcl/io/Date.h>

#include <cmath>
#include <cstdio>

namespace polemcl::io {
namespace {

constexpr double kDay = 86400;  ///< s

bool leap(int year) {
  return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
}

int daysOfMonth(int year, int month) {
  constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && leap(year) ? 29 : days[month - 1];
}

}  // namespace

std::string dateText(double seconds) {
  if (!(seconds > 0 && seconds < 8000 * 366 * kDay)) return "";
  int day = static_cast<int>(std::floor(seconds / kDay)), year = 1970, month = 1;
  for (; day >= (leap(year) ? 366 : 365); ++year) day -= leap(year) ? 366 : 365;
  for (; day >= daysOfMonth(year, month); ++month) day -= daysOfMonth(year, month);
  char text[48];
  std::snprintf(text, sizeof text, "%04d-%02d-%02d", year, month, day + 1);
  return text;
}

double secondsOfDate(const std::string& text) {
  int year = 0, month = 0, day = 0, read = 0;
  const bool shaped = text.size() == 10 && text.find_first_not_of("0123456789-") == text.npos &&
                      std::sscanf(text.c_str(), "%4d-%2d-%2d%n", &year, &month, &day, &read) == 3 &&
                      read == 10;
  if (!shaped || year < 1970 || month < 1 || month > 12 || day < 1 ||
      day > daysOfMonth(year, month))
    throw Error("'" + text + "' is no date; write YYYY-MM-DD, from 1970-01-01 on");
  int days = day - 1;
  for (int y = 1970; y < year; ++y) days += leap(y) ? 366 : 365;
  for (int m = 1; m < month; ++m) days += daysOfMonth(year, m);
  return kDay * days;
}

}  // namespace polemcl::io
