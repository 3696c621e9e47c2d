#pragma once
/// \file RegisterClasses.h
/// \brief Makes the classes of this library known to MRPT's class and map registries.

namespace polemcl {

/// \brief Registers CObservationPoles and CPoleMap. Loading the library does it too, but a linker
/// that drops unused libraries (`--as-needed`) never loads it: call this first in every `main`.
/// Calling it again does no harm.
void registerClasses();

}  // namespace polemcl
