#pragma once
/// \file FigureText.h
/// \brief Figures as text: always the same decimals, a dash where there is none.

#include <string>

namespace polemcl::report {

inline constexpr const char* enDash = "\xE2\x80\x93";

/// \brief "0.174"; `none` when the value is not finite. Zero has no sign.
std::string figureText(double value, int decimals, const std::string& none = enDash);
/// \brief A count with thin spaces between thousands from five digits on: "12 345".
std::string countText(unsigned long long count);
/// \brief "1 run", "2 runs".
std::string plural(unsigned long long count, const std::string& word);
/// \brief "12 s", "3 min 20 s", "2 h 5 min".
std::string durationText(double seconds);

/// \brief The text with a full stop, unless it is empty or ends in a mark already.
std::string sentence(const std::string& text);

}  // namespace polemcl::report
