#include <gtest/gtest.h>

#include <cmath>

#include "report/batch/NumberFormat.h"

namespace polemcl::report::test_number_format {

TEST(NumberFormat, ShortLengthsAreCentimetresWithTwoSignificantDigits) {
  EXPECT_EQ(lengthText(0.0072, " "), "0.72 cm");
  EXPECT_EQ(lengthText(0.00004, " "), "0.004 cm");  // not below a hundredth of a millimetre
  EXPECT_EQ(lengthText(0.0724, " "), "7.2 cm");
  EXPECT_EQ(lengthText(0.0996, " "), "10 cm");
  EXPECT_EQ(lengthText(0.009951, " "), "1.0 cm");
  EXPECT_EQ(lengthText(0.1, " "), "10.0 cm");
  EXPECT_EQ(lengthText(0.1744, " "), "17.4 cm");
  EXPECT_EQ(lengthText(5.48, " "), "5.480 m");
  EXPECT_EQ(lengthText(0, " "), "0.0 cm");
  EXPECT_EQ(lengthText(NAN, " "), "\xE2\x80\x93 m");
  EXPECT_EQ(lengthText(1.5), "1.500\xC2\xA0m");
}

TEST(NumberFormat, AColumnHasOneUnit) {
  const MetricColumn large(Quantity::length, {0.174, NAN, 2.47});
  EXPECT_EQ(large.head("Δ"), "Δ (m)");
  EXPECT_EQ(large.latexHead("D"), "D [m]");
  EXPECT_EQ(large.figure(0.174), "0.174");
  EXPECT_EQ(large.figure(0.0123), "0.012");  // a spread in a column of metres
  EXPECT_EQ(large.figure(NAN), "\xE2\x80\x93");

  const MetricColumn mixed(Quantity::length, {0.174, 0.0072});
  EXPECT_EQ(mixed.head("Δ"), "Δ (cm)");
  EXPECT_EQ(mixed.latexHead("D"), "D [cm]");
  EXPECT_EQ(mixed.figure(0.0072), "0.72");
  EXPECT_EQ(mixed.figure(0.00031), "0.031");  // its spread is no 0.000
  EXPECT_EQ(mixed.figure(0.174), "17.4");
  EXPECT_EQ(mixed.figure(2.47), "247.0");
  EXPECT_EQ(mixed.figure(NAN, "--"), "--");
}

TEST(NumberFormat, AnglesAreDegrees) {
  const MetricColumn angles(Quantity::angle, {0.02});
  EXPECT_EQ(angles.head("Δ"), "Δ (°)");
  EXPECT_EQ(angles.latexHead("D"), "D [$^\\circ$]");
  EXPECT_EQ(angles.figure(0.0212), "0.021");
}

}  // namespace polemcl::report::test_number_format
