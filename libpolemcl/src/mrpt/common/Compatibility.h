#pragma once
/// \file Compatibility.h
/// \brief What newer releases of MRPT have changed in what this library uses. Everything is built
/// and tested with MRPT 2.5.8. With the headers of 2.15.19, the syntax was checked, and nothing was
/// built or run. What MRPT 3 needs beyond this file is listed in share/doc/mrpt.md.

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/version.h>

#include <type_traits>

namespace polemcl {

// MRPT_VERSION is 0x258 in 2.5.8 and 0x020A02 from 2.10.2 on: it grows, but not digit by digit.

/// What CPoleMap::internal_CreateFromMapDefinition() returns.
#if MRPT_VERSION >= 0x020B03
using CreatedMap = mrpt::maps::CMetricMap::Ptr;  // not compiled here
#else
using CreatedMap = mrpt::maps::CMetricMap*;  // owned by the caller
#endif

/// Sets one of the lights of a scene to white: a colour in 2.5.8, a number in 2.15 (not compiled
/// here).
template <class Light>
void setLight(Light& light, float strength) {
  if constexpr (std::is_arithmetic_v<Light>)
    light = strength;
  else
    light = {strength, strength, strength, 1.0f};
}

}  // namespace polemcl
