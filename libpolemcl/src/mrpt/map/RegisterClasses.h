#pragma once
/// \file RegisterClasses.h
/// \brief Registers the classes of this library in MRPT's class and map registries.

namespace polemcl {

/// \brief Registers CObservationPoles and CPoleMap. Loading the library does this too. However, a
/// linker that drops unused libraries (`--as-needed`) never loads it: call this first in every
/// `main`. Further calls have no effect.
void registerClasses();

}  // namespace polemcl
