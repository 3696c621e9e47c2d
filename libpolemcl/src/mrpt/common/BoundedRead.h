#pragma once
/// \file BoundedRead.h
/// \brief Reading of lists from archives that may be damaged or forged. A length above its limit is
/// rejected. Below the limit, memory grows with the bytes read, never beyond the size of the file.

#include <mrpt/serialization/CArchive.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace polemcl {

/// \brief Reads a count of `what` ("poles"). \throws Error when it is above `most`.
std::uint32_t readCount(mrpt::serialization::CArchive& in, std::uint32_t most, const char* what);

/// \brief Reads a text written by `out << std::string`. \throws Error when it is longer than `most`
/// bytes or the archive ends.
std::string readText(mrpt::serialization::CArchive& in, std::uint32_t most, const char* what);

/// \brief Reads numbers written by `out << std::vector<float>`. \throws Error as readText().
std::vector<float> readFloats(mrpt::serialization::CArchive& in, std::uint32_t most,
                              const char* what);

/// \brief Reads a table written by `out << std::map<std::string, std::string>`.
/// \throws Error as readText(), for the number of entries, each key and each value.
std::map<std::string, std::string> readTexts(mrpt::serialization::CArchive& in, std::uint32_t most,
                                             std::uint32_t longest, const char* what);

}  // namespace polemcl
