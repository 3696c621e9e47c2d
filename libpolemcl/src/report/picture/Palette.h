#pragma once
/// \file Palette.h
/// \brief Colours that all pictures share. They stay apart for colour-blind eyes (Okabe and Ito
/// 2008).

#include "report/picture/Canvas.h"

namespace polemcl::report {

inline constexpr Color ink = rgb(0x1f2328);
inline constexpr Color white = rgb(0xffffff);
inline constexpr Color poleColor = rgb(0xd55e00);

}  // namespace polemcl::report
