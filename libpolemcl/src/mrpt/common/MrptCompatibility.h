#pragma once
/// \file MrptCompatibility.h
/// \brief Where the versions of MRPT differ. `MRPT_VERSION` is 0x258 in 2.5.8 and 0x020A02 from
/// 2.10.2 on: it still grows, but digits must not be compared one by one.

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/version.h>

namespace polemcl {

#if MRPT_VERSION >= 0x020B03
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
/// \brief What `internal_CreateFromMapDefinition` returns: a pointer the caller owns.
using CreatedMap = mrpt::maps::CMetricMap*;
#endif

}  // namespace polemcl
