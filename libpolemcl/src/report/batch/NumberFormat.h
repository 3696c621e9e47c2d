#pragma once
/// \file NumberFormat.h
/// \brief Figures as text: always the same decimals, a dash for a missing figure.

#include <string>
#include <vector>

namespace polemcl::report {

inline constexpr const char* enDash = "\xE2\x80\x93";

/// \brief "0.174"; `none` when the value is not finite. Zero has no sign.
std::string metricText(double value, int decimals, const std::string& none = enDash);
/// \brief A share in percent, without the sign: 0.174 is "17.4".
std::string percentText(double share, const std::string& none = enDash);
/// \brief An error in the unit that reads best: 0.0072 m is "0.72 cm", 0.174 m "17.4 cm". Below
/// 1 m centimetres with two significant digits or one decimal, from there metres with three. \param
/// space Between number and unit.
std::string lengthText(double metres, const std::string& space = "\xC2\xA0");

/// \brief What a figure measures.
enum class Quantity { length, angle };

/// \brief A column of errors, all in one unit. Lengths: centimetres if any of them is below 0.1 m,
/// these with two significant digits, larger ones in tenths of a centimetre; otherwise metres with
/// three decimals. Angles: degrees with three decimals.
class MetricColumn {
 public:
  /// \param values All figures that decide on the unit, m or degrees.
  MetricColumn(Quantity quantity, const std::vector<double>& values);
  /// \brief The label with the unit, "Δ (cm)".
  std::string head(const std::string& label) const;
  std::string latexHead(const std::string& label) const;  ///< "Δ [cm]"
  /// \brief The number alone; `none` when it is not finite.
  std::string figure(double value, const std::string& none = enDash) const;

 private:
  enum class Unit { metre, centimetre, degree };
  Unit m_unit;
};

/// \brief A count with thin spaces between thousands from five digits on: "12 345".
std::string countText(unsigned long long count);
/// \brief "1 run", "2 runs".
std::string plural(unsigned long long count, const std::string& word);
/// \brief "12 s", "3 min 20 s", "2 h 5 min".
std::string durationText(double seconds);

/// \brief The text with a full stop, unless it is empty or ends in a mark already.
std::string sentence(const std::string& text);

}  // namespace polemcl::report
