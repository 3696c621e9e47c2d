#pragma once
/// \file MrptCompatibility.h
/// \brief Differences between versions of MRPT. `MRPT_VERSION` is 0x258 in 2.5.8 and 0x020A02 from
/// 2.10.2 on. The number still grows with the version, but its digits cannot be compared one by
/// one.

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/version.h>

namespace polemcl {

#if MRPT_VERSION >= 0x020B03
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
/// \brief Return type of `internal_CreateFromMapDefinition`: a pointer owned by the caller.
using CreatedMap = mrpt::maps::CMetricMap*;
#endif

}  // namespace polemcl
