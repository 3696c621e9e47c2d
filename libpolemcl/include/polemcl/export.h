#pragma once
/// \file export.h
/// \brief The mark of what libpolemcl.so exports. Everything else in it is hidden.

#ifdef __GNUC__
#define POLEMCL_EXPORT __attribute__((visibility("default")))
#else
#define POLEMCL_EXPORT
#endif
