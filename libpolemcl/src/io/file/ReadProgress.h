#pragma once
/// \file ReadProgress.h
/// \brief Progress reports of functions that read large files.

#include <cstddef>
#include <functional>

namespace polemcl::io {

/// \brief Called with the amount read and the total, both in the same unit.
using ReadProgress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace polemcl::io
