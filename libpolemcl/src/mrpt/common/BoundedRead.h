#pragma once
/// \file BoundedRead.h
/// \brief Poles in archives, and reading of lists from archives that may be damaged or forged. A
/// length above its limit is rejected. Below the limit, memory grows with the bytes read, never
/// beyond the size of the file.

#include <mrpt/serialization/CArchive.h>

#include <cstdint>
#include <cstring>
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

/// \brief The number in a bool or an enum that MRPT read. It takes any bytes, and to use one that
/// is no value of the type is undefined behaviour.
template <class Value>
std::uint32_t storedNumber(const Value& value) {
  static_assert(sizeof value <= sizeof(std::uint32_t));
  std::uint32_t number = 0;
  std::memcpy(&number, &value, sizeof value);
  return number;
}

/// \brief Writes what PoleDetection and MapPole have in common, then `count`.
template <class Pole>
void writePole(mrpt::serialization::CArchive& out, const Pole& pole, std::uint32_t count) {
  out << pole.x << pole.y << pole.radius << pole.bottom << pole.top << pole.confidence
      << pole.covariance(0, 0) << pole.covariance(0, 1) << pole.covariance(1, 1) << count;
}

/// \brief Inverse of writePole(). \param count The member that holds the count.
template <class Pole>
Pole readPole(mrpt::serialization::CArchive& in, std::uint32_t Pole::*count) {
  Pole pole;
  auto& C = pole.covariance;
  in >> pole.x >> pole.y >> pole.radius >> pole.bottom >> pole.top >> pole.confidence >> C(0, 0) >>
      C(0, 1) >> C(1, 1) >> pole.*count;
  C(1, 0) = C(0, 1);
  return pole;
}

}  // namespace polemcl
