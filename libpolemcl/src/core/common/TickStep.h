#pragma once
/// \file TickStep.h
/// \brief Round steps for the grids of plots and scenes.

namespace polemcl {

/// \brief 1, 2 or 5 times a power of ten, such that a range of `span` has at most `most` steps.
/// \throws Error unless span > 0 and most >= 1.
double tickStep(double span, int most);

}  // namespace polemcl
