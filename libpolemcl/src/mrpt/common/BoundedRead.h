#pragma once
/// \file BoundedRead.h
/// \brief Lengths in archives that may be damaged or forged: above a limit they are refused, below
/// it memory is taken as the bytes come, never more than the file has.

#include <mrpt/serialization/CArchive.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace polemcl {

/// \brief A count of `what` ("poles"). \throws Error when it is above `most`.
std::uint32_t readCount(mrpt::serialization::CArchive& in, std::uint32_t most, const char* what);

/// \brief A text as `out << std::string` writes it. \throws Error when it is longer than `most`
/// bytes or the archive ends.
std::string readText(mrpt::serialization::CArchive& in, std::uint32_t most, const char* what);

/// \brief Numbers as `out << std::vector<float>` writes them. \throws Error as readText().
std::vector<float> readFloats(mrpt::serialization::CArchive& in, std::uint32_t most,
                              const char* what);

/// \brief A table as `out << std::map<std::string, std::string>` writes it.
/// \throws Error as readText(), for the entries, each key and each value.
std::map<std::string, std::string> readTexts(mrpt::serialization::CArchive& in, std::uint32_t most,
                                             std::uint32_t longest, const char* what);

}  // namespace polemcl
