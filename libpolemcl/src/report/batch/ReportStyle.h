#pragma once
/// \file ReportStyle.h
/// \brief The style sheet of a batch's report: one column of text, light and dark, phone and print.

namespace polemcl::report {

extern const char* const reportStyle;

}  // namespace polemcl::report
