#pragma once
/// \file MrptReason.h
/// \brief Short reasons of MRPT's errors.

#include <string>

namespace polemcl {

/// \brief The innermost reason in the message of an MRPT exception, on one line, without nested
/// contexts and call stacks. Other messages are reduced to their first line.
std::string mrptReason(const std::string& what);

}  // namespace polemcl
