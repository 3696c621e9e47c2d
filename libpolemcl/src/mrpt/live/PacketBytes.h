#pragma once
/// \file PacketBytes.h
/// \brief Numbers in packets, low byte first. Private to the library.

#include <cstring>
#include <string_view>

namespace polemcl {

/// \param place Of the first byte. The packet must be long enough.
template <class Number>
Number numberAt(std::string_view bytes, std::size_t place) {
  Number number;
  std::memcpy(&number, bytes.data() + place, sizeof number);
  return number;
}

}  // namespace polemcl
