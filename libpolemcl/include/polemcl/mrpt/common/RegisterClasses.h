#pragma once
/// \file RegisterClasses.h
/// \brief Registers the classes of this library in MRPT's class and map registries.

#include <polemcl/export.h>

namespace polemcl {

/// \brief Registers CObservationPoles and CPoleMap, so that MRPT finds them by their names in
/// rawlogs and INI files. Nothing needs to call it: loading the library does it. Further calls have
/// no effect.
POLEMCL_EXPORT void registerClasses();

/// \brief Keeps the library in a program that includes this header and names no class of it. A
/// linker that drops unused libraries (`--as-needed`) would not load it.
inline const bool classesAreRegistered = (registerClasses(), true);

}  // namespace polemcl
