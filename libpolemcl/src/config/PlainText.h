#pragma once
/// \file PlainText.h
/// \brief Tells INI files that only state values from those that make MRPT's parser do more.

#include <string>

namespace polemcl {

/// \brief Refuses what MRPT's parser of INI files would run as a program or read from the
/// environment, and texts that `@define` makes very long.
/// \param name Name of the file in messages. \throws Error with the line.
void requirePlain(const std::string& text, const std::string& name);

}  // namespace polemcl
