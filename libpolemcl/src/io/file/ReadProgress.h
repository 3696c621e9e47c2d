#pragma once
/// \file ReadProgress.h
/// \brief Who reads large files tells how far.

#include <cstddef>
#include <functional>

namespace polemcl::io {

/// \brief Told how much is read and how much there is, both in one unit.
using ReadProgress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace polemcl::io
