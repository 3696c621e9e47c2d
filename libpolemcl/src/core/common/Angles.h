#pragma once
/// \file Angles.h
/// \brief The unit of angles that people read.

#include <cmath>

namespace polemcl {

inline constexpr double degree = M_PI / 180;  ///< rad

}  // namespace polemcl
